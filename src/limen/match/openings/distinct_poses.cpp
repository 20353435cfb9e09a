// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/openings/distinct_poses.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "limen/base/angles.h"

namespace limen {

std::vector<OpeningPose> distinct_poses(std::vector<OpeningPose> poses, const Vector3d& middle) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const OpeningPose& a, const OpeningPose& b) { return a.distance < b.distance; });
  constexpr double kCellM = kSameInWallM + kSameAcrossWallM;
  std::vector<OpeningPose> kept;
  std::vector<Vector3d> middles;
  // Of kept, in cells wider than the distance of two poses that look alike.
  std::map<long, std::vector<std::size_t>> by_x;
  const auto look_alikes = [&](const OpeningPose& pose, const Vector3d& moved, std::size_t other) {
    const Vector3d off = moved - middles[other];
    const double across = off.dot(pose.wall_normal);
    if (std::abs(across) >= kSameAcrossWallM) return false;
    if ((off - across * pose.wall_normal).norm() >= kSameInWallM) return false;
    const Matrix3d turn =
        kept[other].target_from_source.rotation.transpose() * pose.target_from_source.rotation;
    return rotation_angle(turn) < radians(1.0);
  };
  for (OpeningPose& pose : poses) {
    const Vector3d moved = pose.target_from_source * middle;
    const long place = std::lround(std::floor(moved.x() / kCellM));
    bool known = false;
    for (long k = place - 1; k <= place + 1 && !known; ++k) {
      const auto near = by_x.find(k);
      if (near == by_x.end()) continue;
      known = std::any_of(near->second.begin(), near->second.end(),
                          [&](std::size_t other) { return look_alikes(pose, moved, other); });
    }
    if (known) continue;
    by_x[place].push_back(kept.size());
    middles.push_back(moved);
    kept.push_back(std::move(pose));
  }
  return kept;
}

}  // namespace limen
