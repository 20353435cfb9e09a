// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "limen/base/version.h"
#include "limen/report/deviation/building_report.h"
#include "limen/report/deviation/deviation_report.h"
#include "limen/report/deviation/deviation_words.h"

namespace limen {
namespace {

Json building_model_json(const BuildingModel& model) {
  return {{"path", model.path},
          {"elements", model.elements},
          {"frame_from_model", json_of(to_matrix(model.frame_from_model))},
          {"place", model.place}};
}

Json building_scan_json(const BuildingScan& scan, const ScanShare& share) {
  return {{"path", scan.path},
          {"index", scan.index},
          {"model_from_scan", json_of(to_matrix(scan.model_from_scan))},
          {"pose_sigma_m", scan.pose_sigma_m},
          {"bent", scan.bent},
          {"points", share.points},
          {"points_on_faces", share.matched},
          {"points_far_from_all_faces", share.far},
          {"seen_from_known", share.oriented},
          {"common_shift", shift_json(share.common)}};
}

Json building_summary(const BuildingReport& report) {
  const BuildingDeviation& deviation = report.deviation;
  std::size_t moved = 0;
  for (const ElementDeviation& it : deviation.elements) moved += has_moved(it, report.issues.moved_m) ? 1 : 0;
  Json json;
  json["points"] = deviation.points;
  json["points_on_faces"] = deviation.matched;
  json["points_far_from_all_faces"] = deviation.far;
  json["elements"] = presence_json(deviation.elements);
  json["elements_in_several_models"] = report.doubled;
  json["moved"] = moved;
  json["found_by_loa"] = found_by_loa_json(deviation.elements);
  json["common_shift"] = shift_json(deviation.common);
  json["unmodelled_pieces"] = deviation.unmodelled.size();
  json["issues"] = report.issues_stated;
  json["cloud_points"] = report.cloud_points;
  return json;
}

}  // namespace

std::string building_json(const BuildingReport& report) {
  const BuildingDeviation& deviation = report.deviation;
  Json json;
  json["project"] = report.project;
  json["models"] = Json::array();
  for (const BuildingModel& model : report.models) json["models"].push_back(building_model_json(model));
  json["scans"] = Json::array();
  for (std::size_t k = 0; k < report.scans.size(); ++k)
    json["scans"].push_back(building_scan_json(report.scans[k], deviation.scans[k]));
  json["left_out"] = Json::array();
  for (const BuildingLeftOut& it : report.left_out)
    json["left_out"].push_back({{"path", it.path}, {"index", it.index}, {"reason", it.reason}});
  json["options"] = {{"max_distance_m", report.measured.max_distance_m},
                     {"max_angle_deg", report.measured.max_angle_deg},
                     {"tile_m", report.measured.tile_m},
                     {"moved_m", report.issues.moved_m},
                     {"matter_m", report.issues.matter_m}};
  json["summary"] = building_summary(report);
  json["elements"] = Json::array();
  for (const std::size_t k : worst_first(deviation.elements)) {
    Json element = element_json(deviation.elements[k], report.model.elements[k]);
    element["model"] = report.model_of_element[k];
    element["seen_by"] = deviation.seen_by[k];
    element["moved"] = has_moved(deviation.elements[k], report.issues.moved_m);
    json["elements"].push_back(std::move(element));
  }
  json["unmodelled"] = Json::array();
  for (const UnmodelledObject& piece : deviation.unmodelled)
    json["unmodelled"].push_back(unmodelled_json(piece, report.model.local_origin));
  json["version"] = kVersion;
  return to_text(json);
}

Sheet building_sheet(const BuildingReport& report) {
  Sheet sheet{"Elements", {"model", "seen_by", "moved"}, {}};
  for (const std::string& column : deviation_columns()) sheet.columns.push_back(column);
  for (const std::size_t k : worst_first(report.deviation.elements)) {
    const ElementDeviation& it = report.deviation.elements[k];
    const BuildingModel& model = report.models[static_cast<std::size_t>(report.model_of_element[k])];
    SheetRow row = {text_cell(model.path), count_cell(static_cast<std::size_t>(report.deviation.seen_by[k])),
                    count_cell(has_moved(it, report.issues.moved_m) ? 1 : 0)};
    for (SheetCell& cell : deviation_row(it, report.model.elements[k])) row.push_back(std::move(cell));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace limen
