// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/http_request.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::size_t kMostFields = 64;
constexpr std::size_t kMostTargetBytes = 4096;
constexpr std::string_view kLineEnd = "\r\n";

/// RFC 9110, section 5.6.2.
bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
  });
}

/// Neither controls nor what could end a line; bytes beyond ASCII are let through.
bool is_field_value(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return c == '\t' || (byte >= 0x20U && byte != 0x7FU);
  });
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string decoded(std::string_view text) {
  std::string plain;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '%') {
      plain += text[k];
      continue;
    }
    const int high = k + 2 < text.size() ? hex_digit(text[k + 1]) : -1;
    const int low = k + 2 < text.size() ? hex_digit(text[k + 2]) : -1;
    if (high < 0 || low < 0)
      throw HttpFault(400, "a % in the address is followed by no two hexadecimal digits");
    plain += static_cast<char>(16 * high + low);
    k += 2;
  }
  return plain;
}

std::vector<std::string> segments_of(std::string_view target) {
  if (target.size() > kMostTargetBytes) throw HttpFault(414, "the address is too long");
  const bool visible =
      std::all_of(target.begin(), target.end(), [](char c) { return c > 0x20 && c < 0x7F && c != '#'; });
  if (target.empty() || target.front() != '/' || !visible)
    throw HttpFault(400, "the address is not a path that begins with /");
  std::string_view path = target.substr(1, target.find('?') - 1);
  std::vector<std::string> segments;
  for (;;) {
    const std::size_t slash = path.find('/');
    // A % that a slash cuts off is caught by the two digits it needs.
    segments.push_back(decoded(std::string(path.substr(0, slash))));
    if (slash == std::string_view::npos) return segments;
    path.remove_prefix(slash + 1);
  }
}

void take_first_line(std::string_view line, HttpRequest& request) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last)
    throw HttpFault(400, "the first line is not method, address and version");
  request.method = line.substr(0, first);
  const std::string_view version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") throw HttpFault(505, "only HTTP/1.1 is supported");
  constexpr std::array<std::string_view, 5> kMethods{"GET", "HEAD", "POST", "PUT", "DELETE"};
  if (std::find(kMethods.begin(), kMethods.end(), request.method) == kMethods.end())
    throw HttpFault(is_token(request.method) ? 405 : 400, "the method is not known");
  request.segments = segments_of(line.substr(first + 1, last - first - 1));
}

void take_field(std::string_view line, HttpRequest& request) {
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, colon);
  if (colon == std::string_view::npos || !is_token(name)) throw HttpFault(400, "a field has no name");
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!is_field_value(value)) throw HttpFault(400, "a field holds control characters");
  if (request.fields.size() == kMostFields) throw HttpFault(431, "there are too many fields");
  request.fields.emplace_back(lower_case(name), value);
}

void take_length(HttpRequest& request) {
  if (!request.field("transfer-encoding").empty())
    throw HttpFault(501, "a body must come with its length, not in chunks");
  const auto stated = [](const auto& field) { return field.first == "content-length"; };
  request.has_content = std::any_of(request.fields.begin(), request.fields.end(), stated);
  if (!request.has_content) return;
  const std::string text = request.field("content-length");
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, request.content_bytes);
  if (read.ec != std::errc() || read.ptr != end)
    throw HttpFault(400, "the length of the body is not a number");
}

}  // namespace

std::string HttpRequest::field(std::string_view name) const {
  const auto called = [&](const auto& field) { return field.first == name; };
  const auto found = std::find_if(fields.begin(), fields.end(), called);
  if (found == fields.end()) return {};
  if (std::find_if(found + 1, fields.end(), called) != fields.end())
    throw HttpFault(400, "a field occurs twice");
  return found->second;
}

HttpRequest parse_http_head(std::string_view head) {
  if (head.size() > kMostHeadBytes) throw HttpFault(431, "the head is too long");
  HttpRequest request;
  std::size_t end = head.find(kLineEnd);
  if (end == std::string_view::npos) throw HttpFault(400, "the head does not end");
  take_first_line(head.substr(0, end), request);
  for (;;) {
    head.remove_prefix(end + kLineEnd.size());
    end = head.find(kLineEnd);
    if (end == std::string_view::npos) throw HttpFault(400, "the head does not end");
    if (end == 0) break;
    take_field(head.substr(0, end), request);
  }
  if (head.size() > kLineEnd.size()) throw HttpFault(400, "there is more than a head");
  take_length(request);
  request.expects_continue = lower_case(request.field("expect")) == "100-continue";
  return request;
}

}  // namespace limen
