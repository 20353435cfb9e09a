// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A room with windows in one façade and the street outside, as a user registers them, against exact truth.
#include <cmath>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class IndoorOutdoorTest : public ProgramTest {
 protected:
  [[nodiscard]] Json result_of(const std::string& folder) const {
    return Json::parse(read_whole(work() / folder / "result.json"));
  }
  [[nodiscard]] Json errors_of(const std::string& folder) const {
    return Json::parse(run({"evaluate", folder + "/result.json", "truth/truth.json", "--json"}).out);
  }
  void simulate(const std::vector<std::string>& arguments) const {
    std::vector<std::string> command = {"simulate", "-o", ".", "--quiet"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ASSERT_EQ(run(command).status, 0);
  }
  [[nodiscard]] ProgramRun register_to(const std::string& folder,
                                       const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {"register", "indoor_00.ply", "outdoor.ply", "-o", folder};
    command.insert(command.end(), more.begin(), more.end());
    return run(command);
  }
};

TEST_F(IndoorOutdoorTest, OneFacadeIsEnoughByOpeningsAndPlanes) {
  simulate({"museum", "--seed", "4", "--facades", "1", "--stations", "1"});
  const ProgramRun done = register_to("auto");
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const Json result = result_of("auto");
  EXPECT_EQ(result["outcome"], "registered");
  EXPECT_GE(result["evidence"]["matched_openings"].get<int>(), 1);
  const Json errors = errors_of("auto");
  EXPECT_LT(errors["translation_error_m"].get<double>(), 0.005);
  EXPECT_LT(errors["rotation_error_deg"].get<double>(), 0.02);
  EXPECT_LT(errors["largest_error_in_sigmas"].get<double>(), 4.0);
  // The wall between is as thick as it was built.
  const Json truth = Json::parse(read_whole(work() / "truth" / "truth.json"));
  double thickness_m = 0.0;
  for (const Json& opening : truth["openings"]) {
    if (opening["exterior"].get<bool>() && opening["rooms"][0] == truth["scans"][0]["room"])
      thickness_m = opening["thickness_m"].get<double>();
  }
  ASSERT_FALSE(result["wall_thickness"].empty());
  EXPECT_NEAR(result["wall_thickness"][0]["thickness_m"].get<double>(), thickness_m, 0.01);
  EXPECT_NE(done.out.find(" m thick"), std::string::npos);

  // Openings alone fix what they can, and never claim more than they know.
  const ProgramRun openings = register_to("openings", {"--method", "openings"});
  ASSERT_TRUE(openings.status == 0 || openings.status == 3) << openings.err;
  if (openings.status == 0) {
    EXPECT_LT(errors_of("openings")["translation_error_m"].get<double>(), 0.05);
  }

  // The same bytes for any number of threads.
  ASSERT_EQ(register_to("one", {"--threads", "1"}).status, 0);
  EXPECT_EQ(read_whole(work() / "auto" / "transform.txt"), read_whole(work() / "one" / "transform.txt"));
}

TEST_F(IndoorOutdoorTest, RoomsThatRepeatAreAmbiguousWithTheTruthListed) {
  simulate({"identical_bays", "--seed", "4", "--stations", "1", "--points-outdoor", "800000"});
  const ProgramRun done = register_to("result");
  EXPECT_EQ(done.status, 3) << done.out << done.err;
  const Json result = result_of("result");
  ASSERT_EQ(result["outcome"], "ambiguous");
  const Json truth = Json::parse(read_whole(work() / "truth" / "truth.json"));
  const Json pose = truth["scans"][0]["world_from_scan"];
  const auto off_m = [&](const Json& candidate) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += std::pow(candidate["target_from_source"][k][3].get<double>() - pose[k][3].get<double>(), 2);
    return std::sqrt(sum);
  };
  double nearest_m = off_m(result);
  for (const Json& other : result["alternatives"]) nearest_m = std::min(nearest_m, off_m(other));
  EXPECT_LT(nearest_m, 0.05);
}

TEST_F(IndoorOutdoorTest, AWallThicknessThatIsNoneIsRefused) {
  write_whole(work() / "a.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string thickness : {"-0.3", "thick", "50"}) {
    const ProgramRun done = run({"register", "a.xyz", "a.xyz", "-o", "out", "--wall-thickness-m", thickness});
    EXPECT_EQ(done.status, 2) << thickness;
    EXPECT_FALSE(done.err.empty());
    EXPECT_FALSE(std::filesystem::exists(work() / "out" / "result.json"));
  }
}

}  // namespace
}  // namespace limen
