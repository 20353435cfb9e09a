// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <fmt/format.h>

#include "limen/base/version.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

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

Json unmodelled_json(const UnmodelledMatter& piece, const Vector3d& local_origin) {
  const Vector3d size = piece.high - piece.low;
  return {{"points", piece.points},
          {"centre", json_of(Vector3d(local_origin + piece.centre))},
          {"low", json_of(Vector3d(local_origin + piece.low))},
          {"high", json_of(Vector3d(local_origin + piece.high))},
          {"size_m", json_of(size)},
          {"within_model", piece.within_model}};
}

Json summary_json(const Deviation& deviation) {
  std::map<std::string, std::size_t> presence = {{"found", 0}, {"not_found", 0}, {"not_judged", 0}};
  std::map<int, std::size_t> classes = {{10, 0}, {20, 0}, {30, 0}, {40, 0}, {50, 0}};
  std::size_t without = 0;
  for (const ElementDeviation& it : deviation.elements) {
    ++presence[to_string(it.presence)];
    if (it.presence != Presence::found) continue;
    if (it.loa > 0) {
      ++classes[it.loa];
    } else {
      ++without;
    }
  }
  Json json;
  json["points"] = deviation.distance_m.size();
  json["points_on_faces"] = deviation.matched;
  json["points_far_from_all_faces"] = deviation.far;
  json["seen_from_known"] = deviation.oriented;
  for (const auto& [name, count] : presence) json["elements"][name] = count;
  for (const auto& [loa, count] : classes) json["found_by_loa"][fmt::format("LOA{}", loa)] = count;
  json["found_by_loa"]["none"] = without;
  json["common_shift"] = shift_json(deviation.common);
  json["unmodelled_pieces"] = deviation.unmodelled.size();
  return json;
}

Json options_json(const DeviationReport& report) {
  Json json = {{"max_distance_m", report.measured.max_distance_m},
               {"max_angle_deg", report.measured.max_angle_deg},
               {"tile_m", report.measured.tile_m}};
  for (const auto& [name, value] : report.options)
    std::visit([&json, &key = name](const auto& plain) { json[key] = plain; }, value);
  return json;
}

}  // namespace

std::string deviation_json(const DeviationReport& report, const BimModel& model) {
  const Deviation& deviation = report.deviation;
  Json json;
  json["inputs"]["scan"] = {{"path", report.scan.path}, {"points", report.scan.points}};
  if (!report.scan.with.empty()) json["inputs"]["scan"]["with"] = report.scan.with;
  json["inputs"]["model"] = {{"path", report.model.path}, {"elements", model.elements.size()}};
  json["pose"] = {{"result", report.result_path.empty() ? Json() : Json(report.result_path)},
                  {"outcome", report.result_outcome.empty() ? Json() : Json(report.result_outcome)},
                  {"model_from_scan", json_of(to_matrix(report.model_from_scan))}};
  json["options"] = options_json(report);
  json["summary"] = summary_json(deviation);
  json["elements"] = Json::array();
  for (const ElementDeviation& it : deviation.elements)
    json["elements"].push_back(element_json(it, model.elements[static_cast<std::size_t>(it.element)]));
  json["unmodelled"] = Json::array();
  for (const UnmodelledMatter& piece : deviation.unmodelled)
    json["unmodelled"].push_back(unmodelled_json(piece, model.local_origin));
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
