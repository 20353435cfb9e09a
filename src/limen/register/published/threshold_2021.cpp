// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "limen/match/planes/polygon_distance.h"
#include "limen/match/planes/threshold_matching.h"
#include "limen/match/solvers/rotation_from_directions.h"
#include "limen/match/solvers/translation_from_planes.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2021, section 3.2.1: polygons that agree within three thresholds at the start.
//
// Departures from the printed text:
// - the text gives no thresholds: those of match/planes/threshold_matching.cpp, one partner for each polygon;
// - nor does it say how matches become a pose: here least squares over all of them, which is 3.3 (a rotation
//   from pairs of directions) and 3.4 (a shift from pairs of planes) for any number of pairs;
// - those of match/planes/polygon_distance.h and of the two solvers.

namespace limen {
namespace {

/// The matched normals, the target's turned to the side on which the start has the source's.
std::vector<DirectionPair> normal_pairs(const std::vector<ThresholdMatch>& matches,
                                        const std::vector<PlanarPolygon>& source,
                                        const std::vector<PlanarPolygon>& target, const Matrix3d& start) {
  std::vector<DirectionPair> pairs;
  for (const ThresholdMatch& match : matches) {
    const Vector3d& from = source[static_cast<std::size_t>(match.source)].plane.normal;
    const Vector3d& to = target[static_cast<std::size_t>(match.target)].plane.normal;
    pairs.push_back({from, (start * from).dot(to) < 0.0 ? Vector3d(-to) : to, match.overlap_m2});
  }
  return pairs;
}

std::vector<PlanePair> plane_pairs(const std::vector<ThresholdMatch>& matches,
                                   const std::vector<PlanarPolygon>& source,
                                   const std::vector<PlanarPolygon>& target) {
  std::vector<PlanePair> pairs;
  for (const ThresholdMatch& match : matches) {
    pairs.push_back({source[static_cast<std::size_t>(match.source)].centroid,
                     target[static_cast<std::size_t>(match.target)].plane, match.overlap_m2});
  }
  return pairs;
}

}  // namespace

PublishedAnswer register_threshold_2021(const PublishedInput& input) {
  // 3.1: the polygons that both scans may have seen.
  const std::vector<PlanarPolygon> source = common_polygons(input.source, input.source_outside);
  const std::vector<PlanarPolygon> target = common_polygons(input.target, input.target_outside);
  // 3.2.1: angle, distance (7) and overlap (8) within their thresholds.
  const std::vector<ThresholdMatch> matches = match_by_thresholds(source, target, input.start);
  if (matches.size() < 3) {
    return {std::nullopt, fmt::format("{} pairs of polygons agree within the thresholds at the start, three "
                                      "are needed",
                                      matches.size())};
  }
  // 3.3: the rotation that the matched normals want.
  const RotationFit turn =
      rotation_from_directions(normal_pairs(matches, source, target, input.start.rotation));
  // 3.4: the shift that the matched planes want, (20) to (22).
  const TranslationFit shift =
      translation_from_planes(turn.rotation, plane_pairs(matches, source, target), input.start.translation);
  PublishedPose pose;
  pose.target_from_source = {turn.rotation, shift.translation};
  pose.hypotheses = 1;
  pose.not_held = shift.unobserved;
  pose.free_turn = turn.free_axis;
  std::vector<PlanarPolygon> moved;
  for (const PlanarPolygon& polygon : source) moved.push_back(transformed(pose.target_from_source, polygon));
  pose.criterion = scan_agreement(moved, target);  // (10)
  return {pose, {}};
}

}  // namespace limen
