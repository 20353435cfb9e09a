// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/laid_scan.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

using Coordinates = std::tuple<double, double, double>;

std::set<Coordinates> coordinates_of(const Scan& scan) {
  std::set<Coordinates> all;
  for (const Vector3d& x : scan.points) all.emplace(x.x(), x.y(), x.z());
  return all;
}

Scan room() {
  return box_scan(60000, -1.2, 1.5707);
}

Scan shuffled(const Scan& scan) {
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0U);
  RandomStream random(3, 1);
  for (std::size_t i = order.size() - 1; i > 0; --i)
    std::swap(order[i], order[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i + 1)))]);
  return subset(scan, order);
}

TEST(LaidScan, KeepsAboutSoManyOfItsOwnPoints) {
  const Scan scan = room();
  const Scan all = laid_in(scan, ScanFrame{});
  const Scan few = laid_in(scan, ScanFrame{}, 20000);
  EXPECT_EQ(all.size(), scan.size());
  EXPECT_LE(few.size(), 20000U);
  EXPECT_GT(few.size(), 10000U);
  const std::set<Coordinates> own = coordinates_of(all);
  for (const Coordinates& x : coordinates_of(few)) EXPECT_EQ(own.count(x), 1U);
}

TEST(LaidScan, SmallerScansStayWhole) {
  const Scan scan = room();
  EXPECT_EQ(laid_in(scan, ScanFrame{}, scan.size()).size(), scan.size());
}

TEST(LaidScan, WhichAreKeptDoesNotDependOnTheirOrder) {
  const Scan scan = room();
  const Scan first = laid_in(scan, ScanFrame{}, 20000);
  const Scan second = laid_in(shuffled(scan), ScanFrame{}, 20000);
  EXPECT_EQ(coordinates_of(first), coordinates_of(second));
}

TEST(LaidScan, NoPlaceLosesAllItsPoints) {
  const Scan scan = room();
  const Scan few = laid_in(scan, ScanFrame{}, 20000);
  const auto cubes_of = [](const Scan& of) {
    std::set<std::tuple<int, int, int>> cubes;
    for (const Vector3d& x : of.points)
      cubes.emplace(static_cast<int>(x.x() / 0.3), static_cast<int>(x.y() / 0.3),
                    static_cast<int>(x.z() / 0.3));
    return cubes.size();
  };
  EXPECT_GT(static_cast<double>(cubes_of(few)), 0.97 * static_cast<double>(cubes_of(scan)));
}

}  // namespace
}  // namespace limen
