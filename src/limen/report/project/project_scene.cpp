// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/report/html/html_data.h"
#include "limen/report/html/html_elements.h"
#include "limen/report/html/html_scene.h"
#include "limen/report/project/page_parts.h"
#include "limen/report/project/project_axes.h"
#include "limen/report/project/station_accuracy.h"

namespace limen {
namespace {

constexpr std::size_t kCornersOfAll = 120000;  // of outlines
constexpr std::size_t kMostMatches = 12;       // of a link that are listed, those with the largest overlap

/// From the report's axes about `origin` (a place in the frame).
struct PageFrame {
  Matrix3d axes;
  Vector3d origin;

  /// Of what lies about `local_origin` in a scan's world.
  [[nodiscard]] Rigid3 page_from_local(const Rigid3& frame_from_scan, const Vector3d& local_origin) const {
    const Rigid3 local = to_local(frame_from_scan, local_origin, origin);
    return {axes * local.rotation, axes * local.translation};
  }
  [[nodiscard]] Vector3d page_from_frame(const Vector3d& x) const { return axes * (x - origin); }
};

SceneSide side_of(ProjectPicture picture) {
  SceneSide side;
  side.origin = picture.points.local_origin;
  side.points = std::move(picture.points.points);
  side.colours = std::move(picture.points.colours);
  side.intensities = std::move(picture.points.intensities);
  PicturedSide pictured;
  pictured.features = std::move(picture.features);
  if (pictured.features.planes.empty()) {
    pictured.features.local_origin = side.origin;
  } else if (side.points.empty()) {
    side.origin = pictured.features.local_origin;
  }
  return with_picture(std::move(side), pictured);
}

std::string words_of(const ProjectScan& scan, std::size_t shown) {
  if (!scan.readable) return "cannot be read";
  const std::string kind = scan.model    ? "model"
                           : scan.mobile ? fmt::format("pass, {} of {} points", shown, scan.points)
                                         : fmt::format("{} of {} points", shown, scan.points);
  return fmt::format("{}; {}", to_string(scan.state), kind);
}

Json matches_of(const ProjectLink& link) {
  std::vector<PlaneMatch> matches = link.matches;
  std::stable_sort(matches.begin(), matches.end(),
                   [](const PlaneMatch& a, const PlaneMatch& b) { return a.overlap_m2 > b.overlap_m2; });
  Json list = Json::array();
  for (std::size_t k = 0; k < matches.size() && k < kMostMatches; ++k)
    list.push_back({matches[k].source, matches[k].target, matches[k].distance_m,
                    degrees(matches[k].angle_rad), matches[k].overlap_m2});
  return list;
}

Json openings_of(const ProjectLink& link) {
  Json list = Json::array();
  for (std::size_t k = 0; k < link.openings.size() && k < kMostMatches; ++k) {
    const MatchedOpenings& match = link.openings[k];
    list.push_back({match.source, match.target, match.shift_across_m, match.shift_up_m});
  }
  return list;
}

/// Where the frame's middle is, roughly: near the first scan's station.
Vector3d origin_of(const ProjectResult& result) {
  for (const ProjectScan& scan : result.scans) {
    if (scan.component == 0 && scan.frame_from_scan) return scan.sigma.centre.array().round();
  }
  return Vector3d::Zero();
}

Json links_of(const ProjectResult& result, const std::vector<Vector3d>& origins, Language language) {
  Json list = Json::array();
  for (const ProjectLink& link : result.links) {
    const auto s = static_cast<std::size_t>(link.source);
    const auto t = static_cast<std::size_t>(link.target);
    list.push_back({{"source", link.source},
                    {"target", link.target},
                    {"state", to_string(link.solved.state)},
                    {"pair", link.given ? "given" : to_string(link.pair)},
                    {"reason", in_language(link.reason, language)},
                    {"agreeing", link.agreeing_m2},
                    {"misses_m", is_checked(link) ? Json(link.solved.loop_error_m) : Json()},
                    {"misses_deg", degrees(link.solved.loop_error_rad)},
                    {"planes", link.matches.size()},
                    {"matches", matches_of(link)},
                    {"openings", openings_of(link)},
                    {"pose", json_of(to_matrix(to_local(link.target_from_source, origins[s], origins[t])))}});
  }
  return list;
}

Json floors_of(const ProjectResult& result, const PageFrame& frame) {
  Json list = Json::array();
  for (const std::vector<PlanSpot>& floor : project_floors(result, frame.axes)) {
    Json scans = Json::array();
    for (const PlanSpot& spot : floor) scans.push_back(spot.scan);
    // The middle one: most stand as high.
    const double height = floor[floor.size() / 2].at.z();
    list.push_back({{"z", height - frame.axes.row(2).dot(frame.origin)}, {"scans", std::move(scans)}});
  }
  return list;
}

}  // namespace

std::string project_scene(const ProjectResult& result, std::vector<ProjectPicture> pictures,
                          Language language) {
  pictures.resize(result.scans.size());
  const PageFrame frame{project_axes(result), origin_of(result)};
  Json json = {{"origin", json_of(frame.origin)}, {"sides", Json::array()}, {"axes", Json::array()}};
  for (Eigen::Index k = 0; k < 3; ++k)
    json["axes"].push_back(json_of(Vector3d(frame.axes.row(k).transpose())));
  std::string blobs;
  std::vector<Vector3d> origins;
  const std::size_t most_corners = kCornersOfAll / std::max<std::size_t>(1, result.scans.size());
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const ProjectScan& scan = result.scans[k];
    const SceneSide side = side_of(std::move(pictures[k]));
    origins.push_back(side.origin);
    const std::string id = fmt::format("side-{}", k);
    const QuantisedPoints points = quantised_side(side);
    Json stated = side_json(shown_name(scan), side, points, most_corners);
    stated["about"] = in_language(words_of(scan, side.points.size()), language);
    stated["state"] = scan.readable ? to_string(scan.state) : "unreadable";
    stated["component"] = scan.component;
    stated["mobile"] = scan.mobile;
    if (scan.frame_from_scan) {
      stated["place"] = json_of(to_matrix(frame.page_from_local(*scan.frame_from_scan, side.origin)));
      if (!scan.model)
        stated["station"] =
            json_of(frame.page_from_frame(scan.stations.empty() ? scan.sigma.centre : scan.stations.front()));
    }
    json[id] = std::move(stated);
    json["sides"].push_back(id);
    blobs += side_blobs(id, side, points, {});
  }
  json["links"] = links_of(result, origins, language);
  json["floors"] = floors_of(result, frame);
  return json_element(std::move(json)) + blobs;
}

}  // namespace limen
