// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "limen/geometry/rigid.h"
#include "limen/model/scanner_place.h"

namespace limen {

/// Keys keep the order in which they were written. For sources only: no installed header needs it.
using Json = nlohmann::ordered_json;

Json json_of(const Vector3d& vector);
/// null where there is none.
Json json_of(const std::optional<double>& number);
/// Four rows of four numbers.
Json json_of(const Matrix4d& matrix);
/// Where a scanner stood and how that is known: `source` always, the rest where it means something.
Json json_of(const ScannerPlace& place);

/// An array of what `make` makes of each value of a list.
template <typename List, typename Make>
Json list_json(const List& list, const Make& make) {
  Json json = Json::array();
  for (const auto& item : list) json.push_back(make(item));
  return json;
}

/// JSON text for readers and programs: two spaces per level, arrays of plain values on one line, the shortest
/// digits that give back every double bit for bit, a line end last. Numbers that are not finite become null.
std::string to_text(const Json& value);

}  // namespace limen
