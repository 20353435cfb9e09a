// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/join_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <Eigen/LU>

#include "limen/base/parallel.h"
#include "limen/project/retrieve/plan_view.h"
#include "limen/project/retrieve/seen_space.h"

namespace limen {
namespace {

constexpr double kLeastPlaneM2 = 0.5;    // smaller ones are furniture
constexpr std::size_t kMostOfScan = 60;  // of a scanner position, the largest
constexpr double kMostReachM = 100.0;    // time and memory grow with the reach
constexpr double kEvenSpread = 1.73;     // standard deviations from the middle of an even spread to its end
constexpr std::size_t kMostOfTurn = 30;
constexpr std::size_t kMostScored = 64;
constexpr std::size_t kMostScoredOfScans = 24;  // of two parts of one scan each: there are many of these
constexpr std::size_t kMostHeights = 3;
constexpr std::size_t kPosesOfParts = 3;  // of two parts
constexpr std::size_t kPairsOfPose = 2;
constexpr int kMostOfPart = 3;              // pairs of the smaller of two parts
constexpr double kCountsAgainst = 3.0;      // surface that was looked through, to surface in common
constexpr std::size_t kMatchesOfScan = 15;  // in one go, on average: parts with most scans first
constexpr double kSamePoseM = 0.5;
constexpr double kSamePoseRad = 0.1;

/// What one scan of a part shows.
struct Shown {
  std::vector<SurfacePoint> points;
  Eigen::AlignedBox3d box;
};

struct Part {
  explicit Part(std::vector<PlacedPlane> all) : planes(std::move(all)), plan(planes), image(plan) {
    for (const PlacedPlane& plane : planes) space.add(plane);
  }

  std::vector<std::size_t> scans;
  std::vector<Rigid3> from_scan;  ///< upright axes
  std::vector<Shown> shown;       ///< by each scan
  Eigen::AlignedBox3d box;        ///< of all of it
  std::vector<PlacedPlane> planes;
  PlanView plan;
  PlanImage image;
  SeenSpace space;
};

PlacedPlane placed_plane(const ScanDigest& scan, const PlaneDigest& plane, const Rigid3& from_scan) {
  PlacedPlane placed;
  placed.middle = from_scan * plane.centroid;
  placed.normal = from_scan.rotation * plane.plane.normal;
  const Matrix3d spread = from_scan.rotation * spread_of(plane) * from_scan.rotation.transpose();
  const Vector3d level = Vector3d::UnitZ().cross(placed.normal);
  constexpr double kTilted = 0.3;
  if (level.norm() > kTilted) {
    const Vector3d along = level.normalized();
    const Vector3d across = placed.normal.cross(along);
    placed.along = kEvenSpread * std::sqrt(along.dot(spread * along)) * along;
    placed.across = kEvenSpread * std::sqrt(across.dot(spread * across)) * across;
  } else {
    const Spectrum3 axes = spectrum_of(spread);
    placed.along = kEvenSpread * std::sqrt(axes.values[2]) * axes.vectors.col(2);
    placed.across = kEvenSpread * std::sqrt(axes.values[1]) * axes.vectors.col(1);
  }
  placed.area_m2 = plane.area_m2;
  placed.oriented = plane.oriented;
  const auto nearest =
      std::min_element(scan.stations.begin(), scan.stations.end(), [&](const Vector3d& a, const Vector3d& b) {
        return (a - plane.centroid).squaredNorm() < (b - plane.centroid).squaredNorm();
      });
  if (nearest != scan.stations.end()) placed.scanner = from_scan * *nearest;
  return placed;
}

/// No larger or farther from its scanner than what belongs to one building.
bool in_reach(const PlacedPlane& plane) {
  const double away = plane.scanner ? (plane.middle - *plane.scanner).norm() : 0.0;
  return std::max({away, plane.along.norm(), plane.across.norm()}) <= kMostReachM;
}

Part part_of(const std::vector<ScanDigest>& digests, const PlacedPart& placed) {
  // Upright by its first scan; all scans of a part agree in that.
  const Matrix3d upright =
      digests[placed.scans.front()].upright_from_scan * placed.part_from_scan.front().rotation.transpose();
  std::vector<Rigid3> from_scan;
  std::vector<Shown> shown(placed.scans.size());
  std::vector<PlacedPlane> planes;
  for (std::size_t k = 0; k < placed.scans.size(); ++k) {
    const ScanDigest& scan = digests[placed.scans[k]];
    from_scan.push_back(Rigid3{upright, Vector3d::Zero()} * placed.part_from_scan[k]);
    const std::size_t most = scan.mobile || scan.model ? scan.planes.size() : kMostOfScan;
    for (std::size_t p = 0; p < std::min(most, scan.planes.size()); ++p) {
      if (scan.planes[p].area_m2 < kLeastPlaneM2) continue;
      const PlacedPlane plane = placed_plane(scan, scan.planes[p], from_scan.back());
      if (!in_reach(plane)) continue;
      planes.push_back(plane);
      add_surface_points(planes.back(), shown[k].points);
    }
    for (const SurfacePoint& point : shown[k].points) shown[k].box.extend(point.x);
  }
  Part part(std::move(planes));
  part.scans = placed.scans;
  part.from_scan = std::move(from_scan);
  part.shown = std::move(shown);
  for (const PlacedPlane& plane : part.planes) {
    if (plane.scanner) part.box.extend(*plane.scanner);  // what lies before a plane was looked through
  }
  for (const Shown& one : part.shown) part.box.extend(one.box);
  return part;
}

struct PartPose {
  Rigid3 a_from_b;
  double score_m2 = 0.0;
};

/// Surface of points in a space: how much along each direction, and how much that was looked through.
struct Agreement {
  Matrix3d common_m2 = Matrix3d::Zero();
  double looked_through_m2 = 0.0;

