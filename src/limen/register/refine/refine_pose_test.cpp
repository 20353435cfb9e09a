// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/refine_pose.h"

#include <array>
#include <cmath>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/progress.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/rigid.h"
#include "limen/register/judge/score_pose.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/prepare/prepared_pair.h"
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

/// The box after a floor was laid on its floor.
Scan with_raised_floor(Scan box, double raised_m) {
  for (Vector3d& x : box.points) {
    if (x.z() < -1.49) x.z() += raised_m;
  }
  return box;
}

/// A box against itself as it is after the floor was raised.
RefinedPose pose_after_raising(double raised_m) {
  const Scan box = box_scan(40000, -1.2, 1.5);
  const PrepareOptions options = prepare_options({});
  const PreparedScan source = prepare_scan(box, options);
  const PreparedScan target = prepare_scan(with_raised_floor(box, raised_m), options);
  const Matrix3d rotation = target.upright_from_scan * source.upright_from_scan.transpose();
  const Vector3d shift = source.extracted.features.local_origin - target.extracted.features.local_origin;
  RefinedPose pose =
      refine_pose(source.view(), target.view(), {rotation, target.upright_from_scan * shift}, {});
  find_moved(source.view(), target.view(), {}, pose);
  return pose;
}

TEST(RefinePose, AFloorThatWasRaisedBetweenTheScansLeavesTheHeightOpenByAsMuch) {
  for (const double raised_m : {0.04, 0.06}) {
    const RefinedPose pose = pose_after_raising(raised_m);
    ASSERT_EQ(pose.moved.size(), 1u) << raised_m;
    EXPECT_NEAR(std::abs(pose.moved[0].distance_m), raised_m, 0.003);
    const Vector3d deviation = pose.spread.diagonal().tail<3>().cwiseSqrt();
    EXPECT_GT(deviation.z(), 0.4 * raised_m);
    EXPECT_LT(deviation.z(), raised_m);
    EXPECT_LT(deviation.head<2>().norm(), 0.001);
  }
}

/// Turned about its scanner.
Scan turned(Scan scan, const Matrix3d& rotation) {
  for (Vector3d& x : scan.points) x = rotation * x;
  return scan;
}

TEST(RefinePose, WhatAMovedFloorLeavesOpenTurnsWithTheTarget) {
  const Scan room = box_scan(40000, -1.2, 1.5);
  const Scan later = with_raised_floor(room, 0.04);
  const Matrix3d roll = rotation_exp(Vector3d(1.5, 0.2, 0.0));
  const auto covariance_of_shifts = [&](const Scan& target) {
    const PreparedPair pair{prepare_scan(room, prepare_options({})),
                            prepare_scan(target, prepare_options({}))};
    return Matrix3d(register_prepared(pair, {}, silent_monitor()).sigma.covariance.bottomRightCorner<3, 3>());
  };
  const Matrix3d upright = covariance_of_shifts(later);
  const Matrix3d rolled = covariance_of_shifts(turned(later, roll));
  EXPECT_GT(upright(2, 2), 1e-4);
  EXPECT_LT((rolled - roll * upright * roll.transpose()).norm(), 0.1 * upright.norm()) << rolled;
}

/// Two long walls, a floor and a ceiling, between which nothing holds the shift along them.
Scan corridor(double ceiling_m, std::uint64_t seed) {
  RandomStream random(seed);
  Scan scan;
  scan.name = "corridor";
  for (int i = 0; i < 60000; ++i) {
    const double x = random.uniform(-5.0, 5.0);
    const bool wall = random.below(2) == 0;
    const bool first = random.below(2) == 0;
    Vector3d at(x, wall ? (first ? -1.5 : 1.5) : random.uniform(-1.5, 1.5),
                wall ? random.uniform(-1.5, ceiling_m) : (first ? -1.5 : ceiling_m));
    scan.points.push_back(at + 0.002 * random.normal() * at.normalized());
  }
  scan.centres = {Vector3d::Zero()};
  return scan;
}

