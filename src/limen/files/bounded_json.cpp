// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/bounded_json.h"

#include <utility>

namespace limen {
namespace {

template <typename Json, typename Input>
Json bounded_json(Input&& input) {
  const auto bounded = [](int depth, typename Json::parse_event_t event, const Json&) {
    using Event = typename Json::parse_event_t;
    if (depth >= kDeepestJson && (event == Event::object_start || event == Event::array_start))
      throw JsonTooDeep();
    return true;
  };
  return Json::parse(std::forward<Input>(input), bounded);
}

template <typename Json, typename Input>
Json bounded_json_or_nothing(Input&& input) {
  try {
    return bounded_json<Json>(std::forward<Input>(input));
  } catch (const JsonTooDeep&) {
    return Json(Json::value_t::discarded);
  } catch (const typename Json::exception&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace

template <typename Json>
Json parsed_json(std::string_view text) {
  return bounded_json<Json>(text);
}

template <typename Json>
Json json_or_nothing(std::string_view text) {
  return bounded_json_or_nothing<Json>(text);
}

template <typename Json>
Json json_or_nothing(std::istream& stream) {
  return bounded_json_or_nothing<Json>(stream);
}

// The library's parser is compiled here and nowhere else.
template nlohmann::json parsed_json(std::string_view);
template nlohmann::json json_or_nothing(std::string_view);
template nlohmann::json json_or_nothing(std::istream&);
template nlohmann::ordered_json parsed_json(std::string_view);
template nlohmann::ordered_json json_or_nothing(std::string_view);
template nlohmann::ordered_json json_or_nothing(std::istream&);

}  // namespace limen
