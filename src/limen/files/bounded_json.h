// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

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

/// What a text or a stream holds: the only way in which JSON is read. Throws the library's own exceptions
/// where it is no JSON, and JsonTooDeep before the value grows too deep. For sources only.
template <typename Json, typename Input>
Json parsed_json(Input&& input) {
  const auto bounded = [](int depth, typename Json::parse_event_t event, const Json&) {
    using Event = typename Json::parse_event_t;
    if (depth >= kDeepestJson && (event == Event::object_start || event == Event::array_start))
      throw JsonTooDeep();
    return true;
  };
  return Json::parse(std::forward<Input>(input), bounded);
}

/// The same; a value that is discarded where it throws.
template <typename Json, typename Input>
Json json_or_nothing(Input&& input) {
  try {
    return parsed_json<Json>(std::forward<Input>(input));
  } catch (const JsonTooDeep&) {
    return Json(Json::value_t::discarded);
  } catch (const typename Json::exception&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace limen
