// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/truth_json.h"

#include <algorithm>
#include <bit>

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
  json["file"] = scan.name + scan.ending;
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
    json["scans"].push_back({{"file", scan.name + scan.ending}, {"kind", kind_of(scan)}});
  return to_text(json);
}

namespace {

std::string file_of(const ScanTruth& scan) {
  return scan.name + scan.ending;
}

const char* kind_of(bool mobile) {
  return mobile ? "mobile" : "station";
}

Json scans_json(const Truth& truth) {
  Json scans = Json::array();
  for (std::size_t i = 0; i < truth.scans.size(); ++i) {
    const ScanTruth& scan = truth.scans[i];
    Json json;
    json["name"] = scan.name;
    json["file"] = file_of(scan);
    json["kind"] = kind_of(scan.mobile);
    json["points"] = scan.plane_of_point.size();
    json["room"] = scan.room >= 0 ? Json(scan.room) : Json(nullptr);
    json["drift_m"] = scan.drift_m;
    json["world_from_scan"] = json_of(to_matrix(world_from_scan(truth, i)));
    if (truth.model) json["target_from_source"] = json["world_from_scan"];  // the target is the model
    scans.push_back(std::move(json));
  }
  return scans;
}

double shared_m2(const Truth& truth, std::size_t a, std::size_t b) {
  for (const SharedSurface& pair : truth.shared)
    if (pair.a == std::min(a, b) && pair.b == std::max(a, b)) return pair.m2;
  return 0.0;
}

Json pairs_json(const Truth& truth) {
  Json pairs = Json::array();
  for (std::size_t source = 0; source < truth.scans.size(); ++source) {
    for (std::size_t target = 0; target < truth.scans.size(); ++target) {
      if (source == target) continue;
      Json json;
      json["source"] = file_of(truth.scans[source]);
      json["target"] = file_of(truth.scans[target]);
      json["target_from_source"] = json_of(to_matrix(true_target_from_source(truth, source, target)));
      if (!truth.shared.empty()) json["shared_m2"] = shared_m2(truth, source, target);
      pairs.push_back(std::move(json));
    }
  }
  return pairs;
}

Json bulge_json(const Bulge& bulge, const Vector3d& local_origin) {
  Json json;
  json["height_m"] = bulge.height_m;
  json["origin"] = json_of(Vector3d(bulge.origin + local_origin));
  json["u"] = json_of(bulge.u);
  json["v"] = json_of(bulge.v);
  return json;
}

Json planes_json(const Truth& truth) {
  Json planes = Json::array();
  for (std::size_t i = 0; i < truth.planes.size(); ++i) {
    const TruePlane& plane = truth.planes[i];
    Json json;
    json["id"] = i;
    json["class"] = to_string(plane.element);
    json["normal"] = json_of(plane.plane.normal);
    json["offset"] = shifted(plane.plane, -truth.local_origin).offset;
    json["local_offset"] = plane.plane.offset;
    json["area_m2"] = plane.area_m2;
    json["inliers"] = plane.inliers;
    if (plane.bulge.height_m != 0.0) json["bulge"] = bulge_json(plane.bulge, truth.local_origin);
    planes.push_back(std::move(json));
  }
  return planes;
}

template <typename Points>
Json points_json(const Points& points, const Vector3d& origin) {
  Json json = Json::array();
  for (const Vector3d& corner : points) json.push_back(json_of(Vector3d(corner + origin)));
  return json;
}

Json sights_json(const TrueOpening& opening, const Truth& truth) {
  Json sights = Json::array();
  for (std::size_t i = 0; i < opening.sights.size(); ++i) {
    const OpeningSight& sight = opening.sights[i];
    if (sight.crossed + sight.parts == 0) continue;
    Json json;
    json["scan"] = truth.scans[i].name;
    json["crossed"] = sight.crossed;
    json["through"] = sight.through;
    json["parts"] = sight.parts;
    json["share_through"] = std::popcount(sight.cells) / 64.0;
    sights.push_back(std::move(json));
  }
  return sights;
}

Json openings_json(const Truth& truth) {
  Json openings = Json::array();
  for (std::size_t i = 0; i < truth.openings.size(); ++i) {
    const TrueOpening& opening = truth.openings[i];
    Json json;
    json["id"] = i;
    json["kind"] = opening.kind;
    json["exterior"] = opening.exterior;
    json["glazed"] = opening.glazed;
    json["curtained"] = opening.curtained;
    json["rooms"] = opening.rooms;
    json["normal"] = json_of(opening.normal);
    json["thickness_m"] = opening.thickness_m;
    json["width_m"] = (opening.outer[1] - opening.outer[0]).norm();
    json["height_m"] = (opening.outer[3] - opening.outer[0]).norm();
    json["outer"] = points_json(opening.outer, truth.local_origin);
    json["inner"] = points_json(opening.inner, truth.local_origin);
    json["head"] = opening.head;
    if (opening.head != "rectangular") {
      json["outer_outline"] = points_json(opening.outer_outline, truth.local_origin);
      json["inner_outline"] = points_json(opening.inner_outline, truth.local_origin);
    }
    json["seen"] = sights_json(opening, truth);
    openings.push_back(std::move(json));
  }
  return openings;
}

Json room_json(const ModelRoom& room, const std::string& scan) {
  Json json;
  json["scan"] = scan;
  json["space"] = room.space >= 0 ? Json(room.space) : Json(nullptr);
  json["guid"] = room.guid;
  json["name"] = room.name;
  json["length_m"] = room.length_m;
  json["width_m"] = room.width_m;
  json["height_m"] = room.height_m;
  json["area_m2"] = room.area_m2;
  json["repeated"] = !room.like.empty();
  json["like"] = room.like;
  return json;
}

Json model_json(const Truth& truth) {
  const ModelTruth& model = *truth.model;
  Json json;
  json["file"] = model.file;
  json["as_built"] = model.as_built;
  json["furniture"] = model.furniture;
  json["rooms"] = Json::array();
  for (std::size_t i = 0; i < model.rooms.size(); ++i)
    json["rooms"].push_back(room_json(model.rooms[i], truth.scans[i].name));
  json["changes"] = Json::array();
  for (const ModelChange& change : model.changes) {
    Json item;
    item["element"] = change.element;
    item["guid"] = change.guid;
    item["kind"] = change.kind;
    item["state"] = to_string(change.state);
    if (change.state == ModelState::moved) item["shift_m"] = json_of(change.shift_m);
    json["changes"].push_back(std::move(item));
  }
  return json;
}

}  // namespace

