// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/passes/bent_passes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/spline_motion.h"

namespace limen {
namespace {

constexpr double kTileNoiseM = 0.002;
constexpr int kTilesSeen = 8;
constexpr double kKnotM = 5.0;
constexpr std::size_t kFine = 8;

/// A straight street, 120 m long: facades on both sides, the ground, and now and then a wall across. A
/// station has measured it all; a pass drives through, and drifts.
class DriftingStreet {
 public:
  /// `drift`: kFine steps from knot to knot.
  DriftingStreet(std::vector<Vector6d> drift, std::uint64_t seed) : drift_(std::move(drift)), random_(seed) {
    const int knots = static_cast<int>(drift_.size() / kFine) + 1;
    for (int k = 0; k < knots; ++k) {
      way_.times_s.push_back(100.0 + k);
      way_.distances_m.push_back(kKnotM * k);
      way_.places.emplace_back(kKnotM * k - 0.5 * kKnotM * (knots - 1), 0.0, 2.0);
    }
  }

  [[nodiscard]] const PassWay& way() const { return way_; }

  /// By what the points of the pass have to be moved, at a place along the way.
  [[nodiscard]] Vector6d drift_at(double place) const {
    const auto step = std::min(drift_.size() - 2, static_cast<std::size_t>(kFine * place));
    const double share = kFine * place - static_cast<double>(step);
    return (1.0 - share) * drift_[step] + share * drift_[step + 1];
  }

  /// The street as a station (node 0) and the pass (node 1) have it; the same for every call. One of them
  /// gives the frame.
  JointProblem problem(BentPasses& passes, bool frame_of_pass = false) const {
    JointProblem made;
    made.frame_from_node.resize(2);
    made.fixed = {!frame_of_pass, frame_of_pass};
    passes.add_to(made);
    RandomStream random = random_;
    for (int patch = 0; patch < 12; ++patch) {
      const double x = 10.0 * patch - 55.0;
      add_plane(made, passes, {x, 9.0, 4.0}, Vector3d::UnitX(), Vector3d::UnitZ(), random);
      add_plane(made, passes, {x, -8.0, 4.0}, Vector3d::UnitX(), Vector3d::UnitZ(), random);
      add_plane(made, passes, {x, 0.0, 0.0}, Vector3d::UnitX(), Vector3d::UnitY(), random);
      if (patch % 3 == 1)
        add_plane(made, passes, {x, 7.0, 3.0}, Vector3d::UnitY(), Vector3d::UnitZ(), random);
    }
    return made;
  }

  /// Adjusted until the rates of drift settle.
  [[nodiscard]] BentPass bent(bool believed_to_drift = true) const {
    BentPasses passes({{1, &way_, believed_to_drift ? 0.008 : 0.0}});
    for (int round = 0; round < 12; ++round) {
      const JointProblem made = problem(passes);
      if (passes.take(made, adjust_jointly(made)) < 1.05) break;
    }
    return passes.stated(adjust_jointly(problem(passes))).front();
  }

 private:
  PlaneObservation seen(const Vector3d& middle, const Vector3d& u, const Vector3d& v, double half_u,
                        const Vector6d& drift, RandomStream& random) const {
    PlaneObservation observation;
    observation.anchor = middle;
    observation.sigma_m = kTileNoiseM;
    observation.most_points = kTilesSeen;
    for (int k = 0; k < kTilesSeen; ++k) {
      const double off = kTileNoiseM * random.normal();
      const Vector2d in = uniform_vector(Vector2d(-half_u, -2.0), Vector2d(half_u, 2.0), random);
      const Vector3d point = middle + in.x() * u + in.y() * v + off * u.cross(v);
      const Vector3d given = rotation_exp(drift.head<3>()).transpose() * (point - drift.tail<3>());
      observation.moments.add(given - observation.anchor);
    }
    return observation;
  }

