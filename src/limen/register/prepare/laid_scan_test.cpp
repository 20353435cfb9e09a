// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <numeric>
#include <set>
#include <tuple>

#include "support/synthetic_room.h"
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/register/prepare/prepare_scan.h"

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

TEST(LaidScan, OfPointsThatAreKeptItHasAllAndOfNoOther) {
  const Scan scan = room();
  const Scan all = laid_in(scan, ScanFrame{});
  const Scan few = laid_in(scan, ScanFrame{}, {.keep = {0.0, 20000}});
  EXPECT_EQ(all.size(), scan.size());
  EXPECT_NEAR(static_cast<double>(few.size()), 20000.0, 600.0);
  const std::set<Coordinates> own = coordinates_of(all);
  for (const Coordinates& x : coordinates_of(few)) EXPECT_EQ(own.count(x), 1U);
}

TEST(LaidScan, WhichAreKeptDoesNotDependOnTheirOrder) {
  const Scan scan = room();
  const Scan first = laid_in(scan, ScanFrame{}, {.keep = {0.0, 20000}});
  const Scan second = laid_in(shuffled(scan), ScanFrame{}, {.keep = {0.0, 20000}});
  EXPECT_EQ(coordinates_of(first), coordinates_of(second));
}

TEST(LaidScan, AScanThatIsGivenUpIsLaidAsAnyOther) {
  Scan scan = room();
  scan.intensities.assign(scan.size(), 1.0F);
  scan.topology.line.assign(scan.size(), 3);
  scan.topology.index.assign(scan.size(), 4);
  ScanFrame frame;
  frame.corner = {0.5, 0.25, 0.125};
  const Scan kept = laid_in(scan, frame);
  const Scan given_up = laid_in(Scan(scan), frame);
  EXPECT_EQ(kept.points, given_up.points);
  EXPECT_EQ(kept.topology.line, given_up.topology.line);
  EXPECT_EQ(kept.local_origin, given_up.local_origin);
}

}  // namespace
}  // namespace limen
