// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/shared_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"
#include "limen/register/judge/as_built.h"

namespace limen {
namespace {

constexpr double kDrawnM = 0.01;  // by how much a building misses its model

// Tiles of one plane: how flat built walls are, and how many of them err independently.
constexpr double kFlatM = 0.002;
constexpr double kBendPerM = 0.0003;  // a long wall bends
constexpr double kTilesThatCount = 16.0;
const double kSharedCosine = std::cos(radians(2.0));
constexpr double kSharedM = 0.04;
constexpr double kStrays = 3.0;

// Of what a bent pass sees.
constexpr double kPatchM =
    3.0;  // of a surface that counts as a plane: houses of a row stand out by a centimetre
constexpr double kStripTiles = 8.0;
constexpr double kStripM = 0.001;    // a strip of a wall protrudes by so much
constexpr double kHeldPlaces = 6.0;  // along a way, where a link holds it

/// Of each node the number of its first plane among those of all; behind them how many there are.
std::vector<std::size_t> first_planes(const std::vector<ProjectNode>& nodes) {
  std::vector<std::size_t> first = {0};
  for (const ProjectNode& node : nodes) first.push_back(first.back() + node.digest.planes.size());
  return first;
}

Viewpoints viewpoints_of(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved) {
  std::vector<std::optional<Vector3d>> scanners;
  std::vector<int> component;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::optional<Vector3d> own = nodes[n].digest.scanner();
    scanners.push_back(own ? std::optional<Vector3d>(solved.nodes[n].frame_from_node * *own) : std::nullopt);
    component.push_back(solved.nodes[n].component);
  }
  return {scanners, component};
}

/// Whether a scan saw its plane there: within what an even spread with its moments covers, and a metre.
bool lies_on(const Vector3d& x, const PlaneDigest& plane) {
  constexpr double kEven = 3.0;  // squared half width of an even spread, in variances
  constexpr double kBeyondM = 1.0;
  Matrix3d spread = kEven * plane.moments.covariance();
  spread.diagonal().array() += kBeyondM * kBeyondM;
  const Vector3d off = x - plane.centroid - plane.moments.mean();
  return off.dot(solve_symmetric(spread, off)) <= 2.0;
}

/// Whether two planes go on in one another by the pair's own pose, which knows them where both scans see
/// them: of a façade with bays and reliefs two scans may each see another part, centimetres before or behind.
bool go_on(const PlaneDigest& a, const PlaneDigest& b, const Rigid3& b_from_a, double strays_m) {
  const Plane a_in_b = transformed(b_from_a, a.plane);
  const Vector3d middle = b_from_a * a.centroid;
  const double apart = (middle - b.centroid).norm();
  const double bound = kStrays * std::hypot(std::sqrt(2.0) * kFlatM, kBendPerM * apart, strays_m);
  return std::abs(a_in_b.signed_distance(b.centroid)) <= bound &&
         std::abs(b.plane.signed_distance(middle)) <= bound;
}

}  // namespace

SharedPlanes::SharedPlanes(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved,
                           const BentPasses& passes)
    : nodes_(nodes),
      solved_(solved),
      passes_(passes),
      first_(first_planes(nodes)),
      viewpoints_(viewpoints_of(nodes, solved)),
      surfaces_(first_.back()),
      common_(first_.back(), {0.0, 0}) {
  strips_.resize(passes.any() ? nodes.size() : 0);
  for (std::size_t n = 0; n < strips_.size(); ++n) {
    strips_[n].resize(digest(n).planes.size());
    for (std::size_t k = 0; k < digest(n).track.strips.size(); ++k)
      strips_[n][static_cast<std::size_t>(digest(n).track.strips[k].plane)].push_back(k);
  }
}

template <typename Visit>
void SharedPlanes::for_each(const Visit& visit) {
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    for (std::size_t plane = 0; plane < digest(node).planes.size(); ++plane)
      visit(node, plane, surfaces_.find(first_[node] + plane));
  }
}

