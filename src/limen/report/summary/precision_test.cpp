// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/summary/precision.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/base/text.h"
#include "limen/geometry/random_vectors.h"
#include "limen/report/summary/words.h"

namespace limen {
namespace {

/// A room of 10 x 6 x 3 m on a national grid, turned by 0.1 rad about the vertical, held to 1 mm and 0.2
/// mrad.
RegistrationReport room_report() {
  RegistrationReport report;
  report.result.outcome = Outcome::registered;
  report.source.path = "scans/room.ply";
  report.source.low = Vector3d(0, 0, 0);
  report.source.high = Vector3d(60, 6, 3);  // an echo through a window
  report.source.inner_low = Vector3d(0, 0, 0);
  report.source.inner_high = Vector3d(10, 6, 3);
  report.source.middle = Vector3d(5, 3, 1.5);
  Hypothesis& best = report.result.best;
  best.target_from_source = {rotation_exp({0, 0, 0.1}), Vector3d(1050000, 6840000, 150)};
  best.sigma.centre = best.target_from_source * report.source.middle;
  best.sigma.covariance.diagonal() << 4e-8, 4e-8, 4e-8, 1e-6, 1e-6, 1e-6;
  best.sigma.formal_covariance = best.sigma.covariance / 16.0;
  report.result.sigma = best.sigma;
  return report;
}

/// Share of displacements of a covariance that are within a radius, by trial.
double share_within(const Matrix3d& covariance, double radius) {
  const Matrix3d root = covariance.llt().matrixL();
  RandomStream random(7);
  int within = 0;
  constexpr int kTrials = 40000;
  for (int k = 0; k < kTrials; ++k) {
    const Vector3d x = root * normal_vector(random);
    within += x.norm() <= radius ? 1 : 0;
  }
  return static_cast<double>(within) / kTrials;
}

TEST(Precision, RadiusHoldsNinetyFivePercentOfAnyGaussian) {
  for (const Vector3d& sigma : {Vector3d(1, 1, 1), Vector3d(5, 1, 0.1), Vector3d(1, 1, 0.001)}) {
    const Matrix3d covariance = sigma.cwiseAbs2().asDiagonal();
    EXPECT_NEAR(share_within(covariance, radius_95(covariance)), 0.95, 0.01) << sigma.transpose();
  }
  EXPECT_EQ(radius_95(Matrix3d::Zero()), 0.0);
}

/// Where the covariance is the true one times a scale that was estimated with few freedoms.
TEST(Precision, RadiusHoldsNinetyFivePercentWhereTheScaleIsKnownByFewFreedoms) {
  RandomStream random(11);
  for (const int known_by : {3, 5, 10}) {
    for (const Vector3d& sigma : {Vector3d(1, 1, 1), Vector3d(1, 0.5, 0.1)}) {
      constexpr int kTrials = 20000;
      int within = 0;
      for (int k = 0; k < kTrials; ++k) {
        double squares = 0.0;
        for (int j = 0; j < known_by; ++j) squares += std::pow(random.normal(), 2) / known_by;
        const Matrix3d estimated = squares * Matrix3d(sigma.cwiseAbs2().asDiagonal());
        const Vector3d off = sigma.cwiseProduct(normal_vector(random));
        within += off.norm() <= radius_95(estimated, known_by) ? 1 : 0;
      }
      EXPECT_NEAR(static_cast<double>(within) / kTrials, 0.95, 0.012)
          << known_by << ", " << sigma.transpose();
    }
  }
  EXPECT_EQ(freedoms_of(std::vector<PlaneMatch>(9, {0, 0, 0.0, 0.0, 2.0})), 6.0);
  EXPECT_EQ(freedoms_of(std::vector<PlaneMatch>(4, {0, 0, 0.0, 0.0, 2.0})), 3.0);
}

TEST(Precision, FarEndIsWhereTurnsMoveMost) {
  const RegistrationReport report = room_report();
  const auto precision = precision_of(report, report.result.best);
  ASSERT_TRUE(precision);
  EXPECT_NEAR(precision->middle.radius_m, 2.7955e-3, 3e-5);  // sqrt(chi-square of 3 freedoms) times 1 mm
  EXPECT_NEAR(precision->far_distance_m, Vector3d(5, 3, 1.5).norm(), 1e-6) << "not the echo's end";
  // A turn of 0.2 mrad about each axis moves a point r away by 0.2 mrad * r * sqrt(2) in all.
  const double trace = 3e-6 + 2.0 * 4e-8 * std::pow(precision->far_distance_m, 2);
  EXPECT_GT(precision->far_end.radius_m, 1.2 * precision->middle.radius_m);
  EXPECT_NEAR(precision->far_end.radius_m, std::sqrt(trace * 2.605), 0.1 * precision->far_end.radius_m);
  EXPECT_NEAR(*precision->middle.formal_radius_m, precision->middle.radius_m / 4.0, 1e-9);
  EXPECT_FALSE(precision->across_open);
}

TEST(Precision, IsStatedAcrossWhatIsOpenAndNotWhereATurnIs) {
  RegistrationReport report = room_report();
  report.result.best.sigma.covariance(3, 3) = 1e6;
  report.result.unobserved = {{false, Vector3d::UnitX(), "shift along x"}};
  const auto across = precision_of(report, report.result.best);
  ASSERT_TRUE(across);
  EXPECT_TRUE(across->across_open);
  EXPECT_LT(across->far_end.radius_m, 0.01);
  report.result.unobserved.push_back({true, Vector3d::UnitX(), "turn about x"});
  EXPECT_FALSE(precision_of(report, report.result.best));
  report.result.unobserved.clear();
  report.result.outcome = Outcome::no_match;
  EXPECT_FALSE(precision_of(report, report.result.best));
}

TEST(Precision, MotionIsOfTheMiddleAndItsDeviationToo) {
  RegistrationReport report = room_report();
  report.result.best.target_from_source.rotation = rotation_exp({0, 0, 1e-4});
  // A turn about a far origin makes a large translation of a scan that hardly moves.
  const Vector3d grid(1050000, 6840000, 150);
  report.source.middle += grid;
  const Rigid3& pose = report.result.best.target_from_source;
  report.result.best.target_from_source.translation =
      report.source.middle + Vector3d(0.003, 0, 0) - pose.rotation * report.source.middle;
  ASSERT_GT(report.result.best.target_from_source.translation.norm(), 100.0);
  const PoseMotion motion = motion_of(report, report.result.best);
  EXPECT_LT((motion.shift_m - Vector3d(0.003, 0, 0)).norm(), 1e-6);
  EXPECT_NEAR(motion.turn_rad, 1e-4, 1e-9);
  EXPECT_NEAR(motion.axis.z(), 1.0, 1e-6);
  report.result.best.sigma.centre = report.source.middle + Vector3d(10.003, 0, 0);
  const Vector3d sigma = shift_sigma_of(report, report.result.best);
  EXPECT_NEAR(sigma.x(), 1e-3, 1e-6);
  EXPECT_NEAR(sigma.y(), std::hypot(1e-3, 2e-3), 1e-6) << "ten metres from the centre a turn moves it 2 mm";
  EXPECT_TRUE(on_large_coordinates(report));
}

TEST(Precision, PlanesCountByTheirOverlap) {
  EXPECT_FALSE(plane_distance_rms({}));
  EXPECT_NEAR(*plane_distance_rms({{0, 0, 0.002, 0, 9.0}, {1, 1, -0.01, 0, 1.0}}),
              std::sqrt((9 * 4e-6 + 1e-4) / 10), 1e-12);
}

TEST(ReportWords, ProbabilitiesAreNeverACertainty) {
  EXPECT_EQ(probability_words(0.99996), "more than 99.99 %");
  EXPECT_EQ(probability_words(0.99987), "99.98 %");
  EXPECT_EQ(probability_words(0.9899), "98.9 %");
  EXPECT_EQ(probability_words(0.5), "50.0 %");
  EXPECT_EQ(probability_words(0.0003), "0.03 %");
  EXPECT_EQ(probability_words(0.0), "less than 0.01 %");
}

TEST(ReportWords, WordsForTheShellStayOneWord) {
  EXPECT_EQ(shell_word("a/b-1.ply"), "a/b-1.ply");
  EXPECT_EQ(shell_word("my scan.ply"), "'my scan.ply'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace limen
