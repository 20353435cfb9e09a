// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/json_values.h"

#include <algorithm>

namespace limen {
namespace {

/// Names in files may be of any encoding.
std::string dumped(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool fits_one_line(const Json& array) {
  return std::none_of(array.begin(), array.end(), [](const Json& item) { return item.is_structured(); });
}

std::string one_line(const Json& array) {
  std::string text = "[";
  for (const Json& item : array) {
    if (text.size() > 1) text += ", ";
    text += dumped(item);
  }
  text += ']';
  return text;
}

void append_indented(std::string& text, const Json& value, std::size_t indent) {
  if (!value.is_structured() || value.empty()) {
    text += dumped(value);
    return;
  }
  if (value.is_array() && fits_one_line(value)) {
    text += one_line(value);
    return;
  }
  text += value.is_object() ? '{' : '[';
  bool first = true;
  for (const auto& item : value.items()) {
    if (!first) text += ',';
    first = false;
    text += '\n';
    text.append(indent + 2, ' ');
    if (value.is_object()) {
      text += dumped(item.key());
      text += ": ";
    }
    append_indented(text, item.value(), indent + 2);
  }
  text += '\n';
  text.append(indent, ' ');
  text += value.is_object() ? '}' : ']';
}

}  // namespace

Json json_of(const Vector3d& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

Json json_of(const std::optional<double>& number) {
  return number ? Json(*number) : Json();
}

Json json_of(const Matrix4d& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < 4; ++i) {
    rows.push_back(Json::array({matrix(i, 0), matrix(i, 1), matrix(i, 2), matrix(i, 3)}));
  }
  return rows;
}

Json json_of(const ScannerPlace& place) {
  Json json = {{"source", to_string(place.source)}};
  if (place.source != PlaceSource::unknown && place.source != PlaceSource::per_point) {
    json["place"] = json_of(place.centre);
    json["confirmed"] = place.confirmed;
  }
  if (place.sigma_m) json["sigma_m"] = *place.sigma_m;
  if (place.refuted) json["refuted"] = json_of(*place.refuted);
  return json;
}

std::string to_text(const Json& value) {
  std::string text;
  append_indented(text, value, 0);
  text += '\n';
  return text;
}

}  // namespace limen
