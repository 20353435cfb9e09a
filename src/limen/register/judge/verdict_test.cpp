// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/verdict.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

/// A pose held by one square metre in each direction.
FoundPose found_at(double agreeing_m2, double shift_m) {
  FoundPose found;
  found.refined.target_from_source.translation.x() = shift_m;
  found.refined.centre.x() = shift_m;
  found.refined.geometry_m2 = Matrix6d::Identity();
  found.refined.information = 1e8 * Matrix6d::Identity();
  found.score.agreeing_m2 = found.score.evidence_m2 = agreeing_m2;
  return found;
}

TEST(Rank, TheSamePoseTwiceIsOne) {
  const std::vector<FoundPose> poses{found_at(20, 0.01), found_at(30, 0), found_at(25, 2)};
  EXPECT_EQ(rank(poses), (std::vector<std::size_t>{1, 2}));
}

TEST(Rank, ABeliefCountsAsTheSurfaceThatWouldTellAsMuch) {
  std::vector<FoundPose> poses{found_at(20, 0), found_at(22, 2)};
  EXPECT_EQ(rank(poses).front(), 1U);
  poses[0].log_prior = 8.0;
  EXPECT_EQ(rank(poses).front(), 0U);
}

TEST(OpenFreedoms, AnOpenShiftIsNamed) {
  FoundPose slides = found_at(30, 0);
  EXPECT_TRUE(unobserved_freedoms(slides.refined, 0.03).empty());
  slides.refined.geometry_m2(4, 4) = 0.0;
  const std::vector<UnobservedFreedom> open = unobserved_freedoms(slides.refined, 0.03);
  ASSERT_EQ(open.size(), 1U);
  EXPECT_FALSE(open[0].rotation);
  EXPECT_NEAR(std::abs(open[0].direction.y()), 1.0, 1e-9);
}

TEST(OpenFreedoms, AShiftThatIsHardlyKnownIsNamed) {
  FoundPose loose = found_at(30, 0);
  loose.refined.information(4, 4) = 1.0 / (0.024 * 0.024);
  const OpenFreedoms open = open_freedoms(loose.refined, 1e-8 * Matrix6d::Identity());
  ASSERT_EQ(open.list.size(), 1U);
  EXPECT_NEAR(open.list[0].direction.y(), 1.0, 1e-9);
  EXPECT_NE(open.list[0].name.find("24 mm"), std::string::npos);
}

TEST(OpenFreedoms, ATrajectoryThatDriftsFarLeavesAShiftOpen) {
  Matrix6d covariance = 1e-8 * Matrix6d::Identity();
  covariance.bottomRightCorner<3, 3>() += 0.03 * 0.03 * Matrix3d::Identity();
  EXPECT_TRUE(open_freedoms(found_at(30, 0).refined, covariance).list.empty());
  covariance(3, 3) = 0.06 * 0.06;
  const OpenFreedoms open = open_freedoms(found_at(30, 0).refined, covariance);
  EXPECT_EQ(open.cause, OpenFreedoms::Cause::drift);
  ASSERT_EQ(open.list.size(), 1U);
  EXPECT_NE(open.list[0].name.find("60 mm"), std::string::npos);
  // What the surface itself leaves open comes first.
  FoundPose slides = found_at(30, 0);
  slides.refined.geometry_m2(4, 4) = 0.0;
  EXPECT_EQ(open_freedoms(slides.refined, covariance).cause, OpenFreedoms::Cause::surface);
}

TEST(OpenFreedoms, APoseFurtherOnAlongAnOpenShiftIsTheSamePlace) {
  FoundPose open = found_at(30, 0);
  EXPECT_FALSE(is_slid(open.refined, found_at(29, 2).refined));
  open.refined.geometry_m2(3, 3) = 0.0;
  EXPECT_TRUE(is_slid(open.refined, found_at(29, 2).refined));
  FoundPose elsewhere = found_at(29, 2);
  elsewhere.refined.target_from_source.translation.y() = 2;
  EXPECT_FALSE(is_slid(open.refined, elsewhere.refined));
}

TEST(OpenFreedoms, AShiftHeldOnlyThroughATurnIsOpen) {
  // Coupling: what holds the shift is the same tile that would have to hold the turn.
  FoundPose coupled = found_at(30, 0);
  coupled.refined.geometry_m2(2, 4) = coupled.refined.geometry_m2(4, 2) = 0.9999;
  EXPECT_FALSE(unobserved_freedoms(coupled.refined, 0.03).empty());
}

TEST(VerdictOptions, TheyNameTheirBound) {
  VerdictOptions options;
  options.max_sigma_m = -1.0;
  EXPECT_THROW(options.check(), Error);
  for (const double probable : {0.001, 0.0005, 0.5}) {
    options = {};
    options.probable_risk = probable;
    EXPECT_THROW(options.check(), Error) << probable;
  }
}

}  // namespace
}  // namespace limen
