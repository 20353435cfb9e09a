// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_data.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/geometry/polygon_clip.h"
#include "limen/report/html/html_bytes.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/html_residuals.h"
#include "limen/report/html/html_tables.h"
#include "limen/report/json/json_values.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

constexpr std::size_t kMostSegments = 20000;
constexpr std::size_t kMostPoses = 200;

/// Tenths of a millimetre are enough to draw.
double rounded(double metres) {
  return std::round(1e4 * metres) / 1e4 + 0.0;
}

void append(Json& list, const Vector3d& x) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) list.push_back(rounded(x[axis]));
}

Json flat(const Ring& ring) {
  Json list = Json::array();
  for (const Vector2d& p : ring) {
    list.push_back(rounded(p.x()));
    list.push_back(rounded(p.y()));
  }
  return list;
}

std::size_t corners_of(const std::vector<std::vector<Polygon>>& outlines) {
  std::size_t count = 0;
  for (const std::vector<Polygon>& parts : outlines) {
    for (const Polygon& part : parts) {
      count += part.outer.size();
      for (const Ring& hole : part.holes) count += hole.size();
    }
  }
  return count;
}

/// Outlines as fine as the page has room for.
std::vector<std::vector<Polygon>> outlines_of(const Features& features, std::size_t most_corners) {
  std::vector<std::vector<Polygon>> outlines;
  for (const PlanarPolygon& plane : features.planes) outlines.push_back(plane.parts);
  for (double tolerance = 0.01; corners_of(outlines) > most_corners && tolerance < 1.0; tolerance *= 2.0) {
    for (std::vector<Polygon>& parts : outlines) parts = simplified(parts, tolerance);
  }
  return outlines;
}

Json planes_json(const Features& features, std::size_t most_corners) {
  Json list = Json::array();
  const std::vector<std::vector<Polygon>> outlines = outlines_of(features, most_corners);
  for (std::size_t k = 0; k < features.planes.size(); ++k) {
    const PlanarPolygon& plane = features.planes[k];
    Json parts = Json::array();
    for (const Polygon& part : outlines[k]) {
      Json rings = Json::array({flat(part.outer)});
      for (const Ring& hole : part.holes) rings.push_back(flat(hole));
      parts.push_back(std::move(rings));
    }
    list.push_back({{"o", json_of(plane.frame.origin)},
                    {"u", json_of(plane.frame.u)},
                    {"v", json_of(plane.frame.v)},
                    {"n", json_of(plane.plane.normal)},
                    {"d", plane.plane.offset},
                    {"facing", plane.oriented},
                    {"area", plane.area_m2},
                    {"rms", plane.rms_m},
                    {"parts", std::move(parts)}});
  }
  return list;
}

Json openings_json(const Features& features) {
  Json list = Json::array();
  for (const Opening& opening : features.openings) {
    Json corners = Json::array();
    if (opening.outline.size() > 2) {
      for (const Vector3d& corner : opening.outline) append(corners, corner);
    } else {
      for (const Vector3d& corner : opening.corners) append(corners, corner);
    }
    list.push_back(std::move(corners));
  }
  return list;
}

Json segments_json(const Features& features) {
  Json list = Json::array();
  for (std::size_t k = 0; k < features.segments.size() && k < kMostSegments; ++k) {
    append(list, features.segments[k].a);
    append(list, features.segments[k].b);
  }
  return list;
}

/// Pose `number` of the report: 0 is the best one. Its tables come with it, for the page shows those of the
/// pose that is looked at.
Json pose_json(const RegistrationReport& report, std::size_t number, const ReportScene& scene,
               Language language) {
  const Hypothesis& pose = number == 0 ? report.result.best : report.result.alternatives[number - 1];
  const Rigid3 local = to_local(pose.target_from_source, scene.source.origin, scene.target.origin);
  return {
      {"matrix", json_of(to_matrix(local))},
      {"text", matrix_text(file_matrix(report, pose.target_from_source))},
      {"agreeing", pose.agreeing_m2},
      {"contradicted", pose.contradicted_m2},
      {"rms", pose.rms_m},
      {"segments", pose.matched_segments},
      {"length", pose.agreeing_length_m},
      {"room", pose.room},
      {"probability", pose.probability ? in_language(probability_words(*pose.probability), language) : ""},
      {"sigma", page_in_language(sigma_table(report, number), language)},
      {"key", page_in_language(key_table(report, number), language)}};
}