void SharedPlanes::join(const PoseEdge& edge, const PlaneMatch& match) {
  const auto source_node = static_cast<std::size_t>(edge.source);
  const auto target_node = static_cast<std::size_t>(edge.target);
  const PlaneDigest& a = digest(source_node).planes[static_cast<std::size_t>(match.source)];
  const PlaneDigest& b = digest(target_node).planes[static_cast<std::size_t>(match.target)];
  const Rigid3& frame_from_a = solved_.nodes[source_node].frame_from_node;
  const Rigid3& frame_from_b = solved_.nodes[target_node].frame_from_node;
  const Plane in_frame = transformed(frame_from_a, a.plane);
  const double cosine = in_frame.normal.dot(frame_from_b.rotation * b.plane.normal);
  if (std::abs(cosine) < kSharedCosine) return;
  // Pieces of a pass stray from where the pass as a whole has them.
  const double strays = std::hypot(nodes_[source_node].strays_m(), nodes_[target_node].strays_m());
  if (std::abs(in_frame.signed_distance(frame_from_b * b.centroid)) > kSharedM + kStrays * strays) return;
  const bool drawn = digest(source_node).model || digest(target_node).model;
  if (!go_on(a, b, edge.pose.target_from_source, std::hypot(strays, drawn ? kDrawnM : 0.0))) return;
  const std::size_t of_source = first_[source_node] + static_cast<std::size_t>(match.source);
  const std::size_t of_target = first_[target_node] + static_cast<std::size_t>(match.target);
  surfaces_.join(of_source, of_target);
  if (viewpoints_.is_same(edge.source, edge.target)) return;
  const double share = std::min(1.0, match.overlap_m2 / std::max(a.area_m2, b.area_m2));
  for (const std::size_t plane : {of_source, of_target}) {
    common_[plane].first += share;
    ++common_[plane].second;
  }
}

PlaneObservation SharedPlanes::whole_plane(std::size_t node, std::size_t plane, std::size_t views) const {
  const PlaneDigest& seen = digest(node).planes[plane];
  PlaneObservation observation;
  observation.node = static_cast<int>(node);
  observation.moments = seen.moments;
  observation.anchor = seen.centroid;
  const double length = std::sqrt(12.0 * seen.moments.covariance().trace());
  const double own = std::hypot(kFlatM, kBendPerM * length);
  // What a trajectory drifts by is one for the whole plane, and so is what was built some millimetres off.
  const auto& [common, count] = common_[first_[node] + plane];
  const double alone = (count > 0 ? 1.0 - common / count : 1.0) * static_cast<double>(views);
  const double whole =
      digest(node).model ? kDrawnM : std::hypot(nodes_[node].strays_m(), built_offset_m() * std::sqrt(alone));
  observation.sigma_m = std::hypot(own, whole * std::sqrt(kTilesThatCount));
  observation.most_points = kTilesThatCount;
  return observation;
}

void SharedPlanes::tell(const std::vector<bool>& taken, JointProblem& problem) {
  std::map<std::size_t, std::vector<std::pair<std::size_t, std::size_t>>> members;
  for_each([&](std::size_t node, std::size_t plane, std::size_t root) {
    if (taken[node] && digest(node).planes[plane].moments.count >= 3.0)
      members[root].emplace_back(node, plane);
  });
  for (const auto& [root, seen] : members) {
    std::set<std::size_t> seers;
    bool is_bent = false;
    for (const auto& [node, plane] : seen) {
      seers.insert(node);
      is_bent = is_bent || passes_.bends(static_cast<int>(node));
    }
    if (is_bent) {
      tell_patches(root, seen, problem);
      continue;
    }
    if (seers.size() < 2) continue;
    for (const auto& [node, plane] : seen) {
      const auto views = std::count_if(seers.begin(), seers.end(), [&, n = node](std::size_t other) {
        return viewpoints_.is_same(static_cast<int>(other), static_cast<int>(n));
      });
      PlaneObservation observation = whole_plane(node, plane, static_cast<std::size_t>(views));
      observation.plane = problem.planes;
      problem.observations.push_back(observation);
    }
    ++problem.planes;
  }
}

