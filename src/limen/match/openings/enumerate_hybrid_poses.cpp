// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/enumerate_hybrid_poses.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/match/openings/opening_walls.h"
#include "limen/match/planes/plane_shifts.h"

namespace limen {
namespace {

constexpr double kCommonShiftM = 0.06;  // shifts nearer than this are one
constexpr int kMostShiftsAcross = 6;    // along the normal, per opening pose
constexpr std::size_t kMostHybridPoses = 1200;
constexpr double kSamePoseM = 0.01;  // opening poses that differ along their normal only are one
constexpr double kSamePoseRad = 0.002;
constexpr double kMinRevealSigmaM = 0.003;
constexpr std::size_t kDrawsPerPiece = 8;

/// Up in a scan's frame: z where gravity is known, else what its openings say.
Vector3d up_of(const Features& features, bool gravity_known) {
  if (gravity_known) return Vector3d::UnitZ();
  Vector3d sum = Vector3d::Zero();
  for (const WallWithOpenings& wall : walls_with_openings(features)) sum += wall.frame.v;
  return sum.norm() > 1e-9 ? Vector3d(sum.normalized()) : Vector3d(Vector3d::UnitZ());
}

/// The pose moved along its wall's normal until the wall has this thickness.
HybridPose at_thickness(const OpeningPose& opening, double thickness_m) {
  HybridPose pose;
  pose.target_from_source = opening.target_from_source;
  pose.target_from_source.translation -= (thickness_m - opening.thickness_m) * opening.wall_normal;
  pose.thickness_m = thickness_m;
  pose.opening = opening;
  return pose;
}

/// Mean depth of the reveals of a pose's openings that reach through the wall.
std::optional<double> reveal_thickness(const Features& source, const Features& target,
                                       const OpeningPose& opening) {
  double sum = 0.0;
  double weight = 0.0;
  const auto add = [&](const Opening& one) {
    if (!one.reveal_complete || !(one.reveal_depth_m > 0.0)) return;
    const double w = 1.0 / std::pow(std::max(kMinRevealSigmaM, one.reveal_sigma_m), 2);
    sum += w * one.reveal_depth_m;
    weight += w;
  };
  for (const OpeningPair& pair : opening.pairs) {
    add(source.openings[static_cast<std::size_t>(pair.source)]);
    add(target.openings[static_cast<std::size_t>(pair.target)]);
  }
  if (!(weight > 0.0)) return std::nullopt;
  return sum / weight;
}

class HybridEnumerator {
 public:
  HybridEnumerator(const Features& source, const Features& target, const HybridPoseOptions& options)
      : source_(source),
        target_(target),
        options_(options),
        finder_(source, target, up_of(source, options.openings.gravity_known),
                up_of(target, options.openings.gravity_known)) {}

  /// All poses of one opening pose, the best held first.
  [[nodiscard]] std::vector<HybridPose> poses_of(const OpeningPose& opening) const {
    if (opening.sides == WallSides::same) {  // nothing is open
      std::vector<HybridPose> poses = {at_thickness(opening, opening.thickness_m)};
      poses.front().support_m2 = support_at(shifts_near(opening, 0.0, 0.0), 0.0);
      return poses;
    }
    const auto shifts = shifts_near(opening, opening.thickness_m - options_.openings.max_thickness_m,
                                    opening.thickness_m - options_.openings.min_thickness_m);
    std::vector<HybridPose> poses;
    const auto add = [&](const HybridPose& pose) {
      const bool known = std::any_of(poses.begin(), poses.end(), [&](const HybridPose& other) {
        return std::abs(other.thickness_m - pose.thickness_m) < 0.5 * kCommonShiftM;
      });
      if (!known && possible(pose.thickness_m)) poses.push_back(pose);
    };
    if (options_.wall_thickness_m) {
      add(at_thickness(opening, *options_.wall_thickness_m));
    }
    if (opening.thickness_held) add(at_thickness(opening, opening.thickness_m));
    for (const HybridPose& pose : held_by_planes(opening, shifts)) add(pose);
    if (const auto depth = reveal_thickness(source_, target_, opening)) {
      add(at_thickness(opening, *depth));
    }
    if (poses.empty()) {
      for (const double thickness : options_.openings.thicknesses_m) {
        add(at_thickness(opening, thickness));
      }
    }
    for (HybridPose& pose : poses)
      pose.support_m2 = support_at(shifts, opening.thickness_m - pose.thickness_m);
    return poses;
  }

 private:
  /// Shifts along the normal that planes ask for. Towards the target's scanner the wall becomes thinner by as
  /// much.
  [[nodiscard]] std::vector<PlaneShift> shifts_near(const OpeningPose& opening, double low,
                                                    double high) const {
    return finder_.along(opening.target_from_source, opening.wall_normal, low - kCommonShiftM,
                         high + kCommonShiftM);
  }

