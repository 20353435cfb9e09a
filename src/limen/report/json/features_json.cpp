// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/features_json.h"

#include "limen/base/version.h"
#include "limen/report/json/json_values.h"

namespace limen {

std::string segments_json(const Features& features, const InputSummary& input) {
  Json json;
  json["input"] = {{"path", input.path}, {"points", input.points}, {"centre_known", input.centre_known}};
  if (input.kind == "scan") json["input"]["scanner"] = json_of(input.place);
  json["segments"] = Json::array();
  for (const Segment& segment : features.segments) {
    Json ends;
    ends["a"] = json_of(Vector3d(features.local_origin + segment.a));
    ends["b"] = json_of(Vector3d(features.local_origin + segment.b));
    json["segments"].push_back(std::move(ends));
  }
  json["version"] = kVersion;
  return to_text(json);
}

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
  Json parts = list_json(
      polygon.parts, [&](const Polygon& part) -> Json { return outline_json(part, polygon, local_origin); });
  json["outline"] = parts.empty() ? Json::array() : parts.front();
  if (!parts.empty()) parts.erase(0);
  json["parts"] = std::move(parts);
  return json;
}

Json opening_json(const Opening& opening, const Vector3d& local_origin) {
  Json json;
  json["corners"] = list_json(opening.corners, [&](const Vector3d& corner) -> Json {
    return json_of(Vector3d(local_origin + corner));
  });
  json["facade"] = opening.facade;
  json["evidence"] = opening.evidence;
  json["view"] = to_string(opening.view);
  json["edge_sigma_m"] = opening.edge_sigma_m;
  json["reveal_depth_m"] = opening.reveal_depth_m;
  json["reveal_sigma_m"] = opening.reveal_sigma_m;
  json["reveal_complete"] = opening.reveal_complete;
  json["outline"] = list_json(opening.outline, [&](const Vector3d& point) -> Json {
    return json_of(Vector3d(local_origin + point));
  });
  return json;
}

Json json_of_features(const Features& features, const InputSummary& input) {
  Json json;
  json["input"] = {{"path", input.path}, {"points", input.points}, {"centre_known", input.centre_known}};
  if (input.kind == "scan") json["input"]["scanner"] = json_of(input.place);
  json["inlier_threshold_m"] = features.inlier_threshold_m;
  json["noise_m"] = features.noise_m;
  json["planes"] = list_json(features.planes, [&](const PlanarPolygon& polygon) -> Json {
    return plane_json(polygon, features.local_origin);
  });
  return json;
}

}  // namespace

std::string features_json(const Features& features, const InputSummary& input) {
  Json json = json_of_features(features, input);
  json["version"] = kVersion;
  return to_text(json);
}

std::string openings_json(const Features& features, const InputSummary& input) {
  Json json = json_of_features(features, input);
  json["openings"] = list_json(features.openings, [&](const Opening& opening) -> Json {
    return opening_json(opening, features.local_origin);
  });
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
