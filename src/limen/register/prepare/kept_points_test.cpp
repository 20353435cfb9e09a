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
  frame.place.source = PlaceSource::stated_by_file;
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

TEST(KeptPoints, AnUnknownScannerKeepsAllWithOneProbability) {
  const Scan scan = wall(0.002);
  ScanFrame frame;
  EXPECT_EQ(kept_points(scan, frame, {5000.0, 0}), std::nullopt);
  const auto kept = kept_points(scan, frame, {5000.0, scan.size() / 2});
  ASSERT_TRUE(kept.has_value());
  EXPECT_NEAR(static_cast<double>(kept->size()), 0.5 * static_cast<double>(scan.size()),
              0.02 * static_cast<double>(scan.size()));
}

/// A road 2.4 m under the way and a façade 10 m beside it, 20 m of them, a line every 2.5 cm.
Scan street(double step_rad) {
  Scan scan;
  for (double x = 0.0; x < 20.0; x += 0.025) {
    for (double turn = 0.0; turn < 6.28; turn += step_rad) {
      const double up = std::sin(turn);
      const double right = std::cos(turn);
      double range = 1e9;
      if (up < 0.0) range = std::min(range, 2.4 / -up);
      if (right > 0.0) range = std::min(range, 10.0 / right);
      if (range > 30.0 || range * up > 12.0) continue;
      scan.points.emplace_back(x, range * right, range * up);
      scan.centres.emplace_back(x, 0.0, 0.0);
    }
  }
  return scan;
}

ScanFrame stated_per_point() {
  ScanFrame frame;
  frame.place.source = PlaceSource::per_point;
  return frame;
}

/// Shares of the points of the road under the way and of the façade that are left.
struct StreetShares {
  double road = 0.0;
  double facade = 0.0;
};

StreetShares shares_of(const Scan& scan, const std::vector<std::uint32_t>& kept) {
  const auto on_road = [](const Vector3d& x) { return x.z() < -2.39 && std::abs(x.y()) < 1.0; };
  const auto on_facade = [](const Vector3d& x) { return x.y() > 9.99; };
  const auto count = [&](const auto& where) {
    double all = 0.0;
    double left = 0.0;
    for (const Vector3d& x : scan.points) all += where(x) ? 1.0 : 0.0;
    for (const std::uint32_t i : kept) left += where(scan.points[i]) ? 1.0 : 0.0;
    return left / all;
  };
  return {count(on_road), count(on_facade)};
}

TEST(KeptPoints, AlongAWayTheRoadBecomesAsDenseAsWhatIsFarOff) {
  const Scan scan = street(0.0015);
  const auto kept = kept_points(scan, stated_per_point(), KeepOptions{});
  ASSERT_TRUE(kept.has_value());
  const StreetShares shares = shares_of(scan, *kept);
  EXPECT_GT(shares.facade, 0.9);
  EXPECT_LT(shares.road, 0.5);
  EXPECT_GT(shares.road, 0.1);
}

TEST(KeptPoints, ASparseWayStaysAsItIs) {
  EXPECT_EQ(kept_points(street(0.012), stated_per_point(), KeepOptions{}), std::nullopt);
  EXPECT_EQ(kept_points(street(0.0015), stated_per_point(), kKeepAll), std::nullopt);
}

TEST(KeptPoints, AlongAWayTheyAreNoMoreThanTheyMayBe) {
  const Scan scan = street(0.0015);
  const std::size_t most = scan.size() / 4;
  const auto kept = kept_points(scan, stated_per_point(), {0.0, most, 0.0});
  ASSERT_TRUE(kept.has_value());
  EXPECT_NEAR(static_cast<double>(kept->size()), static_cast<double>(most), 0.03 * static_cast<double>(most));
  const StreetShares shares = shares_of(scan, *kept);
  EXPECT_GT(shares.facade, 1.5 * shares.road);
}

TEST(KeptPoints, WhereHardlyAnyWouldGoAllStay) {
  const Scan scan = wall(0.008);
  EXPECT_EQ(kept_points(scan, seen_from_origin(), KeepOptions{}), std::nullopt);
  EXPECT_EQ(kept_points(scan, seen_from_origin(), {0.0, scan.size() * 9 / 10}), std::nullopt);
  EXPECT_EQ(kept_points(wall(0.001), seen_from_origin(), kKeepAll), std::nullopt);
  EXPECT_EQ(kept_points(Scan{}, seen_from_origin(), KeepOptions{}), std::nullopt);
}

}  // namespace
}  // namespace limen
