// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/kept_points.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// A wall at x = 2 m, 8 m wide and 4 m high, noise of 3 mm, seen in even angular steps from 0,0,0.
Scan wall(double step_rad) {
  Scan scan;
  RandomStream random(11, 0);
  for (double turn = -1.1; turn < 1.1; turn += step_rad) {
    for (double tilt = -0.75; tilt < 0.75; tilt += step_rad) {
      const Vector3d ray(std::cos(tilt) * std::cos(turn), std::cos(tilt) * std::sin(turn), std::sin(tilt));
      const double range = 2.0 / ray.x() + 0.003 * random.normal();
      if (std::abs(range * ray.y()) < 4.0 && std::abs(range * ray.z()) < 2.0)
        scan.points.emplace_back(range * ray);
    }
  }
  scan.centres = {Vector3d::Zero()};
  return scan;
}

ScanFrame seen_from_origin() {
  ScanFrame frame;
  frame.place.source = PlaceSource::told_by_file;
  return frame;
}

TEST(KeptPoints, WhatIsNearBecomesAsDenseAsAsked) {
  const Scan scan = wall(0.0015);
  const double wanted = 10000.0;
  const auto kept = kept_points(scan, seen_from_origin(), {wanted, 0});
  ASSERT_TRUE(kept.has_value());
  // Around the foot of the perpendicular the wall faces the scanner.
  double near = 0.0;
  for (const std::uint32_t i : *kept) near += scan.points[i].tail<2>().norm() < 0.4 ? 1.0 : 0.0;
  const double per_m2 = near / (3.14159265 * 0.4 * 0.4);
  EXPECT_NEAR(per_m2 / wanted, 1.0, 0.15);
}

TEST(KeptPoints, NeitherSideOfTheNoiseIsFavoured) {
  const Scan scan = wall(0.0015);
  const auto kept = kept_points(scan, seen_from_origin(), {5000.0, 0});
  ASSERT_TRUE(kept.has_value());
  const auto mean_of = [&](const auto& indices) {
    double sum = 0.0;
    double count = 0.0;
    for (const std::uint32_t i : indices) {
      sum += scan.points[i].x() - 2.0;
      count += 1.0;
    }
    return sum / count;
  };
  double whole = 0.0;
  for (const Vector3d& x : scan.points) whole += x.x() - 2.0;
  whole /= static_cast<double>(scan.size());
  const double allowed = 3.0 * 0.003 / std::sqrt(static_cast<double>(kept->size()));
  EXPECT_NEAR(mean_of(*kept), whole, allowed);
}

TEST(KeptPoints, TheyAreNoMoreThanTheyMayBeAndThoseFarOffStay) {
  const Scan scan = wall(0.002);
  const std::size_t most = scan.size() / 2;
  const auto kept = kept_points(scan, seen_from_origin(), {0.0, most});
  ASSERT_TRUE(kept.has_value());
  EXPECT_NEAR(static_cast<double>(kept->size()), static_cast<double>(most), 0.03 * static_cast<double>(most));
  const auto share_at = [&](double low, double high) {
    const std::set<std::uint32_t> chosen(kept->begin(), kept->end());
    double all = 0.0;
    double left = 0.0;
    for (std::uint32_t i = 0; i < scan.size(); ++i) {
      const double range = scan.points[i].norm();
      if (range < low || range > high) continue;
      all += 1.0;
      left += chosen.count(i) > 0 ? 1.0 : 0.0;
    }
    return left / all;
  };
  EXPECT_GT(share_at(3.6, 4.5), 1.5 * share_at(2.0, 2.4));
}

TEST(KeptPoints, AMovedOrUnknownScannerKeepsAllWithOneProbability) {
  Scan scan = wall(0.002);
  ScanFrame frame;
  EXPECT_EQ(kept_points(scan, frame, {5000.0, 0}), std::nullopt);
  const auto kept = kept_points(scan, frame, {5000.0, scan.size() / 2});
  ASSERT_TRUE(kept.has_value());
  EXPECT_NEAR(static_cast<double>(kept->size()), 0.5 * static_cast<double>(scan.size()),
              0.02 * static_cast<double>(scan.size()));
  scan.centres.assign(scan.size(), Vector3d::Zero());
  EXPECT_EQ(kept_points(scan, seen_from_origin(), {5000.0, scan.size() / 2}), kept);
}

TEST(KeptPoints, WhereHardlyAnyWouldGoAllStay) {
  const Scan scan = wall(0.004);
  EXPECT_EQ(kept_points(scan, seen_from_origin(), KeepOptions{}), std::nullopt);
  EXPECT_EQ(kept_points(scan, seen_from_origin(), {0.0, scan.size() * 9 / 10}), std::nullopt);
  EXPECT_EQ(kept_points(wall(0.001), seen_from_origin(), kKeepAll), std::nullopt);
  EXPECT_EQ(kept_points(Scan{}, seen_from_origin(), KeepOptions{}), std::nullopt);
}

}  // namespace
}  // namespace limen
