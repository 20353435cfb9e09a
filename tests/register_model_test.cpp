// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <string>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class RegisterModelTest : public ProgramTest {
 protected:
  [[nodiscard]] Json json_at(const std::string& file) const { return Json::parse(read_whole(work() / file)); }

  void simulate(const std::string& room, const std::string& stations) const {
    const ProgramRun done =
        run({"simulate", "office", "-o", "case", "--room", room, "--stations", stations, "--as-built",
             "--any-rotation", "--points-indoor", "80000", "--seed", "2", "--quiet"});
    ASSERT_EQ(done.status, 0) << done.err;
  }

  [[nodiscard]] Json evaluated(const std::string& result) const {
    const ProgramRun done = run({"evaluate", result, "case/truth/truth.json", "--json"});
    EXPECT_EQ(done.status, 0) << done.err;
    return Json::parse(done.out);
  }
};

TEST_F(RegisterModelTest, ARoomIsFoundInItsIfc) {
  simulate("unique", "1");
  const ProgramRun done = run({"register", "case/scan_01.ply", "case/model.ifc", "-o", "result"});
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const Json result = json_at("result/result.json");
  EXPECT_EQ(result["outcome"], "registered");
  EXPECT_EQ(result["inputs"]["target"]["kind"], "model");
  EXPECT_FALSE(result["evidence"]["room"].get<std::string>().empty());
  EXPECT_NE(done.out.find("room "), std::string::npos);
  const Json error = evaluated("result/result.json");
  EXPECT_LT(error["translation_error_m"].get<double>(), 0.02);
  EXPECT_LT(error["rotation_error_deg"].get<double>(), 0.2);

  // The other way round it is the inverse.
  ASSERT_EQ(run({"register", "case/model.ifc", "case/scan_01.ply", "-o", "back"}).status, 0);
  const Json forth = result["target_from_source"];
  const Json back = json_at("back/result.json")["target_from_source"];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(forth[i][k].get<double>(), back[k][i].get<double>(), 1e-4);
  }
  // And by line segments it is the same place.
  ASSERT_EQ(
      run({"register", "case/scan_01.ply", "case/model.ifc", "-o", "lines", "--method", "segments"}).status,
      0);
  EXPECT_LT(evaluated("lines/result.json")["translation_error_m"].get<double>(), 0.02);
}

TEST_F(RegisterModelTest, RoomsAlikeAreListedByName) {
  simulate("repeated", "1");
  const ProgramRun done = run({"register", "case/scan_01.ply", "case/model.ifc", "-o", "result"});
  ASSERT_EQ(done.status, 3) << done.out << done.err;
  const Json result = json_at("result/result.json");
  EXPECT_EQ(result["outcome"], "ambiguous");
  ASSERT_FALSE(result["alternatives"].empty());
  EXPECT_NE(result["alternatives"][0]["evidence"]["room"], result["evidence"]["room"]);
  const Json truth = json_at("case/truth/truth.json")["scans"][0]["target_from_source"];
  const auto is_true = [&](const Json& pose) {
    double off = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      off = std::hypot(off, pose[i][3].get<double>() - truth[i][3].get<double>());
    return off < 0.02;
  };
  bool listed = is_true(result["target_from_source"]);
  for (const Json& other : result["alternatives"]) listed = listed || is_true(other["target_from_source"]);
  EXPECT_TRUE(listed);
}

TEST_F(RegisterModelTest, StationsKnownToOneAnotherGoTogether) {
  simulate("unique", "3");
  const ProgramRun done = run({"register", "case/scan_01.ply", "case/model.ifc", "-o", "result",
                               "--source-with", "case/scan_02.ply", "case/source_from_scan_02.txt",
                               "--source-with", "case/scan_03.ply", "case/source_from_scan_03.txt"});
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const Json source = json_at("result/result.json")["inputs"]["source"];
  EXPECT_EQ(source["with"].size(), 2U);
  EXPECT_LT(evaluated("result/result.json")["translation_error_m"].get<double>(), 0.02);
}

TEST_F(RegisterModelTest, WhatCannotBeIsStated) {
  simulate("unique", "1");
  const ProgramRun two = run({"register", "case/model.ifc", "case/model.ifc", "-o", "result"});
  EXPECT_EQ(two.status, 2);
  EXPECT_NE(two.err.find("both sides are building models"), std::string::npos) << two.err;
  const ProgramRun beside = run({"register", "case/model.ifc", "case/scan_01.ply", "-o", "result",
                                 "--source-with", "case/scan_01.ply", "case/truth/truth.json"});
  EXPECT_EQ(beside.status, 2);
  write_whole(work() / "pose.txt", "1 0 0\n");
  const ProgramRun pose = run({"register", "case/scan_01.ply", "case/model.ifc", "-o", "result",
                               "--source-with", "case/scan_01.ply", "pose.txt"});
  EXPECT_EQ(pose.status, 2);
  EXPECT_NE(pose.err.find("pose.txt"), std::string::npos) << pose.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "result" / "result.json"));
}

TEST_F(RegisterModelTest, FeaturesOfAModel) {
  simulate("unique", "1");
  ASSERT_EQ(run({"planes", "case/model.ifc", "-o", "planes.json"}).status, 0);
  ASSERT_EQ(run({"openings", "case/model.ifc", "-o", "openings.json"}).status, 0);
  EXPECT_GT(json_at("planes.json")["planes"].size(), 100U);
  EXPECT_GT(json_at("openings.json")["openings"].size(), 20U);
  ASSERT_EQ(run({"segments", "case/model.ifc", "-o", "exact.json"}).status, 0);
  ASSERT_EQ(run({"segments", "case/model.ifc", "-o", "sampled.json", "--sampled-m", "0.06"}).status, 0);
  EXPECT_GT(json_at("exact.json")["segments"].size(), 200U);
  EXPECT_GT(json_at("sampled.json")["segments"].size(), 100U);
  EXPECT_EQ(run({"segments", "case/model.ifc", "-o", "fine.json", "--sampled-m", "0.001"}).status, 2);
}

}  // namespace
}  // namespace limen
