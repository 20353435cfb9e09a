// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class SimulateModelTest : public ProgramTest {
 protected:
  [[nodiscard]] Json json_at(const std::string& file) const { return Json::parse(read_whole(work() / file)); }
};

Json pose_of(const Json& truth, std::size_t scan) {
  return truth["scans"][scan]["target_from_source"];
}

TEST_F(SimulateModelTest, OfficeGivesScansModelTruthAndKnownPoses) {
  const ProgramRun done = run({"simulate", "office", "-o", "case", "--stations", "3", "--as-built",
                               "--any-rotation", "--points-indoor", "20000", "--seed", "4", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json task = Json::parse(done.out);
  EXPECT_EQ(task["source"], "scan_01.ply");
  EXPECT_EQ(task["target"], "model.ifc");
  EXPECT_EQ(read_whole(work() / "case" / "model.ifc").substr(0, 13), "ISO-10303-21;");
  const Json truth = json_at("case/truth/truth.json");
  ASSERT_EQ(truth["scans"].size(), 3U);
  EXPECT_EQ(truth["model"]["file"], "model.ifc");
  EXPECT_TRUE(truth["model"]["as_built"]);
  EXPECT_FALSE(truth["model"]["changes"].empty());
  EXPECT_GT(truth["model"]["rooms"][0]["area_m2"].get<double>(), 5.0);
  for (int i = 1; i <= 3; ++i)
    EXPECT_TRUE(std::filesystem::exists(work() / "case" / ("scan_0" + std::to_string(i) + ".ply")));

  // The second station's pose in the first one's frame puts it where the truth has it in the model.
  std::istringstream text(read_whole(work() / "case" / "source_from_scan_02.txt"));
  double known[4][4];
  for (auto& row : known)
    for (double& number : row) ASSERT_TRUE(text >> number);
  const Json first = pose_of(truth, 0);
  const Json second = pose_of(truth, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    double place = first[i][3].get<double>();
    for (std::size_t k = 0; k < 3; ++k) place += first[i][k].get<double>() * known[k][3];
    EXPECT_NEAR(place, second[i][3].get<double>(), 1e-9);
  }
}

TEST_F(SimulateModelTest, TheSameSeedGivesTheSameBytesForAnyNumberOfThreads) {
  const std::vector<std::string> common = {"simulate", "office",          "--as-built", "--room",
                                           "unique",   "--points-indoor", "20000"};
  for (const char* threads : {"1", "3"}) {
    std::vector<std::string> arguments = common;
    arguments.insert(arguments.end(), {"--threads", threads, "-o", std::string("with") + threads});
    ASSERT_EQ(run(arguments).status, 0);
  }
  for (const char* file : {"scan_01.ply", "model.ifc", "truth/truth.json"})
    EXPECT_EQ(read_whole(work() / "with1" / file), read_whole(work() / "with3" / file)) << file;
  EXPECT_FALSE(json_at("with1/truth/truth.json")["model"]["rooms"][0]["repeated"]);
}

TEST_F(SimulateModelTest, EvaluateKnowsTheModelAsTarget) {
  ASSERT_EQ(run({"simulate", "office", "-o", "case", "--points-indoor", "5000"}).status, 0);
  Json result;
  result["outcome"] = "registered";
  result["target_from_source"] = pose_of(json_at("case/truth/truth.json"), 0);
  result["target_from_source"][0][3] = result["target_from_source"][0][3].get<double>() + 0.25;
  result["inputs"]["source"]["path"] = "case/scan_01.ply";
  result["inputs"]["target"]["path"] = "case/model.ifc";
  write_whole(work() / "result.json", result.dump());
  const ProgramRun done = run({"evaluate", "result.json", "case/truth/truth.json", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_NEAR(Json::parse(done.out)["translation_error_m"].get<double>(), 0.25, 1e-9);
}

TEST_F(SimulateModelTest, ModelFilesAreScannedToo) {
  // A hall of 6 x 5 x 3 m as a mesh of single triangles, seen from inside.
  write_whole(work() / "hall.obj",
              "o hall\nv 0 0 0\nv 6 0 0\nv 6 5 0\nv 0 5 0\nv 0 0 3\nv 6 0 3\nv 6 5 3\nv 0 5 3\n"
              "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n");
  const ProgramRun done =
      run({"simulate", "hall.obj", "-o", "case", "--points-indoor", "5000", "--seed", "2"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json truth = json_at("case/truth/truth.json");
  EXPECT_EQ(truth["model"]["file"], "hall.obj");
  const Json pose = pose_of(truth, 0);
  EXPECT_TRUE(pose[0][3] > 0.5 && pose[0][3] < 5.5 && pose[2][3] > 1.3 && pose[2][3] < 1.9);
  EXPECT_GT(truth["scans"][0]["points"].get<int>(), 4500);
}

TEST_F(SimulateModelTest, StationsAreE57WithAPanoramaAndTargetsAreSurveyed) {
  const ProgramRun done = run({"simulate", "office", "-o", "day", "--room", "doorways", "--stations", "2",
                               "--targets", "6", "--as", "e57", "--points-indoor", "20000", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(Json::parse(done.out)["source"], "scan_01.e57");
  EXPECT_EQ(json_at("day/truth/truth.json")["scans"][1]["file"], "scan_02.e57");
  EXPECT_NE(read_whole(work() / "day/scan_02.e57").find("\x89PNG"), std::string::npos);
  for (const char* file : {"day/control.csv", "day/truth/control.csv"}) {
    const std::string table = read_whole(work() / file);
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7) << file;
  }
  const ProgramRun scene = run({"simulate", "museum", "-o", "none", "--targets", "3"});
  EXPECT_EQ(scene.status, 2);
  EXPECT_NE(scene.err.find("--targets is for models and whole buildings"), std::string::npos) << scene.err;
}

TEST_F(SimulateModelTest, BadModelsAndWishesAreStatedAndLeaveNothing) {
  write_whole(work() / "wall.obj", "v 0 0 0\nv 5 0 0\nv 5 0 3\nv 0 0 3\nf 1 2 3 4\n");
  write_whole(work() / "broken.ifc", "ISO-10303-21;\nnonsense");
  for (const std::string model : {"wall.obj", "broken.ifc", "no_such_model.ifc"}) {
    const ProgramRun done = run({"simulate", model, "-o", "out"});
    EXPECT_EQ(done.status, 2) << done.err;
    EXPECT_NE(done.err.find("limen: error: "), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(work() / "out")) << model;
  }
  EXPECT_EQ(run({"simulate", "office", "-o", "out", "--room", "pretty"}).status, 2);
  // Nothing is passed over without a word.
  EXPECT_EQ(run({"simulate", "room", "-o", "out", "--as-built"}).status, 2);
  EXPECT_EQ(run({"simulate", "office", "-o", "out", "--facades", "2"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(work() / "out"));
}

}  // namespace
}  // namespace limen
