// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Two scans registered by their line segments alone, as a user does it, against exact truth.
#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class RegisterBySegmentsTest : public ProgramTest {
 protected:
  void simulate(const std::string& scene, const std::string& seed, bool as_drawn = false) const {
    std::vector<std::string> arguments = {
        "simulate",         scene,   "--seed", seed, "--stations", "2", "--points-indoor", "80000",
        "--points-outdoor", "60000", "-o",     ".",  "--quiet"};
    if (as_drawn) arguments.push_back("--as-drawn");
    ASSERT_EQ(run(arguments).status, 0);
  }
  [[nodiscard]] ProgramRun register_by(const std::string& method, const std::string& folder) const {
    return run(
        {"register", "indoor_00.ply", "indoor_01.ply", "-o", folder, "--method", method, "--no-report"});
  }
};

TEST_F(RegisterBySegmentsTest, TwoStationsOfOneRoom) {
  simulate("room", "3");
  const ProgramRun done = register_by("segments", "result");
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const Json result = Json::parse(read_whole(work() / "result" / "result.json"));
  EXPECT_EQ(result["outcome"], "registered");
  EXPECT_EQ(result["options"]["method"], "segments");
  const Json errors = Json::parse(run({"evaluate", "result/result.json", "truth/truth.json", "--json"}).out);
  EXPECT_LT(errors["translation_error_m"].get<double>(), 0.002);
  EXPECT_LT(errors["rotation_error_deg"].get<double>(), 0.02);
}

TEST_F(RegisterBySegmentsTest, TwoStationsOfASymmetricRoomAreNotDecided) {
  simulate("symmetric_room", "2", true);  // as built no room is symmetric
  const ProgramRun done = register_by("segments", "result");
  EXPECT_EQ(done.status, 3) << done.out << done.err;
  const Json result = Json::parse(read_whole(work() / "result" / "result.json"));
  EXPECT_EQ(result["outcome"], "ambiguous");
}

TEST_F(RegisterBySegmentsTest, APublishedMethodIsNamedAndClaimsNothing) {
  simulate("room", "3");
  const ProgramRun done =
      run({"register", "indoor_00.ply", "indoor_01.ply", "-o", "result", "--as-published", "2021-cluster"});
  EXPECT_EQ(done.status, 3) << done.out << done.err;
  const Json result = Json::parse(read_whole(work() / "result" / "result.json"));
  EXPECT_EQ(result["outcome"], "ambiguous");
  EXPECT_EQ(result["published"]["method"], "2021-cluster");
  EXPECT_EQ(result["published"]["unit"], "m2");
  EXPECT_EQ(result["options"]["as_published"], "2021-cluster");
  EXPECT_TRUE(result["sigma"].is_null());
  EXPECT_NE(read_whole(work() / "result" / "report.html").find("2021-cluster"), std::string::npos);
  EXPECT_EQ(run({"evaluate", "result/result.json", "truth/truth.json", "--json"}).status, 0);
  EXPECT_EQ(
      run({"register", "indoor_00.ply", "indoor_01.ply", "-o", "other", "--as-published", "2020"}).status, 2);
}

}  // namespace
}  // namespace limen
