// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/segment_distance.h"
#include "limen/match/solvers/rigid_from_lines.h"
#include "limen/register/published/published_pose.h"

// Monasse, Djahel, Vallet 2023, section IV: segments clustered by direction; two associated clusters are
// drawn, one segment of each in both sets; the pose that lays the double pair on each other and has the
// smallest distance (8) is kept.
//
// Departures from the printed text:
// - (9) compares 1 - cos with an angle, and gives no sign: a cluster goes with the one of the other set that
//   the start brings nearest, each with one (largest |d . d| first), turned to its side;
// - a double pair is tried only where both sets hold the same |d_v . d_h| within `kMaxAngleRad` and the two
//   lines pass each other at the same distance within d of (7);
// - (8) is taken both ways, and over the `kMaxSegments` longest segments of each set;
// - the number of trials is not given: `kTrials`;
// - those of match/planes/direction_clusters.h (algorithm 1), match/segments/segment_distance.h (1 to 8) and
//   match/solvers/rigid_from_lines.h (10 to 14).

namespace limen {
namespace {

using Segments = std::vector<Segment>;

/// A_k: a cluster of each set, all segments turned to the side of the target's cluster.
struct Association {
  Segments source;
  Segments target;
};

Segments longest(Segments segments, std::size_t most) {
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Segment& a, const Segment& b) { return a.length() > b.length(); });
  if (segments.size() > most) segments.resize(most);
  return segments;
}

/// The segments of a cluster, all on the side of `direction`.
Segments sided(const Segments& all, const DirectionCluster& cluster, const Vector3d& direction) {
  Segments list;
  for (const int k : cluster.planes) {
    const Segment& segment = all[static_cast<std::size_t>(k)];
    list.push_back(segment.direction().dot(direction) < 0.0 ? Segment{segment.b, segment.a} : segment);
  }
  return list;
}

/// (9), one to one.
std::vector<Association> associations(const Segments& source, const DirectionClusters& from,
                                      const Segments& target, const DirectionClusters& to,
                                      const Matrix3d& start) {
  struct Pair {
    const DirectionCluster* source;
    const DirectionCluster* target;
    double cosine;
  };
  std::vector<Pair> pairs;
  for (const DirectionCluster& a : from.clusters)
    for (const DirectionCluster& b : to.clusters)
      pairs.push_back({&a, &b, (start * a.direction).dot(b.direction)});
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return std::abs(a.cosine) > std::abs(b.cosine); });
  std::vector<Association> list;
  std::vector<const DirectionCluster*> taken;
  const auto is_taken = [&](const DirectionCluster* c) {
    return std::find(taken.begin(), taken.end(), c) != taken.end();
  };
  for (const Pair& pair : pairs) {
    if (is_taken(pair.source) || is_taken(pair.target)) continue;
    taken.insert(taken.end(), {pair.source, pair.target});
    const Vector3d side = pair.cosine < 0.0 ? Vector3d(-pair.source->direction) : pair.source->direction;
    list.push_back({sided(source, *pair.source, side), sided(target, *pair.target, pair.target->direction)});
  }
  return list;
}

/// How far two lines pass each other by.
double line_distance(const Segment& a, const Segment& b) {
  const Vector3d across = a.direction().cross(b.direction());
  return std::abs((b.a - a.a).dot(across.normalized()));
}

Line line_of(const Segment& segment) {
  return {segment.a, segment.direction()};
}

/// One iteration of IV-C: two associations, a segment of each in both sets, the pose of IV-D.
std::optional<Rigid3> draw(const std::vector<Association>& of, RandomStream& random) {
  constexpr double kMaxAngleRad = radians(5.0);  // by which the angle within a double pair may differ
  const auto count = static_cast<std::uint32_t>(of.size());
  const std::uint32_t first = random.below(count);
  const std::uint32_t second = (first + 1 + random.below(count - 1)) % count;
  const Segment& source_v = drawn(of[first].source, random);
  const Segment& target_v = drawn(of[first].target, random);
  const Segment& source_h = drawn(of[second].source, random);
  const Segment& target_h = drawn(of[second].target, random);
  const auto angle = [](const Segment& v, const Segment& h) {
    return std::acos(std::clamp(std::abs(v.direction().dot(h.direction())), 0.0, 1.0));
  };
  const double turn = angle(source_v, source_h);
  const double target_turn = angle(target_v, target_h);
  if (std::min(turn, target_turn) < kMaxAngleRad) return std::nullopt;  // no pair fixes a pose
  if (std::abs(turn - target_turn) > kMaxAngleRad) return std::nullopt;
  if (std::abs(line_distance(source_v, source_h) - line_distance(target_v, target_h)) >
      SegmentDistanceOptions{}.max_distance_m)
    return std::nullopt;
  LinePair vertical;
  vertical.source = line_of(source_v);
  vertical.target = line_of(target_v);
  LinePair horizontal;
  horizontal.source = line_of(source_h);
  horizontal.target = line_of(target_h);
  return rigid_from_lines(vertical, horizontal);  // (10) to (14)
}

}  // namespace

PublishedAnswer register_segments_2023(const PublishedInput& input) {
  constexpr std::size_t kMaxSegments = 300;  // of each set, the longest
  constexpr std::size_t kTrials = 200000;    // double pairs drawn
  // IV-A: the segments of both sets.
  const Segments source = longest(input.source.segments, kMaxSegments);
  const Segments target = longest(input.target.segments, kMaxSegments);
  // IV-B: direction clusters (algorithm 1) and their association (9).
  const DirectionClusters from = cluster_directions(source, std::nullopt);
  const DirectionClusters to = cluster_directions(target, std::nullopt);
  const std::vector<Association> of = associations(source, from, target, to, input.start.rotation);
  if (of.size() < 2) return {std::nullopt, "the segments have fewer than two directions in common"};
  // II: the distance between the two sets, (1) to (8).
  const SegmentSetMeasure measure(target, {.weight = SegmentWeight::relative});
  const auto cost = [&](const Rigid3& pose) { return measure.to(source, pose).distance; };
  // IV-C: random double pairs.
  const auto drawing = [&](RandomStream& random) { return draw(of, random); };
  const std::optional<BestTrial> best = best_trial(kTrials, input.seed, drawing, cost);
  if (!best) return {std::nullopt, "no two pairs of segments have the same relative position in both sets"};
  RandomStream again(input.seed, best->trial);
  PublishedPose pose;
  pose.target_from_source = *draw(of, again);
  pose.criterion = best->cost;
  pose.hypotheses = best->judged;
  return {pose, {}};
}

}  // namespace limen
