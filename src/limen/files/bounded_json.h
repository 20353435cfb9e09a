// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace limen {

/// How deep JSON may be nested: what works on a value of any depth calls itself, and ends where the stack
/// does.
inline constexpr int kDeepestJson = 64;

/// That it is nested deeper.
struct JsonTooDeep : std::runtime_error {
  JsonTooDeep()
      : std::runtime_error("it is nested deeper than " + std::to_string(kDeepestJson) + " levels") {}
};

/// What a text holds: the only way in which JSON is read, as nlohmann::json or nlohmann::ordered_json. Throws
/// the library's own exceptions where it is no JSON, and JsonTooDeep before the value grows too deep. For
/// sources only.
template <typename Json>
Json parsed_json(std::string_view text);

/// The same; a value that is discarded where it throws.
template <typename Json>
Json json_or_nothing(std::string_view text);
template <typename Json>
Json json_or_nothing(std::istream& stream);

}  // namespace limen