/// What is common to a strip no number of tiles makes less.
SharedPlanes::Seen SharedPlanes::seen_strip(std::size_t node, std::size_t strip) const {
  const ScanDigest& of = digest(node);
  const PassStrip& saw = of.track.strips[strip];
  const int number = static_cast<int>(node);
  const bool bends = passes_.bends(number);
  double common = of.model ? kDrawnM : kStripM;
  if (of.mobile) common = std::hypot(kStripM, bends ? passes_.unfollowed_m(number) : nodes_[node].strays_m());
  Seen seen;
  seen.observation.node = number;
  seen.observation.moments = saw.moments;
  seen.observation.anchor = saw.anchor;
  seen.observation.most_points = kStripTiles;
  seen.observation.sigma_m = std::hypot(kFlatM, common * std::sqrt(std::min(kStripTiles, saw.moments.count)));
  seen.from = {node, bends ? static_cast<int>(saw.place) : 0};
  seen.place = saw.place;
  return seen;
}

void SharedPlanes::tell_patches(std::size_t root,
                                const std::vector<std::pair<std::size_t, std::size_t>>& members,
                                JointProblem& problem) {
  const auto& [first_node, first_plane] = members.front();
  const PlaneDigest& first = digest(first_node).planes[first_plane];
  const Rigid3& frame_from_first = solved_.nodes[first_node].frame_from_node;
  const PlaneFrame squares =
      make_frame(transformed(frame_from_first, first.plane), frame_from_first * first.centroid);
  std::map<PatchKey, std::vector<Seen>> patches;
  for (const auto& [node, plane] : members) {
    const Rigid3& whole = solved_.nodes[node].frame_from_node;
    const int number = static_cast<int>(node);
    for (const std::size_t k : strips_[node][plane]) {
      const Seen seen = seen_strip(node, k);
      const Rigid3 pose = passes_.bends(number) ? passes_.pose_at(number, whole, seen.place) : whole;
      const Vector3d middle = pose * (seen.observation.anchor + seen.observation.moments.mean());
      const Vector2d at = squares.to_plane(middle) / kPatchM;
      patches[{root, static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y()))}].push_back(
          seen);
    }
  }
  keep(patches, problem);
}

/// The patches that are seen twice.
void SharedPlanes::keep(const std::map<PatchKey, std::vector<Seen>>& patches, JointProblem& problem) const {
  for (const auto& [key, seen] : patches) {
    std::set<std::pair<std::size_t, int>> from;
    for (const Seen& one : seen) from.insert(one.from);
    if (from.size() < 2) continue;
    for (const Seen& one : seen) {
      PlaneObservation observation = one.observation;
      observation.plane = problem.planes;
      if (passes_.bends(observation.node))
        observation.node = passes_.node_at(problem, observation.node, {one.place});
      problem.observations.push_back(observation);
    }
    ++problem.planes;
  }
}

std::vector<double> SharedPlanes::places_of(int node, const std::vector<SeenByBoth>& seen,
                                            const Rigid3& other_from_node) const {
  const auto n = static_cast<std::size_t>(node);
  std::vector<std::pair<double, double>> strips;  // place along the way, and how much was seen there
  double all = 0.0;
  for (const bool common : {true, false}) {
    for (const SeenByBoth& surface : seen) {
      for (const std::size_t k : strips_[n][static_cast<std::size_t>(surface.plane)]) {
        const PassStrip& strip = digest(n).track.strips[k];
        if (common && !lies_on(other_from_node * (strip.anchor + strip.moments.mean()), *surface.other))
          continue;
        strips.emplace_back(strip.place, strip.moments.count);
        all += strip.moments.count;
      }
    }
    if (!strips.empty()) break;
  }
  if (strips.empty()) return {0.5 * (digest(n).track.way.knots() - 1)};
  std::sort(strips.begin(), strips.end());
  std::vector<double> places;
  double sum = 0.0;
  for (const auto& [place, weight] : strips) {
    sum += weight;
    while (static_cast<double>(places.size()) + 0.5 < kHeldPlaces * sum / all) places.push_back(place);
  }
  return places;
}

}  // namespace limen