  /// What holds a pose: along the level direction with the least surface, most; a floor holds but the height.
  [[nodiscard]] double held_m2() const {
    const double both = common_m2(0, 0) + common_m2(1, 1);
    const double least = 0.5 * both - std::hypot(0.5 * (common_m2(0, 0) - common_m2(1, 1)), common_m2(0, 1));
    constexpr double kMostOfHeightM2 = 10.0;
    return least + 0.25 * both + 0.25 * std::min(common_m2(2, 2), kMostOfHeightM2);
  }
};

/// Calls `take` with each point that the scans of `part` show, moved, where `other` may reach to.
template <class Take>
void for_points_near(const Part& other, const Part& part, const Rigid3& other_from_part, const Take& take) {
  Eigen::AlignedBox3d reach;  // of the other, in the part
  const Rigid3 back = inverse(other_from_part);
  for (int corner = 0; corner < 8; ++corner)
    reach.extend(back * other.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  for (const Shown& shown : part.shown) {
    if (!reach.intersects(shown.box)) continue;
    for (const SurfacePoint& point : shown.points) {
      SurfacePoint moved = point;
      moved.x = other_from_part * point.x;
      moved.normal = other_from_part.rotation * point.normal;
      take(moved);
    }
  }
}

/// Of what the scans of `part` show, with the space of `other`.
Agreement agreement(const Part& other, const Part& part, const Rigid3& other_from_part) {
  Agreement agreement;
  for_points_near(other, part, other_from_part, [&](const SurfacePoint& moved) {
    const SeenSpace::Finding finding = other.space.at(moved);
    if (finding == SeenSpace::Finding::surface)
      agreement.common_m2 += moved.area_m2 * moved.normal * moved.normal.transpose();
    if (finding == SeenSpace::Finding::looked_through) agreement.looked_through_m2 += moved.area_m2;
  });
  return agreement;
}

/// A pose that a plan gave to a pixel, shifted along the level to where the walls of b lie in those of a:
/// least squares, in which far walls lose their weight.
Rigid3 settled(const Part& a, const Part& b, Rigid3 pose) {
  constexpr int kRounds = 3;
  constexpr double kNearM = 0.05;
  constexpr double kStayM2 = 1e-3;  // a direction that no wall holds does not move
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d normal = kStayM2 * Eigen::Matrix2d::Identity();
    Vector2d right = Vector2d::Zero();
    for_points_near(a, b, pose, [&](const SurfacePoint& point) {
      if (!is_wall(point.normal)) return;
      const std::optional<double> way = a.space.way_to_surface(point);
      if (!way) return;
      const double weight = point.area_m2 / (1.0 + *way * *way / (kNearM * kNearM));
      normal += weight * point.normal.head<2>() * point.normal.head<2>().transpose();
      right += weight * *way * point.normal.head<2>();
    });
    pose.translation.head<2>() += normal.inverse() * right;
  }
  return pose;
}

/// Surface in common less what counts against it, m^2; less than `kLeastOverlapM2` where either part says so.
double score_of(const Part& a, const Part& b, const Rigid3& a_from_b) {
  const auto score = [](const Agreement& one) {
    return one.held_m2() - kCountsAgainst * one.looked_through_m2;
  };
  const Agreement of_b = agreement(a, b, a_from_b);
  if (score(of_b) < kLeastOverlapM2) return score(of_b);
  const Agreement of_a = agreement(b, a, inverse(a_from_b));
  return std::min(of_a.held_m2(), of_b.held_m2()) -
         kCountsAgainst * (of_a.looked_through_m2 + of_b.looked_through_m2);
}

/// The heights of b over a that bring most floor and ceiling together.
std::vector<double> best_heights(const Part& a, const Part& b) {
  constexpr double kHeightStepM = 0.05;
  constexpr double kLevel = 0.97;
  std::map<long, double> votes;
  for (const PlacedPlane& one : a.planes) {
    if (std::abs(one.normal.z()) < kLevel) continue;
    for (const PlacedPlane& other : b.planes) {
      if (std::abs(other.normal.z()) < kLevel) continue;
      if (one.oriented && other.oriented && one.normal.z() * other.normal.z() < 0.0) continue;
      const long bin = std::lround((one.middle.z() - other.middle.z()) / kHeightStepM);
      const double m2 = std::min(one.area_m2, other.area_m2);
      votes[bin] += m2;
      votes[bin - 1] += 0.5 * m2;
      votes[bin + 1] += 0.5 * m2;
    }
  }
  std::vector<std::pair<double, long>> peaks;
  for (const auto& [bin, m2] : votes) {
    const auto beside = [&, at = bin](long by) {
      const auto found = votes.find(at + by);
      return found == votes.end() ? 0.0 : found->second;
    };
    if (m2 >= beside(-1) && m2 > beside(1)) peaks.emplace_back(-m2, bin);
  }
  std::sort(peaks.begin(), peaks.end());
  std::vector<double> heights;
  for (std::size_t k = 0; k < std::min(kMostHeights, peaks.size()); ++k)
    heights.push_back(kHeightStepM * static_cast<double>(peaks[k].second));
  return heights;
}

/// The best poses of b to a, no two of which are the same.
std::vector<PartPose> best_poses(const Part& a, const Part& b) {
  std::vector<PlanPose> plans;
  for (const double one : a.plan.main_directions()) {
    for (const double other : b.plan.main_directions()) {
      for (int turn = 0; turn < 4; ++turn)
        a.image.add_best_shifts(b.plan, one - other + 0.5 * std::numbers::pi * turn, kMostOfTurn, plans);
    }
  }
  std::stable_sort(plans.begin(), plans.end(),
                   [](const PlanPose& p, const PlanPose& q) { return p.score > q.score; });
  const bool scans = a.scans.size() + b.scans.size() == 2;
  plans.resize(std::min(plans.size(), scans ? kMostScoredOfScans : kMostScored));
  const std::vector<double> heights = best_heights(a, b);
  std::vector<PartPose> poses;
  for (const PlanPose& plan : plans) {
    for (const double height : heights) {
      const Rigid3 pose = settled(
          a, b,
          {rotation_exp(plan.angle * Vector3d::UnitZ()), Vector3d(plan.shift.x(), plan.shift.y(), height)});
      const double score = score_of(a, b, pose);
      if (score >= kLeastOverlapM2) poses.push_back({pose, score});
    }
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PartPose& p, const PartPose& q) { return p.score_m2 > q.score_m2; });
  const Vector3d middle = b.from_scan.front().translation;
  std::vector<PartPose> distinct;
  for (const PartPose& pose : poses) {
    const bool again = std::any_of(distinct.begin(), distinct.end(), [&](const PartPose& other) {
      return (other.a_from_b * middle - pose.a_from_b * middle).norm() < kSamePoseM &&
             rotation_angle(other.a_from_b.rotation.transpose() * pose.a_from_b.rotation) < kSamePoseRad;
    });
    if (!again) distinct.push_back(pose);
    if (distinct.size() == kPosesOfParts) break;
  }
  return distinct;
}

/// Numbers of two parts, the larger one first.
using PartPair = std::pair<std::size_t, std::size_t>;

/// In the order in which they sort: minus the score, minus the overlap, the two scans, the smaller part.
using Proposal = std::tuple<double, double, std::size_t, std::size_t, std::size_t>;

/// Matches pairs of parts, all at once.
class Matching {
 public:
  Matching(const std::vector<ScanDigest>& digests, const std::function<bool(std::size_t, std::size_t)>& tried,
           const std::vector<PlacedPart>& placed, const std::vector<PartPair>& pairs)
      : digests_(digests), tried_(tried), pairs_(pairs), parts_(placed.size()) {
    std::set<std::size_t> needed;
    for (const auto& [larger, smaller] : pairs) needed.insert({larger, smaller});
    const std::vector<std::size_t> all(needed.begin(), needed.end());
    parallel_for(all.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) parts_[all[k]].emplace(part_of(digests, placed[all[k]]));
    });
  }

  [[nodiscard]] PairList best() const {
    std::vector<std::vector<Proposal>> found(pairs_.size());
    parallel_for(pairs_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) found[k] = proposals(pairs_[k].first, pairs_[k].second);
    });
    std::vector<Proposal> all;
    for (const std::vector<Proposal>& one : found) all.insert(all.end(), one.begin(), one.end());
    std::sort(all.begin(), all.end());
    std::vector<int> of_part(parts_.size(), 0);
    PairList chosen;
    for (const auto& [less, overlap, i, j, part] : all) {
      const bool again = std::find(chosen.begin(), chosen.end(), std::pair(i, j)) != chosen.end();
      if (!again && of_part[part]++ < kMostOfPart) chosen.emplace_back(i, j);
    }
    return chosen;
  }

 private:
  [[nodiscard]] std::vector<Proposal> proposals(std::size_t larger, std::size_t smaller) const {
    const Part& a = *parts_[larger];
    const Part& b = *parts_[smaller];
    std::vector<Proposal> all;
    for (const PartPose& pose : best_poses(a, b)) {
      std::vector<Proposal> of_pose;
      for (std::size_t i = 0; i < a.scans.size(); ++i) {
        for (std::size_t j = 0; j < b.scans.size(); ++j) {
          const auto [low, high] = std::minmax(a.scans[i], b.scans[j]);
          if (tried_(high, low)) continue;
          const double overlap = predicted_overlap(digests_[b.scans[j]], digests_[a.scans[i]],
                                                   inverse(a.from_scan[i]) * pose.a_from_b * b.from_scan[j]);
          if (overlap >= kLeastOverlapM2) of_pose.emplace_back(-pose.score_m2, -overlap, high, low, smaller);
        }
      }
      std::sort(of_pose.begin(), of_pose.end());
      of_pose.resize(std::min(of_pose.size(), kPairsOfPose));
      all.insert(all.end(), of_pose.begin(), of_pose.end());
    }
    return all;
  }

  const std::vector<ScanDigest>& digests_;
  const std::function<bool(std::size_t, std::size_t)>& tried_;
  const std::vector<PartPair>& pairs_;
  std::vector<std::optional<Part>> parts_;
};

}  // namespace

PairList PartJoiner::next_pairs(const std::vector<PlacedPart>& parts,
                                const std::function<bool(std::size_t, std::size_t)>& tried) {
  const auto size = [&](std::size_t part) { return parts[part].scans.size(); };
  std::vector<PartPair> open;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PartPair pair = size(i) > size(j) ? PartPair(i, j) : PartPair(j, i);
      if (sought_.count({parts[pair.first].scans, parts[pair.second].scans}) == 0) open.push_back(pair);
    }
  }
  std::stable_sort(open.begin(), open.end(), [&](const PartPair& a, const PartPair& b) {
    return size(a.first) + size(a.second) > size(b.first) + size(b.second);
  });
  open.resize(std::min(open.size(), kMatchesOfScan * digests_.size()));
  for (const auto& [larger, smaller] : open) sought_.emplace(parts[larger].scans, parts[smaller].scans);
  return Matching(digests_, tried, parts, open).best();
}

}  // namespace limen
