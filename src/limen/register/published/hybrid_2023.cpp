// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <Eigen/LU>

#include "limen/base/angles.h"
#include "limen/match/planes/direction_clusters.h"
#include "limen/match/segments/segment_distance.h"
#include "limen/register/published/published_pose.h"

// Monasse, Djahel, Vallet 2023, section III-B: a façade of each scan is drawn, a corner of an opening of
// each, and two planes across the façade; the pose of smallest distance (8) is kept.
//
// Departures from the printed text:
// - the façades are parallel as soon as the pose is right, and parallel planes have no line of intersection
//   to turn about: the rotation is that of their frames (outward normal, up). The indoor normal opposes the
//   outdoor one. This needs the vertical of both scans;
// - as printed, the vector from A to B lays the indoor face of the wall on its outdoor face. Where the user
//   gives a thickness, the chosen pose is moved back by it; else the shift across the wall is not held, and
//   said so;
// - the planes across the façade are those of Algorithm 1's clusters that lie within 10 degrees of it;
// - the number of trials is not given: `trials`;
// - those of match/segments/segment_distance.h (1 to 8) and match/planes/direction_clusters.h.

namespace limen {
namespace {

/// What is drawn from.
struct Choice {
  std::vector<WallEdges> source;
  std::vector<WallEdges> target;
  std::vector<PlanarPolygon> planes;  // of the source
  DirectionClusters clusters;
};

struct DrawnHybrid {
  Rigid3 target_from_source;
  Vector3d wall_normal = Vector3d::UnitX();  // of the target's wall, towards its scanner
};

/// Axes of a wall: the normal that points out of the building, up, and their product.
Matrix3d wall_axes(const WallEdges& wall, double outwards) {
  Matrix3d axes;
  axes.col(0) = outwards * wall.normal;
  axes.col(1) = wall.normal.cross(wall.right);
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// The clusters whose planes stand across a wall.
std::vector<const DirectionCluster*> across(const DirectionClusters& clusters, const Vector3d& normal) {
  std::vector<const DirectionCluster*> list;
  for (const DirectionCluster& cluster : clusters.clusters) {
    if (std::abs(cluster.direction.dot(normal)) < std::sin(radians(10.0))) list.push_back(&cluster);
  }
  return list;
}

std::optional<Vector3d> meeting_point(const Plane& a, const Plane& b, const Plane& c) {
  constexpr double kLeastVolume = 0.1;  // of the three normals
  Matrix3d normals;
  normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  if (std::abs(normals.determinant()) < kLeastVolume) return std::nullopt;
  return Vector3d(normals.inverse() * Vector3d(a.offset, b.offset, c.offset));
}

Plane plane_of(const PlanarPolygon& polygon, const Rigid3& target_from_source) {
  return transformed(target_from_source, polygon.plane);
}

/// One iteration of III-B.
std::optional<DrawnHybrid> draw(const Choice& choice, RandomStream& random) {
  // A façade plane of each scan, p1 and p2.
  const WallEdges& from = drawn(choice.source, random);
  const WallEdges& to = drawn(choice.target, random);
  // The two planes coincide: p1 becomes p1'.
  DrawnHybrid result;
  Rigid3& pose = result.target_from_source;
  result.wall_normal = to.normal;
  pose.rotation = wall_axes(to, 1.0) * wall_axes(from, -1.0).transpose();
  // A corner of an opening in each, and the shift between them within the plane.
  const Vector3d turned = pose.rotation * drawn(from.corners, random);
  const Vector3d shift = drawn(to.corners, random) - turned;
  pose.translation = shift - shift.dot(to.normal) * to.normal;
  // Two planes p3 and p4 of clusters across the façade, transformed.
  const std::vector<const DirectionCluster*> clusters = across(choice.clusters, from.normal);
  if (clusters.size() < 2) return std::nullopt;
  const std::size_t first = random.below(static_cast<std::uint32_t>(clusters.size()));
  const std::size_t second =
      (first + 1 + random.below(static_cast<std::uint32_t>(clusters.size() - 1))) % clusters.size();
  const auto plane = [&](const DirectionCluster& cluster) {
    return plane_of(choice.planes[static_cast<std::size_t>(drawn(cluster.planes, random))], pose);
  };
  const Plane p3 = plane(*clusters[first]);
  const Plane p4 = plane(*clusters[second]);
  // A and B: where p1' and p2 meet them. The vector from A to B is the freedom that was missing.
  const Plane p1 = transformed(pose, Plane{from.normal, from.normal.dot(from.corners.front())});
  const Plane p2{to.normal, to.normal.dot(to.corners.front())};
  const std::optional<Vector3d> a = meeting_point(p1, p3, p4);
  const std::optional<Vector3d> b = meeting_point(p2, p3, p4);
  if (!a || !b) return std::nullopt;
  pose.translation += *b - *a;
  return result;
}

}  // namespace

PublishedAnswer register_hybrid_2023(const PublishedInput& input) {
  constexpr std::size_t kTrials = 40000;
  if (!input.upright) return {std::nullopt, "the method needs the vertical of both scans"};
  // III-A: façades with openings, and planes.
  Choice choice;
  choice.source = wall_edges(input.source, true);
  choice.target = wall_edges(input.target, true);
  if (choice.source.empty() || choice.target.empty())
    return {std::nullopt, "a scan without openings has nothing that the method could match"};
  // III-B.1: direction clusters of the indoor planes.
  choice.planes = common_polygons(input.source, input.source_outside);
  choice.clusters = cluster_directions(choice.planes, Vector3d::UnitZ());
  // II: the distance between the two sets of segments, (1) to (8).
  const std::vector<Segment> source_edges = all_edges(choice.source);
  const std::vector<Segment> target_edges = all_edges(choice.target);
  const SegmentSetMeasure measure(target_edges, {.weight = SegmentWeight::relative});
  const auto cost = [&](const DrawnHybrid& pose) {
    return measure.to(source_edges, pose.target_from_source).distance;
  };
  // III-B.2: random trials.
  const auto drawing = [&](RandomStream& random) { return draw(choice, random); };
  const std::optional<BestTrial> best = best_trial(kTrials, input.seed, drawing, cost);
  if (!best) return {std::nullopt, "no two planes of the source stand across a wall with openings"};
  RandomStream again(input.seed, best->trial);
  const DrawnHybrid chosen = *draw(choice, again);
  PublishedPose pose;
  pose.target_from_source = chosen.target_from_source;
  pose.criterion = best->cost;
  pose.hypotheses = best->judged;
  if (input.wall_thickness_m > 0.0) {
    pose.target_from_source.translation -= input.wall_thickness_m * chosen.wall_normal;
  } else {
    pose.not_held = {chosen.wall_normal};
  }
  return {pose, {}};
}

}  // namespace limen