TEST(RefinePose, AMovedCeilingOpensNoShiftThatWallsHoldWhereAnotherIsFree) {
  const PrepareOptions options = prepare_options({});
  const PreparedScan source = prepare_scan(corridor(1.2, 1), options);
  const PreparedScan target = prepare_scan(corridor(1.16, 2), options);
  const Matrix3d rotation = target.upright_from_scan * source.upright_from_scan.transpose();
  const Vector3d shift = source.extracted.features.local_origin - target.extracted.features.local_origin;
  RefinedPose pose =
      refine_pose(source.view(), target.view(), {rotation, target.upright_from_scan * shift}, {});
  find_moved(source.view(), target.view(), {}, pose);
  ASSERT_EQ(pose.moved.size(), 1u);
  const Matrix3d spread =
      rotation.transpose() * pose.spread.bottomRightCorner<3, 3>() * rotation;  // along the corridor, ...
  EXPECT_LT(std::sqrt(spread(0, 0)), 1e-3);
  EXPECT_LT(std::sqrt(spread(1, 1)), 1e-3);
  EXPECT_GT(std::sqrt(spread(2, 2)), 0.01);
}

TEST(RefinePose, OfARoomThatIsAsItWasNothingIsMoved) {
  const RefinedPose pose = pose_after_raising(0.0);
  EXPECT_TRUE(pose.moved.empty());
  EXPECT_TRUE(pose.spread.isZero(0.0));
}

/// A wall's windows, `columns` side by side and `rows` above one another, their sides known to 4 cm.
Features windows(int columns, int rows) {
  Features features;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const Vector3d corner(3.0 * i, 0.0, 3.0 * j);
      Opening opening;
      const Vector3d across = Vector3d::UnitX();
      const Vector3d up = 1.5 * Vector3d::UnitZ();
      const std::array<Vector3d, 4> corners = {corner, corner + across, corner + across + up, corner + up};
      for (std::size_t k = 0; k < corners.size(); ++k) {
        opening.corners[k] = corners[k];
        opening.edge_sigma_m[k] = 0.04;
      }
      features.openings.push_back(opening);
    }
  }
  return features;
}

/// What openings say of shifts along `axis`, 1/m^2.
double stated_along(const Vector3d& axis, int columns, int rows) {
  const Features features = windows(columns, rows);
  ScanView view;
  view.features = &features;
  RefineOptions options;
  options.planes = false;
  const RefinedPose pose = refine_pose(view, view, Rigid3{}, options);
  EXPECT_EQ(pose.openings.size(), static_cast<std::size_t>(columns * rows));
  return axis.dot(pose.information.bottomRightCorner<3, 3>() * axis);
}

TEST(RefinePose, WindowsAboveOneAnotherTellOneShiftAlongTheirWall) {
  const Vector3d along = Vector3d::UnitX();
  const double one = stated_along(along, 1, 1);
  EXPECT_GT(one, 0.0);
  EXPECT_NEAR(stated_along(along, 1, 3), one, 1e-6 * one);
  EXPECT_NEAR(stated_along(along, 3, 1), 3.0 * one, 1e-6 * one);
  EXPECT_NEAR(stated_along(along, 3, 3), 3.0 * one, 1e-6 * one);
  const Vector3d up = Vector3d::UnitZ();
  EXPECT_NEAR(stated_along(up, 1, 3), 3.0 * stated_along(up, 1, 1), 1e-6 * one);
}

TEST(ScorePose, OpeningsOfPoorlyKnownPlacesMayAgreeMore) {
  Features features = windows(1, 1);
  ScanView view;
  view.features = &features;
  const Rigid3 off{Matrix3d::Identity(), Vector3d(0.1, 0.0, 0.0)};
  // Known to 4 cm on either side: 10 cm are less than two deviations.
  const PoseScore poorly = score_pose(view, view, off, {});
  EXPECT_GT(poorly.unsure_opening_m2, 0.1);
  EXPECT_NEAR(poorly.opening_m2 + poorly.unsure_opening_m2, score_pose(view, view, {}, {}).opening_m2, 0.02);
  for (double& sigma : features.openings.front().edge_sigma_m) sigma = 0.001;
  const PoseScore well = score_pose(view, view, off, {});
  EXPECT_NEAR(well.opening_m2, poorly.opening_m2, 1e-9);
  EXPECT_LT(well.unsure_opening_m2, 0.3 * poorly.unsure_opening_m2);
}

