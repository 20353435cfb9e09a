// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/register.h"

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/simulate/scene.h"

namespace limen {
namespace {

struct RegisteredPair {
  Scan source;
  Scan target;
  Rigid3 truth;  // target from source, world
};

RegisteredPair simulated_pair(const SceneOptions& options, std::size_t source, std::size_t target) {
  SimulatedCase simulated = simulate(options);
  return {simulated.scans.at(source), simulated.scans.at(target),
          true_target_from_source(simulated.truth, source, target)};
}

SceneOptions small(const std::string& name, std::uint64_t seed) {
  SceneOptions options;
  options.name = name;
  options.seed = seed;
  options.points_indoor = 60000;
  options.points_outdoor = 200000;
  return options;
}

Rigid3 any_pose(std::uint64_t trial) {
  RandomStream stream(99, trial);
  return {uniform_rotation(stream), {stream.uniform(-9, 9), stream.uniform(-9, 9), stream.uniform(-9, 9)}};
}

/// The pair with its source moved; the truth follows.
RegisteredPair moved(RegisteredPair pair, const Rigid3& pose) {
  for (Vector3d& x : pair.source.points) x = pose * x;
  for (Vector3d& x : pair.source.centres) x = pose * x;
  pair.truth = pair.truth * inverse(pose);
  return pair;
}

double turn_deg(const Rigid3& truth, const Hypothesis& found) {
  return degrees(rotation_angle(truth.rotation.transpose() * found.target_from_source.rotation));
}

/// How far apart two poses put the scanner of the source.
double shift_m(const RegisteredPair& pair, const Hypothesis& found) {
  const Vector3d centre = pair.source.centre(0) + pair.source.local_origin;
  return (pair.truth * centre - found.target_from_source * centre).norm();
}

RegisterOptions any_orientation() {
  RegisterOptions options;
  options.gravity = Gravity::unknown;
  return options;
}

TEST(Register, OneRoomFromAnyOrientation) {
  const RegisteredPair still = simulated_pair(small("room", 3), 0, 1);
  for (std::uint64_t trial = 0; trial < 4; ++trial) {
    const RegisteredPair pair = moved(still, any_pose(trial));
    const RegistrationResult result = register_scans(pair.source, pair.target, any_orientation());
    ASSERT_EQ(result.outcome, Outcome::registered) << result.reason;
    EXPECT_LT(turn_deg(pair.truth, result.best), 0.02);
    EXPECT_LT(shift_m(pair, result.best), 0.001);
  }
}

TEST(Register, SymmetricRoomIsAmbiguousWithTheTruthAmongTheCandidates) {
  const RegisteredPair pair = moved(simulated_pair(small("symmetric_room", 2), 0, 1), any_pose(7));
  const RegistrationResult result = register_scans(pair.source, pair.target, any_orientation());
  ASSERT_EQ(result.outcome, Outcome::ambiguous) << result.reason;
  std::vector<Hypothesis> candidates = result.alternatives;
  candidates.push_back(result.best);
  bool listed = false;
  for (const Hypothesis& candidate : candidates) {
    listed = listed || (turn_deg(pair.truth, candidate) < 0.1 && shift_m(pair, candidate) < 0.01);
  }
  EXPECT_TRUE(listed);
}

TEST(Register, RoomsOfDifferentBuildingsDoNotMatch) {
  RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  const RegisteredPair other = simulated_pair(small("room", 8), 0, 1);
  const RegistrationResult result = register_scans(pair.source, other.target, any_orientation());
  EXPECT_EQ(result.outcome, Outcome::no_match) << result.reason;
}

TEST(Register, SameResultForAnyThreadCount) {
  const RegisteredPair pair = moved(simulated_pair(small("room", 5), 0, 1), any_pose(1));
  set_thread_count(1);
  const RegistrationResult one = register_scans(pair.source, pair.target, any_orientation());
  set_thread_count(3);
  const RegistrationResult three = register_scans(pair.source, pair.target, any_orientation());
  set_thread_count(0);
  EXPECT_EQ(one.best.target_from_source.rotation, three.best.target_from_source.rotation);
  EXPECT_EQ(one.best.target_from_source.translation, three.best.target_from_source.translation);
  EXPECT_EQ(one.best.score, three.best.score);
  EXPECT_EQ(one.alternatives.size(), three.alternatives.size());
}

TEST(Register, NationalGridLosesNoMillimetre) {
  RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  const RegistrationResult near = register_scans(pair.source, pair.target);
  // The target's points keep their values; its origin moves to the national grid.
  const Vector3d grid(1050000, 6840000, 150);
  pair.target.local_origin += grid;
  const RegistrationResult far = register_scans(pair.source, pair.target);
  ASSERT_EQ(far.outcome, near.outcome);
  EXPECT_LT(
      (far.best.target_from_source.translation - near.best.target_from_source.translation - grid).norm(),
      1e-8);
}

TEST(Register, PointsFarFromTheirOriginAreRecentred) {
  RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  const Vector3d grid(1050000, 6840000, 150);
  for (Vector3d& x : pair.target.points) x += grid;
  for (Vector3d& x : pair.target.centres) x += grid;
  pair.truth.translation += grid;
  const RegistrationResult result = register_scans(pair.source, pair.target);
  ASSERT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_LT(shift_m(pair, result.best), 0.001);
}

TEST(Register, WithoutOpticalCentresTheyAreEstimated) {
  RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  const Vector3d centre = pair.source.centre(0);
  pair.source.centres.clear();
  pair.target.centres.clear();
  const RegistrationResult result = register_scans(pair.source, pair.target);
  pair.source.centres = {centre};
  ASSERT_EQ(result.outcome, Outcome::registered) << result.reason;
  EXPECT_LT(shift_m(pair, result.best), 0.002);
}

TEST(Register, SidesThatAreReadAndGivenUpAreRegisteredAsAnyOthers) {
  const RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  const auto side_of = [](const Scan& scan) {
    RegisterInput input;
    input.scans.push_back({scan, {}});
    return input;
  };
  RegisterOptions options;
  options.picture = true;
  const RegistrationResult kept = register_inputs(side_of(pair.source), side_of(pair.target), options);
  int read = 0;
  const auto reader = [&](const Scan& scan) {
    return InputReader([&] {
      ++read;
      return side_of(scan);
    });
  };
  const RegistrationResult given = register_inputs(reader(pair.source), reader(pair.target), options);
  EXPECT_EQ(read, 2);
  EXPECT_EQ(kept.outcome, given.outcome);
  EXPECT_EQ(to_matrix(kept.best.target_from_source), to_matrix(given.best.target_from_source));
  EXPECT_EQ(given.stages.front().name, std::string("reading"));
  EXPECT_EQ(kept.picture->source.features.planes.size(), given.picture->source.features.planes.size());
}

TEST(Register, CancelledWorkThrows) {
  const RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  Monitor monitor;
  monitor.cancel();
  EXPECT_THROW(register_scans(pair.source, pair.target, {}, monitor), Error);
}

TEST(Register, TooLittleInCommonIsNoMatch) {
  RegisteredPair pair = simulated_pair(small("room", 3), 0, 1);
  pair.source.points.resize(40);
  const RegistrationResult result = register_scans(pair.source, pair.target);
  EXPECT_EQ(result.outcome, Outcome::no_match);
  EXPECT_FALSE(result.reason.empty());
}

}  // namespace
}  // namespace limen
