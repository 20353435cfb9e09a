// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/deviation/deviation_words.h"

#include <map>
#include <string>

#include <fmt/format.h>

namespace limen {

Json shift_json(const ElementShift& shift) {
  Json json;
  json["shift_m"] = json_of(shift.shift_m);
  json["sigma_m"] = json_of(shift.sigma_m);
  json["held"] = shift.held;
  json["open"] = Json::array();
  for (const Vector3d& direction : shift.open) json["open"].push_back(json_of(direction));
  return json;
}

Json element_json(const ElementDeviation& it, const BimElement& element) {
  Json json;
  json["element"] = it.element;
  json["kind"] = to_string(element.kind);
  json["type"] = element.type;
  json["guid"] = element.guid;
  json["name"] = element.name;
  json["storey"] = element.storey;
  json["presence"] = to_string(it.presence);
  json["points"] = it.points;
  json["area_m2"] = it.area_m2;
  json["covered_m2"] = it.covered_m2;
  json["passed_m2"] = it.passed_m2;
  json["covered_share"] = it.covered_share;
  if (it.points == 0) return json;
  json["median_m"] = it.median_m;
  json["mean_m"] = it.mean_m;
  json["sigma_m"] = it.sigma_m;
  json["p95_m"] = it.p95_m;
  json["loa"] = it.loa > 0 ? Json(fmt::format("LOA{}", it.loa)) : Json();
  json["shift"] = shift_json(it.shift);
  return json;
}

Json unmodelled_json(const UnmodelledObject& piece, const Vector3d& local_origin) {
  const Vector3d size = piece.high - piece.low;
  return {{"points", piece.points},
          {"centre", json_of(Vector3d(local_origin + piece.centre))},
          {"low", json_of(Vector3d(local_origin + piece.low))},
          {"high", json_of(Vector3d(local_origin + piece.high))},
          {"size_m", json_of(size)},
          {"within_model", piece.within_model}};
}

Json presence_json(const std::vector<ElementDeviation>& elements) {
  std::map<std::string, std::size_t> presence = {{"found", 0}, {"not_found", 0}, {"not_judged", 0}};
  for (const ElementDeviation& it : elements) ++presence[to_string(it.presence)];
  Json json;
  for (const auto& [name, count] : presence) json[name] = count;
  return json;
}

Json found_by_loa_json(const std::vector<ElementDeviation>& elements) {
  std::map<int, std::size_t> classes = {{10, 0}, {20, 0}, {30, 0}, {40, 0}, {50, 0}};
  std::size_t without = 0;
  for (const ElementDeviation& it : elements) {
    if (it.presence != Presence::found) continue;
    if (it.loa > 0) {
      ++classes[it.loa];
    } else {
      ++without;
    }
  }
  Json json;
  for (const auto& [loa, count] : classes) json[fmt::format("LOA{}", loa)] = count;
  json["none"] = without;
  return json;
}

}  // namespace limen
