// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/shift_triples.h"

#include <algorithm>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kTripleToleranceM = 0.06;
constexpr int kShiftsTried = 12;

/// Planes of both scans across one direction, at random.
AxisPairs random_axis(const Vector3d& direction, std::uint64_t seed) {
  RandomStream random(seed, 1);
  AxisPairs along;
  along.axis.direction = direction;
  along.axis.frame = make_frame({direction, 0.0}, Vector3d::Zero());
  for (std::size_t i = 0; i < 60; ++i) {
    const auto box = [&] {
      AxisBox made;
      made.low = uniform_vector(Vector2d(-5.0, -5.0), Vector2d(4.0, 4.0), random);
      made.high = made.low + uniform_vector(Vector2d(0.2, 0.2), Vector2d(3.0, 3.0), random);
      return made;
    };
    along.source_boxes.push_back({box()});
    along.target_boxes.push_back({box()});
    along.pairs.push_back({random.uniform(-3.0, 3.0), i, i, random.uniform(0.1, 4.0)});
  }
  std::sort(along.pairs.begin(), along.pairs.end(),
            [](const ShiftPair& a, const ShiftPair& b) { return a.shift < b.shift; });
  along.index(kTripleToleranceM);
  along.shifts = best_shifts(along.pairs, kTripleToleranceM, kShiftsTried);
  return along;
}

/// Three directions, no two at right angles.
std::vector<AxisPairs> oblique_axes() {
  return {random_axis(Vector3d(1.0, 0.1, 0.0).normalized(), 3),
          random_axis(Vector3d(0.2, 1.0, 0.1).normalized(), 4),
          random_axis(Vector3d(0.0, -0.1, 1.0).normalized(), 5)};
}

Vector3d shift_at(const std::vector<AxisPairs>& axes, const ShiftPlaces& at) {
  Matrix3d normals;
  Vector3d values;
  for (std::size_t k = 0; k < 3; ++k) {
    normals.row(static_cast<Eigen::Index>(k)) = axes[k].axis.direction.transpose();
    values[static_cast<Eigen::Index>(k)] = axes[k].shifts[at[k]].value;
  }
  return normals.inverse() * values;
}

TEST(ShiftTriples, NoTripleBringsMoreTogetherThanItsBound) {
  const std::vector<AxisPairs> axes = oblique_axes();
  const ShiftTriples triples(axes, {0, 1, 2}, 0.5, kTripleToleranceM, 0.0);
  const std::vector<ShiftTriples::Triple> all = triples.best_first();
  EXPECT_EQ(all.size(), static_cast<std::size_t>(kShiftsTried * kShiftsTried * kShiftsTried));
  int tighter = 0;
  for (const ShiftTriples::Triple& triple : all) {
    const Vector3d shift = shift_at(axes, triple.at);
    double sum = 0.5;
    double limits = 0.5;
    for (std::size_t k = 0; k < 3; ++k) {
      const double here = axes[k].support(shift, kTripleToleranceM);
      EXPECT_LE(here, triples.most_of(k, triple.at) + 1e-9);
      sum += here;
      limits += triples.support(k, triple.at[k]).most();
    }
    EXPECT_LE(sum, triple.most_m2 + 1e-9);
    EXPECT_LE(triple.most_m2, limits + 1e-6);
    tighter += triple.most_m2 < 0.7 * limits ? 1 : 0;
  }
  EXPECT_GT(tighter, 100);
}

TEST(ShiftTriples, LeavesOutOnlyWhatCannotReachTheLeast) {
  const std::vector<AxisPairs> axes = oblique_axes();
  const std::vector<ShiftTriples::Triple> all =
      ShiftTriples(axes, {0, 1, 2}, 0.5, kTripleToleranceM, 0.0).best_first();
  const double least = 0.6 * all.front().most_m2;
  std::set<ShiftPlaces> left;
  for (const ShiftTriples::Triple& triple : all) {
    if (triple.most_m2 > least) left.insert(triple.at);
  }
  ASSERT_FALSE(left.empty());
  ASSERT_LT(left.size(), all.size());
  std::set<ShiftPlaces> found;
  for (const ShiftTriples::Triple& triple :
       ShiftTriples(axes, {0, 1, 2}, 0.5, kTripleToleranceM, least).best_first())
    found.insert(triple.at);
  EXPECT_EQ(found, left);
}

TEST(ShiftTriples, ThoseThatCanBringMostTogetherComeFirst) {
  const std::vector<ShiftTriples::Triple> all =
      ShiftTriples(oblique_axes(), {0, 1, 2}, 0.5, kTripleToleranceM, 0.0).best_first();
  double most = 0.0;
  for (const ShiftTriples::Triple& triple : all) most = std::max(most, triple.most_m2);
  double before = most;
  for (const ShiftTriples::Triple& triple : all) {
    EXPECT_LE(triple.most_m2, before + most / 100.0);
    before = std::min(before, triple.most_m2);
  }
}

TEST(ShiftTriples, AnAxisWithoutShiftsLeavesNone) {
  std::vector<AxisPairs> axes = oblique_axes();
  axes[1].shifts.clear();
  EXPECT_TRUE(ShiftTriples(axes, {0, 1, 2}, 0.5, kTripleToleranceM, 0.0).best_first().empty());
}

}  // namespace
}  // namespace limen
