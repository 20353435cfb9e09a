// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/grow_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// A rectangle of a plane: corner and two sides.
struct Patch {
  Vector3d corner;
  Vector3d u;
  Vector3d v;
};

/// Points spread evenly at random over the patch, `density` per square metre, noise along its normal.
void add_patch(Scan& scan, const Patch& patch, double density, double noise_m, std::uint64_t seed) {
  RandomStream random(seed);
  const Vector3d cross = patch.u.cross(patch.v);
  const auto count = static_cast<std::size_t>(density * cross.norm());
  for (std::size_t i = 0; i < count; ++i) {
    const double off = noise_m * random.normal();
    const Vector2d in = uniform_vector(Vector2d(0.0, 0.0), Vector2d(1.0, 1.0), random);
    scan.points.emplace_back(patch.corner + in.x() * patch.u + in.y() * patch.v + off * cross.normalized());
  }
}

/// The label that most of the points [begin, end) have, and the share that has it.
std::pair<std::int32_t, double> main_label(const GrownPlanes& grown, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> counts(grown.planes.fits.size() + 1, 0);
  for (std::size_t i = begin; i < end; ++i) ++counts[static_cast<std::size_t>(grown.planes.labels[i] + 1)];
  const auto most = std::max_element(counts.begin(), counts.end());
  return {static_cast<std::int32_t>(most - counts.begin()) - 1,
          static_cast<double>(*most) / static_cast<double>(end - begin)};
}

TEST(GrowPlanes, ParallelWallsTenCentimetresApartAreTwo) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 0, 2.5}}, 1500, 0.003, 1);
  const std::size_t first = scan.size();
  add_patch(scan, {{1, 0.1, 0}, {4, 0, 0}, {0, 0, 2.5}}, 1500, 0.003, 2);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 2U);
  const auto front = main_label(grown, 0, first);
  const auto back = main_label(grown, first, scan.size());
  EXPECT_NE(front.first, back.first);
  EXPECT_GT(front.second, 0.97);
  EXPECT_GT(back.second, 0.97);
  for (const PlaneFit& fit : grown.planes.fits) {
    EXPECT_NEAR(std::abs(fit.plane.normal.y()), 1.0, 1e-6);
    EXPECT_NEAR(fit.rms_m, 0.003, 0.0006);
  }
  EXPECT_NEAR(std::abs(grown.planes.fits[0].plane.offset - grown.planes.fits[1].plane.offset), 0.1, 5e-4);
  EXPECT_NEAR(grown.noise_m, 0.003, 0.0006);
}

TEST(GrowPlanes, AStepOfTwoCentimetresInAWallIsSeen) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {1.5, 0, 0}, {0, 0, 2.5}}, 3000, 0.003, 1);
  const std::size_t first = scan.size();
  add_patch(scan, {{1.5, 0.024, 0}, {0.6, 0, 0}, {0, 0, 2.5}}, 3000, 0.003, 2);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 2U);
  EXPECT_NE(main_label(grown, 0, first).first, main_label(grown, first, scan.size()).first);
}

TEST(GrowPlanes, AWallBehindAColumnIsOne) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {2, 0, 0}, {0, 0, 2.5}}, 1200, 0.003, 1);
  add_patch(scan, {{3, 0, 0}, {2, 0, 0}, {0, 0, 2.5}}, 1200, 0.003, 2);
  const std::size_t wall = scan.size();
  // A round column before the gap.
  RandomStream random(3);
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0.0, std::numbers::pi);
    scan.points.emplace_back(2.5 + 0.25 * std::cos(angle), -0.8 - 0.25 * std::sin(angle),
                             random.uniform(0.0, 2.5));
  }
  const GrownPlanes grown = grow_planes(scan);
  const auto found = main_label(grown, 0, wall);
  EXPECT_EQ(found.first, 0);
  EXPECT_GT(found.second, 0.97);
  EXPECT_NEAR(std::abs(grown.planes.fits[0].plane.normal.y()), 1.0, 1e-6);
}

TEST(GrowPlanes, AnEdgeMakesNoPlaneOfItsOwn) {
  // Where two walls meet, points of both lie in any plane through the edge.
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {3, 0, 0}, {0, 0, 2.5}}, 8000, 0.004, 1);
  const std::size_t first = scan.size();
  add_patch(scan, {{0, 0, 0}, {0, 3, 0}, {0, 0, 2.5}}, 8000, 0.004, 2);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 2U);
  EXPECT_GT(main_label(grown, 0, first).second, 0.98);
  EXPECT_GT(main_label(grown, first, scan.size()).second, 0.98);
}

TEST(GrowPlanes, AFarWallOfFewPointsIsFound) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 2000, 0.003, 1);
  const std::size_t floor = scan.size();
  // Ten points on a square metre, 20 m away.
  add_patch(scan, {{-5, 20, 0}, {14, 0, 0}, {0, 0, 6}}, 10, 0.003, 2);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 2U);
  EXPECT_EQ(main_label(grown, floor, scan.size()).first, 1);
  EXPECT_GT(main_label(grown, floor, scan.size()).second, 0.9);
}