  /// Overlap of the planes that agree with a shift.
  [[nodiscard]] double support_at(const std::vector<PlaneShift>& shifts, double shift_m) const {
    double sum = 0.0;
    for (const PlaneShift& shift : shifts) {
      const double off = (shift.shift_m - shift_m) / kCommonShiftM;
      sum += shift.overlap_m2 * std::max(0.0, 1.0 - off * off);
    }
    return sum;
  }

  [[nodiscard]] bool possible(double thickness) const {
    return thickness >= options_.openings.min_thickness_m && thickness <= options_.openings.max_thickness_m;
  }

  [[nodiscard]] std::vector<HybridPose> held_by_planes(const OpeningPose& opening,
                                                       const std::vector<PlaneShift>& shifts) const {
    std::vector<HybridPose> poses;
    for (const CommonShift& shift : common_shifts(shifts, kCommonShiftM, kMostShiftsAcross)) {
      poses.push_back(at_thickness(opening, opening.thickness_m - shift.shift_m));
    }
    return poses;
  }

  const Features& source_;
  const Features& target_;
  const HybridPoseOptions& options_;
  PlaneShiftFinder finder_;
};

/// Opening poses without those that repeat a better one at another assumed thickness.
std::vector<OpeningPose> apart_within_the_wall(const std::vector<OpeningPose>& poses) {
  std::vector<OpeningPose> kept;
  for (const OpeningPose& pose : poses) {
    const bool known =
        !pose.thickness_held && std::any_of(kept.begin(), kept.end(), [&](const OpeningPose& k) {
          if (k.sides != pose.sides || k.source_wall != pose.source_wall ||
              k.target_wall != pose.target_wall || k.thickness_held) {
            return false;
          }
          const Vector3d off = pose.target_from_source.translation - k.target_from_source.translation;
          if ((off - off.dot(pose.wall_normal) * pose.wall_normal).norm() > kSamePoseM) return false;
          return rotation_angle(k.target_from_source.rotation.transpose() *
                                pose.target_from_source.rotation) < kSamePoseRad;
        });
    if (!known) kept.push_back(pose);
  }
  return kept;
}

/// The place of each pose: the better of those by openings (the given order) and by planes.
std::vector<std::size_t> places_of(const std::vector<HybridPose>& poses) {
  std::vector<std::size_t> by_planes(poses.size());
  std::iota(by_planes.begin(), by_planes.end(), std::size_t{0});
  std::vector<std::size_t> places = by_planes;
  std::stable_sort(by_planes.begin(), by_planes.end(),
                   [&](std::size_t a, std::size_t b) { return poses[a].support_m2 > poses[b].support_m2; });
  for (std::size_t k = 0; k < by_planes.size() && poses[by_planes[k]].support_m2 > 0.0; ++k) {
    places[by_planes[k]] = std::min(places[by_planes[k]], k);
  }
  return places;
}

/// Both lists by place, at most `most`. Overlaps are compared within a list only: scans of one side share
/// whole façades, scans of opposite sides a strip of a back wall.
std::vector<HybridPose> merged(const std::vector<HybridPose>& opposite, const std::vector<HybridPose>& same,
                               std::size_t most) {
  std::vector<std::pair<std::size_t, const HybridPose*>> order;
  for (const std::vector<HybridPose>* list : {&opposite, &same}) {
    const std::vector<std::size_t> places = places_of(*list);
    for (std::size_t i = 0; i < list->size(); ++i) order.emplace_back(places[i], &(*list)[i]);
  }
  // The distance is of all edges of both scans, so it compares across the cases too.
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    return a.second->opening.distance < b.second->opening.distance;
  });
  std::vector<HybridPose> poses;
  for (const auto& [place, pose] : order) {
    if (poses.size() == most) break;
    poses.push_back(*pose);
  }
  return poses;
}

/// The options with the user's thickness for possible, and for the only assumption.
HybridPoseOptions with_users_thickness(HybridPoseOptions options) {
  if (options.wall_thickness_m) {
    const double thickness = *options.wall_thickness_m;
    options.openings.thicknesses_m = {thickness};
    options.openings.min_thickness_m = std::min(options.openings.min_thickness_m, 0.9 * thickness);
    options.openings.max_thickness_m = std::max(options.openings.max_thickness_m, 1.1 * thickness);
  }
  return options;
}

}  // namespace

std::vector<HybridPose> enumerate_hybrid_poses(const Features& source, const Features& target,
                                               const HybridPoseOptions& options) {
  const HybridPoseOptions all = with_users_thickness(options);
  const HybridEnumerator enumerator(source, target, all);
  const std::vector<OpeningPose> openings =
      apart_within_the_wall(enumerate_opening_poses(source, target, all.openings));
  std::vector<std::vector<HybridPose>> found(openings.size());
  parallel_for(openings.size(), kDrawsPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = enumerator.poses_of(openings[i]);
  });
  std::vector<HybridPose> opposite;
  std::vector<HybridPose> same;
  for (const std::vector<HybridPose>& some : found) {
    for (const HybridPose& pose : some) {
      (pose.opening.sides == WallSides::opposite ? opposite : same).push_back(pose);
    }
  }
  return merged(opposite, same, kMostHybridPoses);
}

}  // namespace limen
