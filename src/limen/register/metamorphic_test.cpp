// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// What must not change the answer of a registration. bench_metamorphic measures the same over more pairs.
#include <numeric>
#include <utility>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/register/register.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

/// Two stations of one room, and their registration as they were given.
struct Given {
  Scan source;
  Scan target;
  RegistrationResult result;
};

const Given& given() {
  static const Given made = [] {
    SceneOptions options;
    options.name = "room";
    options.points_indoor = 60000;
    options.as_built = true;
    SimulatedCase simulated = simulate(options);
    Given pair{simulated.scans.at(0), simulated.scans.at(1), {}};
    pair.result = register_scans(pair.source, pair.target);
    return pair;
  }();
  return made;
}

/// The largest of the six differences from the pose of the scan as given, in its standard deviations.
double apart_sigma(const Rigid3& target_from_source) {
  const RegistrationResult& result = given().result;
  const Rigid3 off = target_from_source * inverse(result.best.target_from_source);
  const Vector3d turn = rotation_log(off.rotation);
  const Vector3d shift = off * result.sigma.centre - result.sigma.centre;
  return std::max((turn.array() / result.sigma.rotation_rad.array()).abs().maxCoeff(),
                  (shift.array() / result.sigma.translation_m.array()).abs().maxCoeff());
}

Rigid3 any_motion(std::uint64_t trial) {
  RandomStream stream(21, trial);
  return {uniform_rotation(stream),
          {stream.uniform(-20, 20), stream.uniform(-20, 20), stream.uniform(-20, 20)}};
}

Scan in_another_order(const Scan& scan) {
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0U);
  RandomStream stream(22);
  for (auto i = static_cast<std::uint32_t>(order.size()); i > 1; --i)
    std::swap(order[i - 1], order[stream.below(i)]);
  return subset(scan, order);
}

TEST(Metamorphic, TheScanAsGivenRegisters) {
  EXPECT_EQ(given().result.outcome, Outcome::registered);
}

TEST(Metamorphic, AScanInAnotherOrderAndOfAnotherNameHasTheSamePoseToTheLastDigit) {
  Scan other = in_another_order(given().source);
  other.name = "another";
  const RegistrationResult result = register_scans(other, in_another_order(given().target));
  EXPECT_EQ(result.outcome, given().result.outcome);
  EXPECT_EQ(to_matrix(result.best.target_from_source), to_matrix(given().result.best.target_from_source));
}

TEST(Metamorphic, AScanThatLiesAnyWayRoundHasTheSamePose) {
  for (const Gravity gravity : {Gravity::automatic, Gravity::unknown}) {
    const Rigid3 motion = any_motion(gravity == Gravity::unknown ? 1 : 0);
    RegisterOptions options;
    options.gravity = gravity;
    const RegistrationResult result = register_scans(moved(given().source, motion), given().target, options);
    EXPECT_EQ(result.outcome, given().result.outcome);
    EXPECT_LT(apart_sigma(result.best.target_from_source * motion), 0.1);
  }
}

/// Half the points, or some that belong to nothing: another measurement of the same.
TEST(Metamorphic, AThinnedScanAndOneWithStrayPointsHaveTheSamePoseWithinTheirError) {
  RandomStream stream(23);
  std::vector<std::uint32_t> half;
  for (std::uint32_t i = 0; i < given().source.size(); ++i) {
    if (stream.uniform(0.0, 1.0) < 0.5) half.push_back(i);
  }
  Scan stray = given().source;
  const Extent extent = extent_of(stray.points);
  for (std::size_t i = 0; i < stray.size(); i += 100) {
    for (Eigen::Index k = 0; k < 3; ++k) stray.points[i][k] = stream.uniform(extent.low[k], extent.high[k]);
  }
  for (const Scan& other : {subset(given().source, half), stray}) {
    const RegistrationResult result = register_scans(other, given().target);
    EXPECT_EQ(result.outcome, given().result.outcome);
    EXPECT_LT(apart_sigma(result.best.target_from_source), 3.0);
  }
}

}  // namespace
}  // namespace limen
