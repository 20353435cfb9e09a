// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/version.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/deviation/deviation_words.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

Json summary_json(const Deviation& deviation) {
  Json json;
  json["points"] = deviation.distance_m.size();
  json["points_on_faces"] = deviation.matched;
  json["points_far_from_all_faces"] = deviation.far;
  json["seen_from_known"] = deviation.oriented;
  json["elements"] = presence_json(deviation.elements);
  json["found_by_loa"] = found_by_loa_json(deviation.elements);
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
  for (const UnmodelledObject& piece : deviation.unmodelled)
    json["unmodelled"].push_back(unmodelled_json(piece, model.local_origin));
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
