// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/segment_distance.h"
#include "limen/match/solvers/rigid_from_lines.h"
#include "limen/register/published/published_pose.h"

// Djahel, Monasse, Vallet 2022, sections 3.2 and 3.3: a wall of each scan is drawn, a vertical and a
// horizontal edge of each; the pose that lays them on each other and has the smallest distance (14) is kept.
//
// Departures from the printed text:
// - the openings are those that limen finds (extract/openings), whose rectangles stand upright;
// - a direction's sign is not given: verticals point up, and horizontals so that the scanners stand on the
// two
//   sides of the wall, as indoor and outdoor scans do;
// - the number of trials is not given: `trials`;
// - those of match/segments/segment_distance.h (3 to 14; the four end points are those of the whole segments,
//   as printed) and of match/solvers/rigid_from_lines.h (15 to 19).
// As printed, the two faces of a wall are laid on each other: the shift across it is not held, and said so.

namespace limen {
namespace {

struct DrawnOpening {
  Rigid3 target_from_source;
  Vector3d wall_normal = Vector3d::UnitX();  // of the target's wall
};

Line line_of(const Segment& segment, double sign) {
  return {segment.a, sign * segment.direction()};
}

/// 3.2: the wall pair, then one vertical and one horizontal edge of each; 3.3: the pose.
DrawnOpening draw(const std::vector<WallEdges>& source, const std::vector<WallEdges>& target,
                  RandomStream& random) {
  const WallEdges& from = drawn(source, random);
  const WallEdges& to = drawn(target, random);
  LinePair vertical;
  vertical.source = line_of(drawn(from.vertical, random), 1.0);
  vertical.target = line_of(drawn(to.vertical, random), 1.0);
  LinePair horizontal;
  horizontal.source = line_of(drawn(from.horizontal, random), 1.0);
  // Seen from its other side the wall's right is left.
  horizontal.target = line_of(drawn(to.horizontal, random), -1.0);
  return {rigid_from_lines(vertical, horizontal), to.normal};  // (15) to (19)
}

}  // namespace

PublishedAnswer register_openings_2022(const PublishedInput& input) {
  constexpr std::size_t kTrials = 40000;
  // 2: the openings of both scans, four segments each.
  const std::vector<WallEdges> source = wall_edges(input.source, input.upright);
  const std::vector<WallEdges> target = wall_edges(input.target, input.upright);
  if (source.empty() || target.empty())
    return {std::nullopt, "a scan without openings has nothing that the method could match"};
  // 3.1: the distance between the two sets of segments, (3) to (14).
  const std::vector<Segment> edges = all_edges(source);
  const SegmentSetMeasure measure(all_edges(target), {.whole_segments = true});
  const auto cost = [&](const DrawnOpening& pose) {
    return measure.to(edges, pose.target_from_source).distance;
  };
  // 3.2: random trials.
  const auto drawing = [&](RandomStream& random) {
    return std::optional<DrawnOpening>(draw(source, target, random));
  };
  const std::optional<BestTrial> best = best_trial(kTrials, input.seed, drawing, cost);
  if (!best) return {std::nullopt, "no trial gave a pose"};
  RandomStream again(input.seed, best->trial);
  const DrawnOpening chosen = draw(source, target, again);
  PublishedPose pose;
  pose.target_from_source = chosen.target_from_source;
  pose.criterion = best->cost;
  pose.hypotheses = best->judged;
  pose.not_held = {chosen.wall_normal};
  return {pose, {}};
}

}  // namespace limen