Json poses_json(const RegistrationReport& report, const ReportScene& scene, Language language) {
  Json list = Json::array();
  if (report.result.outcome == Outcome::no_match) return list;
  const std::size_t count = std::min(report.result.alternatives.size() + 1, kMostPoses);
  for (std::size_t k = 0; k < count; ++k) list.push_back(pose_json(report, k, scene, language));
  return list;
}

Json open_json(const RegistrationResult& result) {
  return list_json(result.unobserved, [&](const UnobservedFreedom& freedom) -> Json {
    return {{"rotation", freedom.rotation}, {"direction", json_of(freedom.direction)}};
  });
}

Json matches_json(const RegistrationResult& result) {
  return list_json(result.matches, [&](const PlaneMatch& match) -> Json {
    return {match.source, match.target, match.distance_m};
  });
}

}  // namespace

Json side_json(const std::string& name, const SceneSide& side, const QuantisedPoints& points,
               std::size_t most_corners) {
  return {{"name", name},
          {"origin", json_of(side.origin)},
          {"low", json_of(points.low)},
          {"step", json_of(points.step)},
          {"count", side.points.empty() ? 3 * side.faces.size() : side.points.size()},
          {"shape", !side.points.empty() ? "points"
                    : side.faces.empty() ? "none"
                                         : "faces"},
          {"planes", planes_json(side.pictured.features, most_corners)},
          {"openings", openings_json(side.pictured.features)},
          {"segments", segments_json(side.pictured.features)}};
}

QuantisedPoints quantised_side(const SceneSide& side) {
  return side.points.empty() ? quantise(side.faces) : quantise(side.points);
}

std::string side_blobs(const std::string& name, const SceneSide& side, const QuantisedPoints& points,
                       const std::vector<std::uint8_t>& planes) {
  std::string text = blob_element(name + "-points", bytes_of(points.numbers));
  text += blob_element(name + "-planes", planes);
  if (!side.colours.empty())
    return text + blob_element(name + "-colours", bytes_of(packed_colours(side.colours)));
  return text + blob_element(name + "-intensities", stretched(side.intensities));
}

std::string scene_elements(const RegistrationReport& report, const ReportScene& scene, const SceneView& view,
                           Language language) {
  const RegistrationResult& result = report.result;
  const QuantisedPoints source = quantised_side(scene.source);
  const QuantisedPoints target = quantised_side(scene.target);
  const std::vector<std::uint8_t> source_planes = plane_of_points(scene.source);
  Json json = {{"source", side_json(file_name(report.source), scene.source, source)},
               {"target", side_json(file_name(report.target), scene.target, target)},
               {"axes", Json::array()},
               {"low", json_of(view.low)},
               {"high", json_of(view.high)},
               {"cut", json_of(view.cut)},
               {"beside", json_of(to_matrix(view.target_from_source))},
               {"poses", poses_json(report, scene, language)},
               {"open", open_json(result)},
               {"matches", matches_json(result)}};
  for (Eigen::Index k = 0; k < 3; ++k)
    json["axes"].push_back(json_of(Vector3d(view.view_from_target.row(k).transpose())));
  std::string blobs = side_blobs("source", scene.source, source, source_planes) +
                      side_blobs("target", scene.target, target, plane_of_points(scene.target));
  if (view.matched && !result.matches.empty()) {
    const PointResiduals residuals = point_residuals(scene, result, source_planes);
    json["residual_range"] = residuals.range_m;
    blobs += blob_element("source-residuals", residuals.values);
  }
  return json_element(std::move(json)) + blobs;
}

}  // namespace limen
