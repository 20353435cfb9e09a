// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/gate.h"

#include <array>
#include <cerrno>

#include <fmt/format.h>
#include <sys/random.h>

#include "limen/base/error.h"
#include "limen/base/text.h"

namespace limen {

void Gate::check(const HttpRequest& request) const {
  const std::string here = fmt::format("127.0.0.1:{}", port);
  const std::string here_by_name = fmt::format("localhost:{}", port);
  const std::string host = request.field("host");
  if (host != here && host != here_by_name) throw HttpFault(403, "the request is meant for another machine");
  const std::string origin = request.field("origin");
  if (!origin.empty() && origin != "http://" + host)
    throw HttpFault(403, "requests from pages of other origins are refused");
  const std::string site = request.field("sec-fetch-site");
  // An address that was typed or pasted comes from no site. A link on a page of somebody else brings nobody
  // in.
  if (site == "cross-site" || (site == "same-site" && request.method != "GET"))
    throw HttpFault(403, "requests from pages of other sites are refused");
  if (!same_secret(request.segments.front(), token))
    throw HttpFault(
        404, "there is nothing here: the token in the address is missing, or belongs to an earlier run");
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error("the system gives no random bytes: " + reason_of(errno), "limen serve", "check the system",
                Fault::internal);
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    difference = static_cast<unsigned char>(
        difference | (static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k])));
  return difference == 0;
}

bool is_safe_name(std::string_view name) {
  constexpr std::size_t kLongest = 200;
  if (name.empty() || name.size() > kLongest || name.front() == '.') return false;
  return name.find_first_of("/\\ \t\r\n") == std::string_view::npos && printable(name) == name &&
         name.find('\0') == std::string_view::npos;
}

}  // namespace limen
