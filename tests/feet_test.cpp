// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Two stations of a room whose files are in feet, and poses of other files than those that are meant.
#include <string>
#include <vector>

#include "run_program.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limen/geometry/rigid.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/cloud/write_clouds.h"

namespace limen {
namespace {

using Json = nlohmann::json;

constexpr double kFoot = 0.3048;

class FeetTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(run({"simulate", "room", "--points-indoor", "40000", "-o", "room", "--quiet"}).status, 0);
    write_in_feet("room/indoor_00.ply", "a.las");
    write_in_feet("room/indoor_01.ply", "b.las");
  }

  void write_in_feet(const std::string& from, const std::string& to) const {
    const Scan scan = read_scan_file(work() / from).scans.at(0);
    CloudPlan plan;
    for (const char* name : {"x", "y", "z"}) plan.columns.push_back({name, Scalar::float64});
    plan.near = (scan.local_origin + scan.points.front()) / kFoot;
    plan.most_points = scan.size();
    plan.georeference = {
        "PROJCS[\"site\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.257]],"
        "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"LCC\"],"
        "UNIT[\"foot\",0.3048]]"};
    std::vector<double> numbers;
    for (const Vector3d& x : scan.points) {
      const Vector3d feet = (scan.local_origin + x) / kFoot;
      numbers.insert(numbers.end(), {feet.x(), feet.y(), feet.z()});
    }
    const auto writer = make_cloud_writer(work() / to, plan);
    writer->write(
        table_of_numbers(std::make_shared<const std::vector<double>>(std::move(numbers)), {"x", "y", "z"}));
    writer->finish();
  }

  void registers(std::vector<std::string> words, const std::string& out) const {
    words.insert(words.begin(), "register");
    words.insert(words.end(), {"-o", out, "--no-report", "--quiet"});
    const ProgramRun done = run(words);
    EXPECT_EQ(done.status, 0) << done.err;
  }
  [[nodiscard]] Json result(const std::string& out) const {
    return Json::parse(read_whole(work() / out / "result.json"));
  }
  /// How far two poses put a place that both scans show from each other, metres.
  [[nodiscard]] static double apart_m(const Json& a, const Json& b, const Vector3d& at) {
    const auto moved = [&](const Json& rows, int i) {
      double sum = rows[static_cast<std::size_t>(i)][3].get<double>();
      for (int j = 0; j < 3; ++j)
        sum += rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>() * at[j];
      return sum;
    };
    Vector3d difference;
    for (int i = 0; i < 3; ++i)
      difference[i] = moved(a["target_from_source"], i) - moved(b["target_from_source"], i);
    return difference.norm();
  }
  void fails(const std::vector<std::string>& words, const std::string& stated) const {
    const ProgramRun failed = run(words);
    EXPECT_EQ(failed.status, 2) << words[0];
    EXPECT_NE(failed.err.find(stated), std::string::npos) << failed.err;
  }
};

TEST_F(FeetTest, ScansOfAProjectAreMovedInTheUnitOfTheirFiles) {
  ASSERT_EQ(run({"project", "a.las", "b.las", "-o", "p", "--quiet"}).status, 0);
  ASSERT_EQ(run({"transform", "p/project.json", "-o", "placed"}).status, 0);
  registers({"placed/a.las", "placed/b.las"}, "check");
  Json stays;
  stays["target_from_source"] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  EXPECT_LT(apart_m(result("check"), stays, {1, 1, 1}), 0.005);

  ASSERT_EQ(run({"project", "a.las", "room/indoor_01.ply", "-o", "mixed", "--quiet"}).status, 0);
  fails({"transform", "mixed/project.json", "-o", "none"}, "moved only, not scaled");
  EXPECT_FALSE(std::filesystem::exists(work() / "none"));
}

TEST_F(FeetTest, OneFileHasOneUnitThatItsFormatCanState) {
  fails({"thin", "a.las", "a.e57", "--points", "1000"}, "which a .e57 file cannot state");
  fails({"transform", "identity", "a.las", "a.ply"}, "which a .ply file cannot state");
  fails({"transform", "identity", "a.las", "both.las", "--merge", "room/indoor_01.ply"},
        "one file has one unit");
  const ProgramRun feet = run({"thin", "a.las", "thin.las", "--spacing-m", "0.1", "--json"});
  const ProgramRun metres = run({"thin", "room/indoor_00.ply", "thin.ply", "--spacing-m", "0.1", "--json"});
  ASSERT_EQ(feet.status, 0) << feet.err;
  EXPECT_NEAR(Json::parse(feet.out)["points_written"].get<double>(),
              Json::parse(metres.out)["points_written"].get<double>(), 100.0);
  EXPECT_NEAR(Json::parse(feet.out)["spacing_m"].get<double>(), 0.1, 1e-9);
}

TEST_F(FeetTest, AMatrixOfNumbersIsInTheirUnit) {
  registers({"a.las", "b.las"}, "pair");
  registers({"a.las", "b.las", "--start", "pair/transform.txt"}, "again");
  EXPECT_LT(apart_m(result("again"), result("pair"), {1, 1, 1}), 1e-3);
  for (const char* pose : {"pair/transform.txt", "pair/result.json"}) {
    registers({"b.las", "room/indoor_00.ply", "--source-with", "a.las", pose}, "with");
    registers({"room/indoor_01.ply", "room/indoor_00.ply"}, "metres");
    EXPECT_LT(apart_m(result("with"), result("metres"), {1, 1, 1}), 0.005) << pose;
  }
}

TEST_F(FeetTest, APoseOfAFurtherScanIsThatOfTheTwoFilesEitherWayRound) {
  const std::string a = "room/indoor_00.ply";
  const std::string b = "room/indoor_01.ply";
  registers({a, b}, "pair");
  registers({b, a}, "back");
  for (const char* pose : {"pair/result.json", "back/result.json"}) {
    registers({a, b, "--source-with", b, pose}, "with");
    EXPECT_LT(apart_m(result("with"), result("pair"), {1, 1, 1}), 0.005) << pose;
  }
  fails({"register", a, b, "--source-with", "a.las", "pair/result.json", "-o", "none"},
        "a pose of a.las in room/indoor_00.ply is wanted");
}

}  // namespace
}  // namespace limen
