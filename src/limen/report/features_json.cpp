// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/features_json.h"

#include "limen/base/version.h"
#include "limen/report/json_values.h"

namespace limen {
namespace {

Json ring_json(const Ring& ring, const PlanarPolygon& polygon, const Vector3d& local_origin) {
  Json points = Json::array();
  for (const Vector2d& p : ring) {
    const Vector3d x_in_world = local_origin + polygon.frame.to_space(p);
    points.push_back(json_of(x_in_world));
  }
  return points;
}

Json outline_json(const Polygon& part, const PlanarPolygon& polygon, const Vector3d& local_origin) {
  Json rings = Json::array();
  rings.push_back(ring_json(part.outer, polygon, local_origin));
  for (const Ring& hole : part.holes) rings.push_back(ring_json(hole, polygon, local_origin));
  return rings;
}

Json plane_json(const PlanarPolygon& polygon, const Vector3d& local_origin) {
  Json json;
  json["normal"] = json_of(polygon.plane.normal);
  json["offset"] = shifted(polygon.plane, -local_origin).offset;
  json["inliers"] = polygon.inliers;
  json["rms_m"] = polygon.rms_m;
  json["area_m2"] = polygon.area_m2;
  json["oriented"] = polygon.oriented;
  Json parts = Json::array();
  for (const Polygon& part : polygon.parts) parts.push_back(outline_json(part, polygon, local_origin));
  json["outline"] = parts.empty() ? Json::array() : parts.front();
  if (!parts.empty()) parts.erase(0);
  json["parts"] = std::move(parts);
  return json;
}

}  // namespace

std::string features_json(const Features& features, const InputSummary& input) {
  Json json;
  json["input"] = {{"path", input.path}, {"points", input.points}, {"centre_known", input.centre_known}};
  json["inlier_threshold_m"] = features.inlier_threshold_m;
  json["noise_m"] = features.noise_m;
  json["planes"] = Json::array();
  for (const PlanarPolygon& polygon : features.planes) {
    json["planes"].push_back(plane_json(polygon, features.local_origin));
  }
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
