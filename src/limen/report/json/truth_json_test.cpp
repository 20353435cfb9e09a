// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/truth_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limen/simulate/scene.h"

namespace limen {
namespace {

using TruthJson = nlohmann::json;

SimulatedCase museum() {
  SceneOptions options;
  options.name = "museum";
  options.points_indoor = 6000;
  options.points_outdoor = 12000;
  return simulate(options);
}

Matrix4d matrix_of(const TruthJson& rows) {
  Matrix4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      matrix(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j)).get<double>();
  return matrix;
}

TEST(TruthJson, GivesBackEveryPoseBitForBit) {
  const SimulatedCase made = museum();
  const TruthJson truth = TruthJson::parse(truth_json(made.truth));
  ASSERT_EQ(truth["scans"].size(), made.scans.size());
  for (std::size_t i = 0; i < made.scans.size(); ++i) {
    EXPECT_EQ(truth["scans"][i]["file"], made.scans[i].name + ".ply");
    EXPECT_EQ(truth["scans"][i]["points"], made.scans[i].size());
    EXPECT_EQ(matrix_of(truth["scans"][i]["world_from_scan"]), to_matrix(world_from_scan(made.truth, i)));
  }
  ASSERT_EQ(truth["pairs"].size(), made.scans.size() * (made.scans.size() - 1));
  EXPECT_EQ(matrix_of(truth["pairs"][0]["target_from_source"]),
            to_matrix(true_target_from_source(made.truth, 0, 1)));
}

TEST(TruthJson, PlanesAndOpeningsAgreeInTheWorld) {
  const SimulatedCase made = museum();
  const TruthJson truth = TruthJson::parse(truth_json(made.truth));
  ASSERT_EQ(truth["planes"].size(), made.truth.planes.size());
  ASSERT_EQ(truth["openings"].size(), made.truth.openings.size());
  for (const TruthJson& plane : truth["planes"]) {
    double shift = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      shift += plane["normal"][k].get<double>() * truth["local_origin"][k].get<double>();
    EXPECT_NEAR(plane["offset"].get<double>(), plane["local_offset"].get<double>() + shift, 1e-8);
  }
  for (const TruthJson& opening : truth["openings"]) {
    double thickness = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      thickness += opening["normal"][k].get<double>() *
                   (opening["outer"][1][k].get<double>() - opening["inner"][1][k].get<double>());
    EXPECT_NEAR(thickness, opening["thickness_m"].get<double>(), 1e-7);
    for (const TruthJson& sight : opening["seen"]) EXPECT_LE(sight["through"], sight["crossed"]);
  }
}

TEST(TruthJson, TellsTheOutlineOfArchedWindows) {
  TrueOpening arched;
  arched.kind = "window";
  arched.head = "semicircle";
  arched.outer_outline = {Vector3d(1.0, 2.0, 3.0), Vector3d(2.0, 2.0, 3.0), Vector3d(1.5, 2.0, 4.0)};
  arched.inner_outline = {Vector3d(1.0, 2.5, 3.0), Vector3d(2.0, 2.5, 3.0), Vector3d(1.5, 2.5, 4.0)};
  Truth truth;
  truth.local_origin = Vector3d(100.0, 0.0, 0.0);
  truth.openings = {arched, TrueOpening{}};
  const TruthJson openings = TruthJson::parse(truth_json(truth))["openings"];
  EXPECT_EQ(openings[0]["head"], "semicircle");
  EXPECT_EQ(openings[0]["outer_outline"],
            (TruthJson{{101.0, 2.0, 3.0}, {102.0, 2.0, 3.0}, {101.5, 2.0, 4.0}}));
  EXPECT_EQ(openings[0]["inner_outline"][2], (TruthJson{101.5, 2.5, 4.0}));
  EXPECT_EQ(openings[1]["head"], "rectangular");
  EXPECT_FALSE(openings[1].contains("outer_outline"));
}

TEST(TruthJson, TellsOfAScannedModel) {
  SimulatedCase made;
  made.truth.local_origin = Vector3d(1000.0, 2000.0, 30.0);
  made.scans.resize(1);
  made.scans[0].name = "scan_01";
  made.truth.scans.push_back({.name = "scan_01",
                              .local_from_scan = {Matrix3d::Identity(), Vector3d(1.5, 2.5, 3.5)},
                              .plane_of_point = {}});
  made.truth.model =
      ModelTruth{.file = "house.ifc", .as_built = true, .changes = {}, .rooms = {}, .furniture = 3};
  made.truth.model->rooms.push_back({.space = 4, .guid = "g", .name = "12 Office", .like = {5, 7}});
  made.truth.model->changes.push_back({.element = 8,
                                       .guid = "w",
                                       .kind = "wall",
                                       .state = ModelState::moved,
                                       .shift_m = Vector3d(0.01, 0.0, 0.0)});
  made.truth.model->changes.push_back({.element = 9, .guid = "d", .kind = "door", .state = ModelState::open});
  const TruthJson truth = TruthJson::parse(truth_json(made.truth));
  EXPECT_EQ(matrix_of(truth["scans"][0]["target_from_source"]).col(3),
            Eigen::Vector4d(1001.5, 2002.5, 33.5, 1.0));
  EXPECT_EQ(truth["model"]["file"], "house.ifc");
  EXPECT_EQ(truth["model"]["rooms"][0]["repeated"], true);
  EXPECT_EQ(truth["model"]["rooms"][0]["like"], TruthJson({5, 7}));
  EXPECT_EQ(truth["model"]["changes"][0]["shift_m"][0], 0.01);
  EXPECT_EQ(truth["model"]["changes"][1]["state"], "open");
  EXPECT_EQ(TruthJson::parse(task_json(made))["target"], "house.ifc");
}

TEST(TaskJson, NamesFilesButNoTruth) {
  const SimulatedCase made = museum();
  const std::string text = task_json(made);
  const TruthJson task = TruthJson::parse(text);
  EXPECT_EQ(task["source"], "indoor_00.ply");
  EXPECT_EQ(task["target"], "outdoor.ply");
  EXPECT_EQ(task["scans"].size(), 3U);
  for (const char* secret : {"from", "pose", "seed", "planes", "openings", "room"})
    EXPECT_EQ(text.find(secret), std::string::npos) << secret;
}

}  // namespace
}  // namespace limen