  /// A plane that the station sees as a whole, and the pass in strips as it drives past.
  void add_plane(JointProblem& made, BentPasses& passes, const Vector3d& middle, const Vector3d& u,
                 const Vector3d& v, RandomStream& random) const {
    PlaneObservation whole = seen(middle, u, v, 5.0, Vector6d::Zero(), random);
    whole.node = 0;
    whole.plane = made.planes;
    made.observations.push_back(whole);
    const double unfollowed = passes.unfollowed_m(1);
    for (int part = 0; part < 4; ++part) {
      const Vector3d there = middle + (2.5 * part - 3.75) * u * std::abs(u.x());
      const double along = std::clamp(there.x() + (std::abs(u.x()) > 0.5 ? 0.0 : 2.5 * part - 3.75),
                                      way_.places.front().x(), way_.places.back().x());
      const double place = (along - way_.places.front().x()) / kKnotM;
      PlaneObservation strip = seen(there, u, v, 1.25, drift_at(place), random);
      strip.node = passes.node_at(made, 1, {place});
      strip.sigma_m = std::hypot(kTileNoiseM, unfollowed * std::sqrt(double{kTilesSeen}));
      strip.plane = made.planes;
      made.observations.push_back(strip);
    }
    ++made.planes;
  }

  std::vector<Vector6d> drift_;
  RandomStream random_;
  PassWay way_;
};

constexpr std::size_t kStreetKnots = 25;
constexpr std::size_t kSteps = kFine * (kStreetKnots - 1) + 1;

/// So much from knot to knot, in the mean square.
std::vector<Vector6d> random_walk(double shift_m, double turn_rad, std::uint64_t seed) {
  RandomStream random(seed, 9);
  std::vector<Vector6d> drift{Vector6d::Zero()};
  while (drift.size() < kSteps) {
    Vector6d step;
    for (Eigen::Index k = 0; k < 6; ++k)
      step[k] = (k < 3 ? turn_rad : shift_m) / std::sqrt(double{kFine}) * random.normal();
    // The walk is that of the vehicle.
    const double along = (static_cast<double>(drift.size()) - 0.5) / double{kFine};
    const Vector3d vehicle(kKnotM * (along - 0.5 * (kStreetKnots - 1)), 0.0, 2.0);
    step.tail<3>() -= step.head<3>().cross(vehicle);
    drift.emplace_back(drift.back() + step);
  }
  return drift;
}

/// By what a knot's own place moves, less what the pass moves by as a whole.
Vector3d moved_at(const PassWay& way, const Vector6d& value, std::size_t knot) {
  return value.tail<3>() + value.head<3>().cross(way.places[knot]);
}

TEST(BentPasses, APassWithoutDriftStaysStraight) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DriftingStreet street(std::vector<Vector6d>(kSteps, Vector6d::Zero()), seed);
    const BentPass pass = street.bent();
    ASSERT_EQ(pass.knots.size(), kStreetKnots);
    double along = 0.0;
    double across = 0.0;
    for (std::size_t k = 0; k < kStreetKnots; ++k) {
      const Vector3d moved = moved_at(street.way(), pass.knots[k].value, k);
      along += moved.x() * moved.x() / kStreetKnots;
      across += moved.tail<2>().squaredNorm() / kStreetKnots;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double sigma = std::sqrt(pass.knots[k].covariance(3 + axis, 3 + axis));
        EXPECT_LT(std::abs(moved[axis]), 3.5 * sigma) << seed << " " << k << " " << axis;
      }
    }
    EXPECT_LT(std::sqrt(across), 0.0012) << seed;
    // Four walls across the street are all that holds it along the street.
    EXPECT_LT(std::sqrt(along), 0.002) << seed;
  }
}

