// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/http_request.h"

#include <string>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

int fault_of(const std::string& head) {
  try {
    static_cast<void>(parse_http_head(head));
  } catch (const HttpFault& fault) {
    EXPECT_FALSE(std::string(fault.what()).empty());
    return fault.status;
  }
  return 0;
}

const std::string kGood =
    "PUT /t/files/a%20b.ply?x=1 HTTP/1.1\r\nHost: 127.0.0.1:80\r\nContent-Length:  12 \r\n\r\n";

TEST(HttpRequest, AHeadIsTakenApart) {
  const HttpRequest request = parse_http_head(kGood);
  EXPECT_EQ(request.method, "PUT");
  EXPECT_EQ(request.segments, (std::vector<std::string>{"t", "files", "a b.ply"}));
  EXPECT_EQ(request.field("host"), "127.0.0.1:80");
  EXPECT_EQ(request.field("origin"), "");
  EXPECT_TRUE(request.has_content);
  EXPECT_EQ(request.content_bytes, 12U);
  EXPECT_EQ(parse_http_head("GET / HTTP/1.0\r\n\r\n").segments, std::vector<std::string>{""});
  EXPECT_EQ(parse_http_head("GET /a/ HTTP/1.1\r\n\r\n").segments, (std::vector<std::string>{"a", ""}));
  EXPECT_FALSE(parse_http_head("GET / HTTP/1.1\r\n\r\n").has_content);
  EXPECT_TRUE(parse_http_head("PUT /a HTTP/1.1\r\nExpect: 100-Continue\r\n\r\n").expects_continue);
}

TEST(HttpRequest, WhatCouldBeReadInTwoWaysIsRefused) {
  const auto with = [](const std::string& fields) {
    return fault_of("POST /a HTTP/1.1\r\n" + fields + "\r\n");
  };
  EXPECT_EQ(with("Content-Length: 3\r\nContent-Length: 4\r\n"), 400);
  EXPECT_EQ(with("Content-Length: 3\r\nTransfer-Encoding: chunked\r\n"), 501);
  EXPECT_EQ(with("Transfer-Encoding: identity\r\n"), 501);
  for (const std::string length : {"", "-1", "+1", "0x10", "1 2", "1,1", "99999999999999999999999"})
    EXPECT_EQ(with("Content-Length: " + length + "\r\n"), 400) << length;
  EXPECT_EQ(with("Host: a\r\n folded\r\n"), 400);
  EXPECT_EQ(with("Host : a\r\n"), 400);
  EXPECT_EQ(with(": a\r\n"), 400);
  EXPECT_EQ(with("no colon\r\n"), 400);
  EXPECT_EQ(with("Host: a\nX: b\r\n"), 400);
  EXPECT_EQ(with(std::string("Host: a\0b\r\n", 11)), 400);
  EXPECT_EQ(with("Host: a\x7f\r\n"), 400);
  EXPECT_EQ(with("Host: a\r\n\r\nGET / HTTP/1.1\r\n"), 400) << "a second head";
}

TEST(HttpRequest, FirstLinesThatAreNone) {
  EXPECT_EQ(fault_of(""), 400);
  EXPECT_EQ(fault_of("GET / HTTP/1.1"), 400);
  EXPECT_EQ(fault_of("GET / HTTP/1.1\r\n"), 400);
  EXPECT_EQ(fault_of("\r\n\r\n"), 400);
  EXPECT_EQ(fault_of("GET /\r\n\r\n"), 400);
  EXPECT_EQ(fault_of("GET  HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(fault_of("GET / HTTP/2\r\n\r\n"), 505);
  EXPECT_EQ(fault_of("get / HTTP/1.1\r\n\r\n"), 405);
  EXPECT_EQ(fault_of("CONNECT a:1 HTTP/1.1\r\n\r\n"), 405);
  EXPECT_EQ(fault_of("G(T / HTTP/1.1\r\n\r\n"), 400);
  for (const std::string target : {"a", "http://a/", "*", "/a b", "/a\tb", "/a#b", "/\xc3\xa4"})
    EXPECT_EQ(fault_of("GET " + target + " HTTP/1.1\r\n\r\n"), 400) << target;
  for (const std::string target : {"/%", "/%4", "/%zz", "/a%2/b", "/%-1"})
    EXPECT_EQ(fault_of("GET " + target + " HTTP/1.1\r\n\r\n"), 400) << target;
}

TEST(HttpRequest, HeadsHaveBounds) {
  EXPECT_EQ(fault_of("GET /" + std::string(5000, 'a') + " HTTP/1.1\r\n\r\n"), 414);
  EXPECT_EQ(fault_of("GET / HTTP/1.1\r\nX: " + std::string(17000, 'a') + "\r\n\r\n"), 431);
  std::string many = "GET / HTTP/1.1\r\n";
  for (int k = 0; k < 65; ++k) many += "X: a\r\n";
  EXPECT_EQ(fault_of(many + "\r\n"), 431);
}

TEST(HttpRequest, DamagedHeadsAreRefusedOrTakenNeverMore) {
  RandomStream random(7, 0);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string head = kGood;
    for (int k = 0; k < 1 + trial % 6; ++k) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(head.size()));
      switch (random.below(static_cast<std::uint32_t>(3))) {
        case 0:
          head[at] = static_cast<char>(random.below(static_cast<std::uint32_t>(256)));
          break;
        case 1:
          head.erase(at, 1 + random.below(static_cast<std::uint32_t>(8)));
          break;
        default:
          head.insert(at, head.substr(random.below(static_cast<std::uint32_t>(head.size())),
                                      random.below(static_cast<std::uint32_t>(20))));
      }
      if (head.empty()) head = "x";
    }
    const int fault = fault_of(head);
    EXPECT_TRUE(fault == 0 || (fault >= 400 && fault < 600)) << fault;
  }
}

}  // namespace
}  // namespace limen
