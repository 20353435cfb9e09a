// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/tukey_sums.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

TEST(LabelNearest, TellsWhatALookAtEachPlaneTells) {
  RandomStream random(5, 0);
  std::vector<Plane> planes;
  for (int k = 0; k < 7; ++k) {
    const Vector3d normal(random.normal(), random.normal(), random.normal());
    planes.push_back({normal.normalized(), random.normal()});
  }
  std::vector<Vector3d> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(random.normal(), random.normal(), random.normal());
  const double within_m = 0.1;
  std::vector<std::int32_t> labels(points.size(), -1);
  // In two pieces, as threads take them.
  label_nearest(points, 0, 300, planes, within_m, labels);
  label_nearest(points, 300, points.size(), planes, within_m, labels);
  int labelled = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::int32_t nearest = -1;
    double least = within_m;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const double off = std::abs(planes[k].signed_distance(points[i]));
      if (off >= least) continue;
      least = off;
      nearest = static_cast<std::int32_t>(k);
    }
    EXPECT_EQ(labels[i], nearest) << i;
    labelled += nearest >= 0 ? 1 : 0;
  }
  EXPECT_GT(labelled, 100);
  EXPECT_LT(labelled, 900);
}

}  // namespace
}  // namespace limen
