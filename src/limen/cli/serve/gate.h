// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "limen/cli/serve/http_request.h"

namespace limen {

/// Who is let in: whoever knows the token in the address, from this machine, and from no page but our own.
struct Gate {
  std::string token;  ///< 32 hexadecimal digits
  int port = 0;

  /// Throws HttpFault where the request is not for us (Host is another name: a name that was made to point
  /// here), comes from a page of somebody else (Origin, Sec-Fetch-Site), or does not know the token. The
  /// first segment of the path is the token.
  void check(const HttpRequest& request) const;
};

/// 128 bits of the system's randomness. Throws Error where it has none.
std::string new_token();

/// Whether both are the same, in a time that depends on their lengths only.
bool same_secret(std::string_view a, std::string_view b);

/// Whether a file may be called so: one component of a path, of 1 to 200 bytes, printable UTF-8 without
/// blanks, that does not begin with a dot and needs no quoting by limen's own lists of words.
bool is_safe_name(std::string_view name);

}  // namespace limen
