// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/posterior.h"

#include <numeric>

#include <gtest/gtest.h>

#include "limen/base/error.h"

namespace limen {
namespace {

double sum(const Posterior& all) {
  return std::accumulate(all.poses.begin(), all.poses.end(), 0.0) + all.others.nothing_shared +
         all.others.twin + all.others.unlisted_pose;
}

TEST(Posterior, EverythingSumsToOne) {
  for (const double value : {0.0, 3.0, 8.0, 40.0}) {
    EXPECT_NEAR(sum(posterior({value, {0.5, 3.0, 9.0}, 0.2, false})), 1.0, 1e-12) << value;
  }
}

TEST(Posterior, MuchCommonSurfaceLeavesTheBestAlone) {
  const Posterior all = posterior({30.0, {12.0}, 0.0, false});
  EXPECT_GT(all.poses[0], 0.999);
  EXPECT_LT(all.others.nothing_shared, 1e-6);
}

TEST(Posterior, HardlyAnyCommonSurfaceMeansNothingShared) {
  EXPECT_GT(posterior({2.0, {0.1}, 0.0, false}).others.nothing_shared, 0.9);
  // Where more is searched more is reached by chance.
  EXPECT_GT(posterior({6.0, {}, 0.0, true}).others.nothing_shared,
            posterior({6.0, {}, 0.0, false}).others.nothing_shared);
}

TEST(Posterior, PosesThatCannotBeToldApartShare) {
  const Posterior all = posterior({30.0, {0.0}, 0.0, false});
  EXPECT_NEAR(all.poses[0], 0.5, 1e-6);
  EXPECT_EQ(all.poses[0], all.poses[1]);
}

TEST(Posterior, ATwinTakesItsShare) {
  const Posterior all = posterior({30.0, {}, 0.25, false});
  EXPECT_NEAR(all.others.twin, 0.25, 1e-6);
  EXPECT_NEAR(all.poses[0], 0.75, 1e-6);
}

TEST(Posterior, BoundsAreNamed) {
  PosteriorOptions options;
  options.prior_shared = 1.0;
  EXPECT_THROW(posterior({}, options), Error);
}

}  // namespace
}  // namespace limen
