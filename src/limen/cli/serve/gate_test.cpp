// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/gate.h"

#include <string>

#include <gtest/gtest.h>

namespace limen {
namespace {

const Gate kGate{"0123456789abcdef0123456789abcdef", 8123};

/// 0 where it is let in.
int stated_at_gate(const std::string& path, const std::string& fields, const std::string& method = "GET") {
  try {
    kGate.check(parse_http_head(method + " " + path + " HTTP/1.1\r\n" + fields + "\r\n"));
  } catch (const HttpFault& fault) {
    return fault.status;
  }
  return 0;
}

const std::string kInside = "/0123456789abcdef0123456789abcdef/";
const std::string kHost = "Host: 127.0.0.1:8123\r\n";

TEST(Gate, LetsInWhoKnowsTheToken) {
  EXPECT_EQ(stated_at_gate(kInside, kHost), 0);
  EXPECT_EQ(stated_at_gate(kInside, "Host: localhost:8123\r\n"), 0);
  EXPECT_EQ(stated_at_gate(
                kInside, kHost + "Origin: http://127.0.0.1:8123\r\nSec-Fetch-Site: same-origin\r\n", "POST"),
            0);
  EXPECT_EQ(stated_at_gate(kInside, kHost + "Sec-Fetch-Site: none\r\n"), 0);
}

TEST(Gate, KeepsOutWhoDoesNot) {
  for (const std::string path :
       {"/", "/state", "/0123456789abcdef0123456789abcdee/", "/0123456789abcdef/",
        "/0123456789abcdef0123456789abcdef0/", "//", "/0123456789ABCDEF0123456789ABCDEF/"})
    EXPECT_EQ(stated_at_gate(path, kHost), 404) << path;
}

TEST(Gate, KeepsOutOtherNamesAndPages) {
  for (const std::string host :
       {"", "Host: evil.example:8123\r\n", "Host: 127.0.0.1\r\n", "Host: 127.0.0.1:8124\r\n",
        "Host: 127.0.0.1:8123.evil.example\r\n", "Host: [::1]:8123\r\n", "Host: 0.0.0.0:8123\r\n"})
    EXPECT_EQ(stated_at_gate(kInside, host), 403) << host;
  EXPECT_EQ(stated_at_gate(kInside, "Host: 127.0.0.1:8123\r\nHost: 127.0.0.1:8123\r\n"), 400);
  for (const std::string origin :
       {"null", "http://evil.example", "https://127.0.0.1:8123", "http://127.0.0.1", "http://localhost:8123",
        "http://127.0.0.1:8123.evil.example"})
    EXPECT_EQ(stated_at_gate(kInside, kHost + "Origin: " + origin + "\r\n", "POST"), 403) << origin;
  EXPECT_EQ(stated_at_gate(kInside, kHost + "Sec-Fetch-Site: cross-site\r\n"), 403);
  EXPECT_EQ(stated_at_gate(kInside, kHost + "Sec-Fetch-Site: same-site\r\n", "POST"), 403);
}

TEST(Gate, TokensAreNewAndLong) {
  const std::string token = new_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, new_token());
  EXPECT_TRUE(same_secret(token, std::string(token)));
  EXPECT_FALSE(same_secret(token, ""));
}

TEST(Gate, NamesLeadNowhereElse) {
  for (const std::string name : {"a.ply", "Gr\xc3\xbcn_1.e57", "a-b+c(1).laz", "a..b"})
    EXPECT_TRUE(is_safe_name(name));
  for (const std::string name :
       {"", ".", "..", ".hidden", "a/b", "../a", "a\\b", "a b", "a\tb", "a\nb", "a\x1b", "\xff"})
    EXPECT_FALSE(is_safe_name(name)) << name;
  EXPECT_FALSE(is_safe_name(std::string("a\0b", 3)));
  EXPECT_FALSE(is_safe_name(std::string(201, 'a')));
}

}  // namespace
}  // namespace limen