/// Turn and shift about `centre` by which `moved` is off from `pose`.
Vector6d off(const Rigid3& pose, const Rigid3& moved, const Vector3d& centre) {
  const Rigid3 by = moved * inverse(pose);
  Vector6d both;
  both << rotation_log(by.rotation), by * centre - centre;
  return both;
}

TEST(RefinePose, TurnedRoundItIsKnownAsWell) {
  RandomStream random(31);
  RefinedPose pose;
  pose.target_from_source = {uniform_rotation(random), {3.0, -2.0, 1.0}};
  pose.centre = {1.0, 4.0, -2.0};
  Matrix6d root;
  for (Eigen::Index k = 0; k < 36; ++k) root.data()[k] = random.normal();
  pose.information = root * root.transpose() + Matrix6d::Identity();
  pose.geometry_m2 = pose.information;
  pose.formal_information = 2.0 * pose.information;
  pose.matches = {{1, 2, 0.003, 0.01, 5.0}};
  const RefinedPose back = inverted(pose);
  // What small turns and shifts of the one are of the other, by differences.
  constexpr double kStep = 1e-6;
  Matrix6d change;
  for (Eigen::Index k = 0; k < 6; ++k) {
    Vector6d step = Vector6d::Zero();
    step[k] = kStep;
    Rigid3 about;
    about.rotation = rotation_exp(Vector3d(step.head<3>()));
    about.translation = pose.centre - about.rotation * pose.centre + Vector3d(step.tail<3>());
    change.col(k) =
        off(back.target_from_source, inverse(about * pose.target_from_source), back.centre) / kStep;
  }
  const Matrix6d expected = change * covariance_of(pose) * change.transpose();
  EXPECT_LT((covariance_of(back) - expected).norm(), 1e-4 * expected.norm());
  EXPECT_LT((formal_covariance_of(back) - 0.5 * expected).norm(), 1e-4 * expected.norm());
  EXPECT_LT((back.centre - inverse(pose.target_from_source) * pose.centre).norm(), 1e-12);
  EXPECT_EQ(back.matches[0].source, 2);
  EXPECT_EQ(back.matches[0].target, 1);
  EXPECT_EQ(back.matches[0].distance_m, -0.003);
  EXPECT_LT((inverted(back).information - pose.information).norm(), 1e-9 * pose.information.norm());
}

/// Two rooms' openings in one wall: what has to move to the right from one side has to move to the left
/// from the other.
TEST(RefinePose, TurnedRoundOpeningsMoveTheOtherWay) {
  RefinedPose pose;
  pose.target_from_source.translation = {1.0, 2.0, 3.0};
  OpeningMatch match;
  match.source = 4;
  match.target = 7;
  match.shift_across_m = 0.02;
  match.shift_up_m = 0.03;
  match.gap_m = 0.3;
  for (const bool opposite : {false, true}) {
    match.opposite = opposite;
    pose.openings = {match};
    const OpeningMatch back = inverted(pose).openings[0];
    EXPECT_EQ(back.source, 7);
    EXPECT_EQ(back.target, 4);
    // The same shift within the wall, of the other side: its opposite, in the axes of this one.
    const Vector3d shift = match.shift_across_m * match.across + match.shift_up_m * match.up;
    EXPECT_LT((back.shift_across_m * back.across + back.shift_up_m * back.up + shift).norm(), 1e-12);
    EXPECT_EQ(back.across.dot(match.across), opposite ? -1.0 : 1.0);
    EXPECT_EQ(back.gap_m, opposite ? match.gap_m : -match.gap_m);
  }
}

}  // namespace
}  // namespace limen
