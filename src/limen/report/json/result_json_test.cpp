// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/result_json.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "limen/report/json/json_values.h"

namespace limen {
namespace {

Rigid3 grid_pose() {
  return {rotation_exp(Vector3d(0.3, -1.1, 2.0)), Vector3d(1050012.1234567891, 6840987.9876543210, 151.5)};
}

RegistrationReport some_report() {
  RegistrationReport report;
  report.result.outcome = Outcome::registered;
  report.result.reason = "one pose stands out";
  report.result.best.target_from_source = grid_pose();
  report.result.best.matched_planes = 7;
  report.result.sigma.rotation_rad = Vector3d(1e-5, 2e-5, 3e-5);
  report.result.alternatives.resize(2);
  report.result.matches = {{3, 5, -0.001, 0.002, 12.5}};
  report.result.moved = {{4, 6, 0.03, 0.002, 8.5}};
  report.result.stages = {{"planes", 0.5}, {"matching", 0.25}, {"planes", 0.125}};
  report.source.path = "a \"quoted\" name.ply";
  report.options = {{"method", std::string("auto")}, {"max_distance_m", 0.1}, {"tries", std::int64_t{3}}};
  report.seed = 18446744073709551615ULL;
  return report;
}

TEST(ResultJson, HoldsTheContract) {
  const Json json = Json::parse(result_json(some_report()));
  for (const char* key : {"outcome", "reason", "target_from_source", "sigma", "unobserved", "alternatives",
                          "stages", "inputs", "options", "version", "seed", "matches"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["outcome"], "registered");
  EXPECT_EQ(json["seed"], 18446744073709551615ULL);
  EXPECT_EQ(json["alternatives"].size(), 2U);
  EXPECT_EQ(json["matches"][0]["target_plane"], 5);
  EXPECT_EQ(json["moved_planes"][0]["distance_m"], 0.03);
  EXPECT_EQ(json["options"]["max_distance_m"], 0.1);
  EXPECT_EQ(json["inputs"]["source"]["path"], "a \"quoted\" name.ply");
}

TEST(ResultJson, TellsTheCovarianceOfEveryPose) {
  RegistrationReport report = some_report();
  report.result.sigma.covariance(0, 5) = 1e-9;
  report.result.alternatives[1].sigma.covariance(3, 3) = 4e-6;
  report.result.alternatives[1].probability = 0.25;
  report.result.others = OtherExplanations{0.125, 0.5, 0.0};
  const Json json = Json::parse(result_json(report));
  EXPECT_EQ(json["sigma"]["covariance"].size(), 6U);
  EXPECT_EQ(json["sigma"]["covariance"][0][5], 1e-9);
  EXPECT_EQ(json["alternatives"][1]["sigma"]["covariance"][3][3], 4e-6);
  EXPECT_EQ(json["alternatives"][1]["probability"], 0.25);
  EXPECT_EQ(json["probability_of_nothing_shared"], 0.125);
  EXPECT_EQ(json["probability_of_twin"], 0.5);
  EXPECT_TRUE(json["probability"].is_null());
}

TEST(ResultJson, KeepsEveryDigit) {
  const Json json = Json::parse(result_json(some_report()));
  const Matrix4d expected = to_matrix(grid_pose());
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      EXPECT_EQ(json["target_from_source"][i][j].get<double>(),
                expected(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  }
}

TEST(ResultJson, OnlyTheStagesVary) {
  RegistrationReport report = some_report();
  Json first = Json::parse(result_json(report));
  EXPECT_EQ(first["stages"]["planes"], 0.625);
  report.result.stages[0].seconds = 9.0;
  Json second = Json::parse(result_json(report));
  EXPECT_NE(first, second);
  first.erase("stages");
  second.erase("stages");
  EXPECT_EQ(first.dump(), second.dump());
}

TEST(ResultJson, NoMatchHasNoPose) {
  RegistrationReport report = some_report();
  report.result.outcome = Outcome::no_match;
  const Json json = Json::parse(result_json(report));
  EXPECT_TRUE(json["target_from_source"].is_null());
  EXPECT_TRUE(json["sigma"].is_null());
}

TEST(ResultJson, TransformTextGivesBackTheBits) {
  const std::string text = transform_text(grid_pose());
  std::istringstream stream(text);
  const Matrix4d expected = to_matrix(grid_pose());
  for (Eigen::Index k = 0; k < 16; ++k) {
    double number = 0.0;
    ASSERT_TRUE(stream >> number);
    EXPECT_EQ(number, expected(k / 4, k % 4));
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
  EXPECT_EQ(transform_text({Matrix3d::Identity(), Vector3d(-0.0, 0, 0)}).find("-0"), std::string::npos);
}

TEST(JsonText, SurvivesTheWayThereAndBack) {
  const double infinite = std::numeric_limits<double>::infinity();
  const Json json = {{"empty", Json::array()},
                     {"nested", {{"rows", Json::array({Json::array({1, 2.5}), Json::array({true, "x\n"})})}}},
                     {"none", Json()},
                     {"object", Json::object()}};
  EXPECT_EQ(Json::parse(to_text(json)), json);
  EXPECT_EQ(to_text(json_of(Vector3d(1.5, infinite, -2))), "[1.5, null, -2.0]\n");
}

TEST(InputSummary, LiesInTheWorldAndIgnoresStrays) {
  Scan scan;
  scan.local_origin = Vector3d(1e6, 6e6, 100);
  for (int i = 0; i <= 100; ++i) scan.points.emplace_back(0.02 * i, 0.04 * i, 0.06 * i);
  scan.points.emplace_back(500, 0, 0);
  scan.centres = {Vector3d::Zero()};
  const InputSummary summary = summarise("scan.ply", scan);
  EXPECT_NEAR((summary.middle - Vector3d(1000001, 6000002, 103)).norm(), 0.0, 0.1);
  EXPECT_EQ(summary.high, Vector3d(1000500, 6000004, 106));
  EXPECT_EQ(summary.points, 102U);
  EXPECT_TRUE(summary.centre_known);
  EXPECT_FALSE(summary.mobile);
}

}  // namespace
}  // namespace limen
