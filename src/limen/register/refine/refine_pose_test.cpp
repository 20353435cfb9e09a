// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/refine_pose.h"

#include <array>
#include <cmath>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/rigid.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/register.h"

namespace limen {
namespace {

/// The box with each of its six walls leaning a little on its own, as walls do in the eyes of a scanner.
Scan leaning(Scan box, std::uint64_t seed, double slope) {
  RandomStream random(seed, 2);
  std::array<std::array<double, 2>, 6> slopes{};
  for (auto& of_wall : slopes) of_wall = {slope * random.normal(), slope * random.normal()};
  const Vector3d low(-2, -3, -1.5);
  const Vector3d high(4, 2, 1.5);
  for (Vector3d& x : box.points) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const bool at_high = std::abs(x[axis] - high[axis]) < 0.012;
      if (!at_high && std::abs(x[axis] - low[axis]) >= 0.012) continue;
      const auto& leans = slopes[static_cast<std::size_t>(2 * axis + (at_high ? 1 : 0))];
      const Vector3d from_middle = x - 0.5 * (low + high);
      x[axis] += leans[0] * from_middle[(axis + 1) % 3] + leans[1] * from_middle[(axis + 2) % 3];
      break;
    }
  }
  return box;
}

struct Squares {
  double stated = 0.0;  ///< mean square of a turn's error in its deviations
  double formal = 0.0;  ///< in those of the points' scatter alone
};

Squares turns_in_sigmas(double slope) {
  constexpr int kRooms = 12;
  const Scan box = box_scan(40000, -1.2, 1.5);
  const PrepareOptions options = prepare_options({});
  const PreparedScan source = prepare_scan(box, options);
  Squares squares;
  for (std::uint64_t seed = 1; seed <= kRooms; ++seed) {
    const PreparedScan target = prepare_scan(leaning(box, seed, slope), options);
    const Matrix3d rotation = target.upright_from_scan * source.upright_from_scan.transpose();
    const Vector3d shift = source.extracted.features.local_origin - target.extracted.features.local_origin;
    const Rigid3 truth{rotation, target.upright_from_scan * shift};
    const RefinedPose pose = refine_pose(source.view(), target.view(), truth, {});
    const Vector3d off = rotation_log(pose.target_from_source.rotation * rotation.transpose());
    const Matrix6d stated = covariance_of(pose);
    const Matrix6d formal = formal_covariance_of(pose);
    for (Eigen::Index k = 0; k < 3; ++k) {
      squares.stated += off[k] * off[k] / stated(k, k) / (3.0 * kRooms);
      squares.formal += off[k] * off[k] / formal(k, k) / (3.0 * kRooms);
    }
  }
  return squares;
}

TEST(RefinePose, WallsThatLeanEachOnItsOwnAreInTheDeviationOfTurns) {
  const Squares squares = turns_in_sigmas(0.001);
  EXPECT_GT(squares.formal, 9.0);
  EXPECT_LT(squares.stated, 2.0);
  EXPECT_GT(squares.stated, 0.2);
}

}  // namespace
}  // namespace limen
