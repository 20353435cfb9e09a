// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/enumerate_hybrid_poses.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/match/opening_walls.h"
#include "limen/match/plane_shifts.h"

namespace limen {
namespace {

constexpr double kSamePoseM = 0.01;  // opening poses that differ along their normal only are one
constexpr double kSamePoseRad = 0.002;
constexpr double kMinRevealSigmaM = 0.003;
constexpr std::size_t kGrain = 8;

/// Up in a scan's frame: z where gravity is known, else what its openings say.
Vector3d up_of(const Features& features, bool gravity_known) {
  if (gravity_known) return Vector3d::UnitZ();
  Vector3d sum = Vector3d::Zero();
  for (const OpeningWall& wall : opening_walls(features)) sum += wall.frame.v;
  return sum.norm() > 1e-9 ? Vector3d(sum.normalized()) : Vector3d(Vector3d::UnitZ());
}

/// The pose moved along its wall's normal until the wall has this thickness.
HybridPose at_thickness(const OpeningPose& opening, double thickness_m, ThicknessSource source) {
  HybridPose pose;
  pose.target_from_source = opening.target_from_source;
  pose.target_from_source.translation -= (thickness_m - opening.thickness_m) * opening.wall_normal;
  pose.thickness_m = thickness_m;
  pose.thickness_source = source;
  pose.free_translations = source == ThicknessSource::assumed ? 1 : 0;
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
                up_of(target, options.openings.gravity_known),
                {options.plane_parallel_deg, options.min_normal_cosine, options.min_overlap_m2,
                 PlaneShiftOptions{}.max_planes}) {}

  /// All poses of one opening pose, the best held first.
  [[nodiscard]] std::vector<HybridPose> poses_of(const OpeningPose& opening) const {
    if (opening.sides == WallSides::same) {  // both scans saw the same face: nothing is open
      return {at_thickness(opening, opening.thickness_m, ThicknessSource::planes)};
    }
    std::vector<HybridPose> poses;
    const auto add = [&](const HybridPose& pose) {
      const bool known = std::any_of(poses.begin(), poses.end(), [&](const HybridPose& other) {
        return std::abs(other.thickness_m - pose.thickness_m) < 0.5 * options_.offset_tolerance_m;
      });
      if (!known && possible(pose.thickness_m)) poses.push_back(pose);
    };
    if (options_.wall_thickness_m) {
      add(at_thickness(opening, *options_.wall_thickness_m, ThicknessSource::user));
    }
    if (opening.thickness_held) add(at_thickness(opening, opening.thickness_m, ThicknessSource::openings));
    for (const HybridPose& pose : held_by_planes(opening)) add(pose);
    if (const auto depth = reveal_thickness(source_, target_, opening)) {
      add(at_thickness(opening, *depth, ThicknessSource::reveals));
    }
    if (poses.empty()) {
      for (const double thickness : options_.openings.thicknesses_m) {
        add(at_thickness(opening, thickness, ThicknessSource::assumed));
      }
    }
    return poses;
  }

 private:
  [[nodiscard]] bool possible(double thickness) const {
    return thickness >= options_.openings.min_thickness_m && thickness <= options_.openings.max_thickness_m;
  }

  [[nodiscard]] std::vector<HybridPose> held_by_planes(const OpeningPose& opening) const {
    // A shift along the normal, towards the target's scanner, makes the wall thinner by as much.
    const auto shifts = finder_.along(opening.target_from_source, opening.wall_normal,
                                      opening.thickness_m - options_.openings.max_thickness_m,
                                      opening.thickness_m - options_.openings.min_thickness_m);
    std::vector<HybridPose> poses;
    for (const CommonShift& shift : common_shifts(shifts, options_.offset_tolerance_m, options_.max_shifts)) {
      poses.push_back(at_thickness(opening, opening.thickness_m - shift.shift_m, ThicknessSource::planes));
      poses.back().support_m2 = shift.overlap_m2;
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

const char* to_string(ThicknessSource source) {
  switch (source) {
    case ThicknessSource::user:
      return "user";
    case ThicknessSource::reveals:
      return "reveals";
    case ThicknessSource::openings:
      return "openings";
    case ThicknessSource::planes:
      return "planes";
    default:
      return "assumed";
  }
}

void HybridPoseOptions::check() const {
  openings.check();
  if (wall_thickness_m && !(*wall_thickness_m > 0.0)) {
    throw_bad_option("wall_thickness_m", *wall_thickness_m, "> 0");
  }
  if (!(offset_tolerance_m > 0.0)) throw_bad_option("offset_tolerance_m", offset_tolerance_m, "> 0");
  if (max_shifts < 1) throw_bad_option("max_shifts", max_shifts, ">= 1");
  if (max_poses < 1) throw_bad_option("max_poses", max_poses, ">= 1");
  PlaneShiftOptions{plane_parallel_deg, min_normal_cosine, min_overlap_m2, 1}.check();
}

std::vector<HybridPose> enumerate_hybrid_poses(const Features& source, const Features& target,
                                               const HybridPoseOptions& options) {
  options.check();
  const HybridPoseOptions all = with_users_thickness(options);
  return enumerate_hybrid_poses(source, target, enumerate_opening_poses(source, target, all.openings), all);
}

std::vector<HybridPose> enumerate_hybrid_poses(const Features& source, const Features& target,
                                               const std::vector<OpeningPose>& opening_poses,
                                               const HybridPoseOptions& options) {
  options.check();
  const HybridPoseOptions all = with_users_thickness(options);
  const HybridEnumerator enumerator(source, target, all);
  const std::vector<OpeningPose> openings = apart_within_the_wall(opening_poses);
  std::vector<std::vector<HybridPose>> found(openings.size());
  parallel_for(openings.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = enumerator.poses_of(openings[i]);
  });
  std::vector<HybridPose> poses;
  bool more = true;
  for (std::size_t rank = 0; more; ++rank) {
    more = false;
    for (const auto& some : found) {
      if (rank >= some.size()) continue;
      if (poses.size() == static_cast<std::size_t>(options.max_poses)) return poses;
      poses.push_back(some[rank]);
      more = true;
    }
  }
  return poses;
}

}  // namespace limen
