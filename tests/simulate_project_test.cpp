// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class SimulateProjectTest : public ProgramTest {};

const std::vector<std::string> kFlats = {
    "simulate",         "flats", "--project", "-o", "house",  "--stations",      "6",
    "--passes",         "1",     "--seed",    "2",  "--json", "--points-indoor", "5000",
    "--points-outdoor", "20000"};

TEST_F(SimulateProjectTest, GivesOneFileAScanAndTheTruthApart) {
  const ProgramRun done = run(kFlats);
  ASSERT_EQ(done.status, 0) << done.err;
  const Json task = Json::parse(done.out);
  const Json truth = Json::parse(read_whole(work() / "house" / "truth" / "project.json"));
  ASSERT_EQ(task["scans"].size(), 7U);
  ASSERT_EQ(truth["scans"].size(), 7U);
  for (const Json& scan : truth["scans"]) {
    EXPECT_TRUE(std::filesystem::exists(work() / "house" / scan["file"].get<std::string>()));
    EXPECT_EQ(scan["world_from_scan"].size(), 4U);
    EXPECT_EQ(scan["room"].is_null(), scan["kind"] == "mobile");
  }
  EXPECT_FALSE(truth["shared"].empty());
  for (const Json& pair : truth["shared"]) {
    EXPECT_LT(pair["a"].get<int>(), pair["b"].get<int>());
    EXPECT_LE(pair["m2"].get<double>(),
              truth["scans"][pair["a"].get<std::size_t>()]["surface_m2"].get<double>() + 1e-9);
  }
  // What a program under test may read tells no pose and no room.
  EXPECT_EQ(done.out.find("room"), std::string::npos);
  EXPECT_EQ(done.out.find("world_from_scan"), std::string::npos);
}

TEST_F(SimulateProjectTest, IsTheSameEveryTime) {
  ASSERT_EQ(run(kFlats).status, 0);
  const std::string scan = read_whole(work() / "house" / "station_003.ply");
  const std::string truth = read_whole(work() / "house" / "truth" / "project.json");
  ASSERT_FALSE(scan.empty());
  std::filesystem::remove_all(work() / "house");
  ASSERT_EQ(run(kFlats).status, 0);
  EXPECT_EQ(read_whole(work() / "house" / "station_003.ply"), scan);
  EXPECT_EQ(read_whole(work() / "house" / "truth" / "project.json"), truth);
}

TEST_F(SimulateProjectTest, RefusesWhatDoesNotFit) {
  EXPECT_EQ(run({"simulate", "villa", "--project", "-o", "house"}).status, 2);
  EXPECT_EQ(run({"simulate", "flats", "--project", "-o", "house", "--facades", "1"}).status, 2);
  EXPECT_EQ(run({"simulate", "room", "-o", "house", "--passes", "1"}).status, 2);
  EXPECT_EQ(run({"simulate", "room", "-o", "house", "--styles"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(work() / "house"));
}

}  // namespace
}  // namespace limen
