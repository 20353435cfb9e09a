// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/project_truth_json.h"

#include "limen/report/json/json_values.h"

namespace limen {
namespace {

Json number_or_null(int number) {
  return number >= 0 ? Json(number) : Json(nullptr);
}

const char* kind_of(const SimulatedScan& scan) {
  return scan.mobile ? "mobile" : "station";
}

Json scan_json(const ProjectTruth& truth, std::size_t index) {
  const SimulatedScan& scan = truth.scans[index];
  Json json;
  json["name"] = scan.name;
  json["file"] = scan.name + ".ply";
  json["kind"] = kind_of(scan);
  json["points"] = scan.points;
  json["room"] = number_or_null(scan.room);
  if (!scan.mobile) json["scanner"] = json_of(scan.scanner);
  json["drift_m"] = scan.drift_m;
  if (scan.mobile) {
    json["drift"] = Json::array();
    for (const DriftSample& sample : scan.drift)
      json["drift"].push_back({sample.time_s, sample.error.x(), sample.error.y(), sample.error.z()});
  }
  json["surface_m2"] = scan.surface_m2;
  json["world_from_scan"] = json_of(to_matrix(world_from_scan(truth, index)));
  return json;
}

Json room_json(const ProjectRoom& room) {
  Json json;
  json["storey"] = room.storey;
  json["unit"] = number_or_null(room.unit);
  json["use"] = room.use;
  json["area_m2"] = room.area_m2;
  json["alike"] = number_or_null(room.alike);
  json["mirrored"] = room.mirrored;
  json["furnished_alike"] = room.furnished_alike;
  return json;
}

}  // namespace

std::string project_truth_json(const ProjectTruth& truth) {
  Json json;
  json["building"] = truth.building;
  json["seed"] = truth.seed;
  if (truth.as_built) json["as_built"] = true;
  json["units"] = "m";
  json["local_origin"] = json_of(truth.local_origin);
  json["scans"] = Json::array();
  for (std::size_t i = 0; i < truth.scans.size(); ++i) json["scans"].push_back(scan_json(truth, i));
  json["shared"] = Json::array();
  for (const SharedSurface& pair : truth.shared)
    json["shared"].push_back({{"a", pair.a}, {"b", pair.b}, {"m2", pair.m2}});
  json["rooms"] = Json::array();
  for (const ProjectRoom& room : truth.rooms) json["rooms"].push_back(room_json(room));
  return to_text(json);
}

std::string project_task_json(const ProjectTruth& truth) {
  Json json;
  json["units"] = "m";
  json["scans"] = Json::array();
  for (const SimulatedScan& scan : truth.scans)
    json["scans"].push_back({{"file", scan.name + ".ply"}, {"kind", kind_of(scan)}});
  return to_text(json);
}

}  // namespace limen