TEST(GrowPlanes, DoNotDependOnThreads) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 0, 2.5}}, 9000, 0.003, 1);
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 5, 0.3}}, 9000, 0.003, 2);
  add_patch(scan, {{0, 0, 0}, {0.1, 5, 0}, {0, 0, 2.5}}, 3000, 0.003, 3);
  RandomStream random(4);
  for (int i = 0; i < 20000; ++i)
    scan.points.push_back(uniform_vector(Vector3d(0, 0, 0), Vector3d(4, 5, 2.5), random));
  set_thread_count(1);
  const GrownPlanes one = grow_planes(scan);
  set_thread_count(2);
  const GrownPlanes two = grow_planes(scan);
  set_thread_count(0);
  ASSERT_GE(one.planes.fits.size(), 3U);
  EXPECT_EQ(one.planes.labels, two.planes.labels);
  ASSERT_EQ(one.planes.fits.size(), two.planes.fits.size());
  for (std::size_t k = 0; k < one.planes.fits.size(); ++k) {
    EXPECT_EQ(one.planes.fits[k].plane.normal, two.planes.fits[k].plane.normal);
    EXPECT_EQ(one.planes.fits[k].plane.offset, two.planes.fits[k].plane.offset);
  }
}

TEST(GrowPlanes, KeepTheirDigitsFarFromTheOrigin) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 1, 2.5}}, 2000, 0.003, 1);
  const GrownPlanes near = grow_planes(scan);
  const Vector3d shift(1051200.0, 6841900.0, 140.0);
  for (Vector3d& x : scan.points) x += shift;
  const GrownPlanes far = grow_planes(scan);
  ASSERT_EQ(near.planes.fits.size(), 1U);
  ASSERT_EQ(far.planes.fits.size(), 1U);
  EXPECT_NEAR(std::abs(near.planes.fits[0].plane.normal.dot(far.planes.fits[0].plane.normal)), 1.0, 1e-9);
  EXPECT_LT((far.planes.fits[0].centroid - shift - near.planes.fits[0].centroid).norm(), 1e-6);
  const Vector3d on_it = near.planes.fits[0].centroid + shift;
  EXPECT_NEAR(far.planes.fits[0].plane.signed_distance(on_it), 0.0, 1e-6);
  EXPECT_NEAR(far.planes.fits[0].rms_m, near.planes.fits[0].rms_m, 1e-7);
}

TEST(GrowPlanes, StraysAMillionMetresAwayDoNoHarm) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {4, 0, 0}, {0, 0, 2.5}}, 1500, 0.003, 1);
  const std::size_t wall = scan.size();
  scan.points.emplace_back(1e6, -1e6, 1e6);
  scan.points.emplace_back(-1e6, 1e6, 0.0);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 1U);
  EXPECT_GT(main_label(grown, 0, wall).second, 0.97);
  EXPECT_EQ(grown.planes.labels[wall], -1);
}

TEST(GrowPlanes, OfDegenerateCloudsAreNone) {
  Scan scan;
  EXPECT_TRUE(grow_planes(scan).planes.labels.empty());
  for (const std::size_t count : {1U, 2U, 3U}) {
    scan.points.assign(count, Vector3d(1, 2, 3));
    const GrownPlanes grown = grow_planes(scan);
    EXPECT_TRUE(grown.planes.fits.empty());
    EXPECT_EQ(grown.planes.labels, std::vector<std::int32_t>(count, -1));
  }
  scan.points.assign(5000, Vector3d(1, 2, 3));
  EXPECT_TRUE(grow_planes(scan).planes.fits.empty());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const auto t = static_cast<double>(i);
    scan.points[i] = Vector3d(1e-3 * t, 2e-3 * t, -1e-3 * t);
  }
  EXPECT_TRUE(grow_planes(scan).planes.fits.empty()) << "points on a line";
  RandomStream random(1);
  for (Vector3d& x : scan.points) x = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  EXPECT_TRUE(grow_planes(scan).planes.fits.empty()) << "points anywhere in a cube";
}

TEST(GrowPlanes, OfAFlatCloudIsOne) {
  Scan scan;
  add_patch(scan, {{0, 0, 0}, {2, 1, 0}, {-0.3, 0, 2.5}}, 1000, 0.0, 1);
  const GrownPlanes grown = grow_planes(scan);
  ASSERT_EQ(grown.planes.fits.size(), 1U);
  EXPECT_LT(grown.planes.fits[0].rms_m, 1e-9);
  EXPECT_EQ(std::set<std::int32_t>(grown.planes.labels.begin(), grown.planes.labels.end()),
            std::set<std::int32_t>{0});
}

TEST(GrowPlanes, CheckTheirOptions) {
  const Scan scan;
  EXPECT_THROW(grow_planes(scan, {.inlier_threshold_m = -1.0}), Error);
  EXPECT_THROW(grow_planes(scan, {.inlier_threshold_m = std::nan("")}), Error);
  EXPECT_THROW(grow_planes(scan, {.min_inliers = 2}), Error);
  EXPECT_THROW(grow_planes(scan, {.finest_cell_m = 0.0}), Error);
  EXPECT_THROW(grow_planes(scan, {.coarsest_cell_m = 0.01}), Error);
}

}  // namespace
}  // namespace limen
