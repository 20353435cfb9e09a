// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limen {

/// What is wrong with a request, as a status of HTTP and in words for its sender.
struct HttpFault : std::runtime_error {
  HttpFault(int code, const std::string& words) : std::runtime_error(words), status(code) {}
  int status;
};

/// The head of a request: its first line and its fields, without the body.
struct HttpRequest {
  std::string method;                 ///< GET, HEAD, POST, PUT or DELETE
  std::vector<std::string> segments;  ///< of the path, decoded: "/a/b%20c/" is "a", "b c", ""
  std::vector<std::pair<std::string, std::string>> fields;  ///< names in lower case, as they came
  std::uint64_t content_bytes = 0;                          ///< of the body
  bool has_content = false;                                 ///< a length was stated, if only of 0
  bool expects_continue = false;

  /// The value of a field that is there once; empty where it is missing. Throws HttpFault where it is
  /// there twice: two readers could take different ones.
  [[nodiscard]] std::string field(std::string_view name) const;
};

inline constexpr std::size_t kMostHeadBytes = 16384;

/// Parses a head that ends with an empty line (RFC 9112), strictly: lines end with CR LF, no field is folded,
/// lengths are digits and stated once, nothing is sent in chunks. Throws HttpFault that tells what is wrong.
HttpRequest parse_http_head(std::string_view head);

}  // namespace limen