std::string truth_json(const Truth& truth) {
  Json json;
  json["scene"] = truth.scene;
  json["seed"] = truth.seed;
  json["units"] = "m";
  if (truth.as_built) json["as_built"] = true;
  json["local_origin"] = json_of(truth.local_origin);
  if (truth.model) json["model"] = model_json(truth);
  json["scans"] = scans_json(truth);
  json["pairs"] = pairs_json(truth);
  json["planes"] = planes_json(truth);
  json["openings"] = openings_json(truth);
  return to_text(json);
}

std::string task_json(const SimulatedCase& simulated) {
  const std::vector<ScanTruth>& scans = simulated.truth.scans;
  Json json;
  json["units"] = "m";
  json["scans"] = Json::array();
  for (std::size_t k = 0; k < scans.size(); ++k)
    json["scans"].push_back({{"file", file_of(scans[k])},
                             {"kind", kind_of(simulated.scans[k].mobile())},
                             {"level", simulated.scans[k].level}});
  if (simulated.truth.model) {
    json["source"] = file_of(scans.front());
    json["target"] = simulated.truth.model->file;
    return to_text(json);
  }
  if (scans.size() > 1) {
    // The street's scan comes last: a mobile one, or a station in no room.
    const bool outdoor = scans.back().room < 0;
    json["source"] = file_of(scans.front());
    json["target"] = file_of(outdoor ? scans.back() : scans[1]);
  }
  return to_text(json);
}

}  // namespace limen