TEST(BentPasses, AKnownCurveIsBentBack) {
  std::vector<Vector6d> drift;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double phase = 2.0 * M_PI * static_cast<double>(k) / (kSteps - 1);
    Vector6d at = Vector6d::Zero();
    at.head<3>() = Vector3d(2e-4 * std::sin(phase), 0.0, 3e-4 * std::cos(phase));
    at.tail<3>() = Vector3d(0.02 * std::sin(phase), 0.015 * std::cos(2.0 * phase), -0.01 * std::sin(phase));
    drift.push_back(at);
  }
  const DriftingStreet street(drift, 3);
  const BentPass pass = street.bent();
  double across = 0.0;
  for (std::size_t k = 0; k < kStreetKnots; ++k) {
    // What the whole pass was moved by counts as well.
    const Vector6d wanted = street.drift_at(static_cast<double>(k));
    const Vector3d place = street.way().places[k];
    const Vector3d expected = place + wanted.tail<3>() + wanted.head<3>().cross(place);
    const Vector3d whole = pass.frame_from_node * place;
    const Vector3d found = whole + moved_at(street.way(), pass.knots[k].value, k);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double sigma = std::sqrt(pass.knots[k].covariance(3 + axis, 3 + axis));
      EXPECT_LT(std::abs(found[axis] - expected[axis]), 4.0 * sigma + 5e-4) << k << " " << axis;
    }
    across += (found - expected).tail<2>().squaredNorm() / kStreetKnots;
  }
  EXPECT_LT(std::sqrt(across), 0.002);
}

TEST(BentPasses, WhatIsStatedOfTheirAccuracyHolds) {
  int all = 0;
  int within_one = 0;
  int within_two = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Vector6d> drift = random_walk(0.004, 1e-4, seed);
    const DriftingStreet street(drift, seed);
    const BentPass pass = street.bent();
    Vector6d mean = Vector6d::Zero();
    for (std::size_t k = 0; k < kStreetKnots; ++k) mean += drift[kFine * k] / double{kStreetKnots};
    for (std::size_t k = 0; k < kStreetKnots; ++k) {
      const Vector6d wanted = street.drift_at(static_cast<double>(k)) - mean;
      const Vector3d missed = moved_at(street.way(), pass.knots[k].value - wanted, k);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double sigma = std::sqrt(pass.knots[k].covariance(3 + axis, 3 + axis));
        ++all;
        within_one += std::abs(missed[axis]) < sigma ? 1 : 0;
        within_two += std::abs(missed[axis]) < 2.0 * sigma ? 1 : 0;
      }
    }
  }
  EXPECT_GT(within_two, 0.90 * all);
  EXPECT_LT(within_two, 0.98 * all);
  EXPECT_GT(within_one, 0.60 * all);
  EXPECT_LT(within_one, 0.76 * all);
}

TEST(BentPasses, TheRateOfDriftIsFound) {
  double shifts = 0.0;
  double turns = 0.0;
  constexpr int kSeeds = 10;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const DriftingStreet street(random_walk(0.004, 1e-4, seed), seed);
    const BentPass pass = street.bent(false);
    shifts += pass.shift_rate_m2_per_m / kSeeds;
    turns += pass.turn_rate_rad2_per_m / kSeeds;
  }
  // Steps of 5 m.
  EXPECT_NEAR(std::sqrt(5.0 * shifts), 0.004, 0.0008);
  EXPECT_NEAR(std::sqrt(5.0 * turns), 1e-4, 4e-5);
}

TEST(BentPasses, APassThatGivesTheFrameStaysWhereItWasAsAWhole) {
  const DriftingStreet street(random_walk(0.004, 0.0, 4), 4);
  BentPasses passes({{1, &street.way(), 0.008}});
  const JointProblem made = street.problem(passes, true);
  JointSolution solution = adjust_jointly(made);
  passes.settle_frames(made, {0, 0}, solution);
  EXPECT_LT((to_matrix(solution.frame_from_node[1]) - Matrix4d::Identity()).norm(), 1e-15);
  EXPECT_TRUE(solution.covariance[1].isZero());
  // The station moved instead, and the shape is the same as if it had been fixed.
  BentPasses fixed({{1, &street.way(), 0.008}});
  const JointProblem other = street.problem(fixed);
  const BentPass a = passes.stated(solution).front();
  const BentPass b = fixed.stated(adjust_jointly(other)).front();
  for (std::size_t k = 0; k < kStreetKnots; ++k) {
    EXPECT_LT((a.knots[k].value - b.knots[k].value).norm(), 2e-5) << k;
    EXPECT_NEAR(a.knots[k].covariance(3, 3), b.knots[k].covariance(3, 3), 0.01 * b.knots[k].covariance(3, 3));
  }
}

}  // namespace
}  // namespace limen
