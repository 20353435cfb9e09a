// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// `limen view` from outside. What its page does in a browser: tests/browser/view_test.mjs.
#include <cmath>
#include <string>
#include <vector>

#include "run_program.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using nlohmann::json;

constexpr const char* kTurned = "0 -1 0 1000\n1 0 0 2000\n0 0 1 5\n0 0 0 1\n";

class ViewTest : public ProgramTest {
 protected:
  /// A wall of 2 m x 1 m from `x`, a point every 2 cm.
  void write_wall(const std::string& name, double x) const {
    std::string text = "x y z\n";
    for (int i = 0; i <= 100; ++i) {
      for (int k = 0; k <= 50; ++k)
        text += std::to_string(x + 0.02 * i) + " 3 " + std::to_string(0.02 * k) + "\n";
    }
    write_whole(work() / name, text);
  }
  /// What the page's script reads.
  [[nodiscard]] json scene_of(const std::string& page) const {
    const std::string text = read_whole(work() / page);
    const std::string head = "<script type=\"application/json\" id=\"scene\">";
    const std::size_t begin = text.find(head);
    EXPECT_NE(begin, std::string::npos);
    const std::size_t from = begin + head.size();
    return json::parse(text.substr(from, text.find("</script>", from) - from));
  }
  /// Where a side's box begins, in the world of the page.
  [[nodiscard]] static std::vector<double> low_of(const json& scene, const std::string& side) {
    std::vector<double> low;
    for (std::size_t k = 0; k < 3; ++k)
      low.push_back(scene["origin"][k].get<double>() + scene[side]["low"][k].get<double>());
    return low;
  }
  void must_view(const std::vector<std::string>& words) const {
    std::vector<std::string> arguments{"view"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const ProgramRun done = run(arguments);
    ASSERT_EQ(done.status, 0) << done.err;
  }
  [[nodiscard]] std::string error_of(const std::vector<std::string>& words) const {
    std::vector<std::string> arguments{"view"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const ProgramRun done = run(arguments);
    EXPECT_EQ(done.status, 2) << done.out;
    return done.err;
  }
};

TEST_F(ViewTest, ScansLieWhereTheirFilesSay) {
  write_wall("a.xyz", 0.0);
  write_wall("b.xyz", 10.0);
  must_view({"a.xyz", "b.xyz", "--title", "Two <walls>"});
  const json scene = scene_of("view.html");
  ASSERT_EQ(scene["sides"].size(), 2U);
  EXPECT_EQ(scene["side-0"]["name"], "a.xyz");
  EXPECT_EQ(scene["side-0"]["count"], 5151);
  EXPECT_NEAR(low_of(scene, "side-0")[0], 0.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-1")[0], 10.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-1")[1], 3.0, 1e-6);
  const std::string page = read_whole(work() / "view.html");
  EXPECT_NE(page.find("<title translate=\"no\">Two &lt;walls&gt;</title>"), std::string::npos);
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
}

TEST_F(ViewTest, BothSidesOfAResultStandInTheTargetsFrame) {
  write_wall("a.xyz", 0.0);
  write_wall("b.xyz", 1000.0);
  json result;
  result["target_from_source"] = {{0, -1, 0, 1000}, {1, 0, 0, 2000}, {0, 0, 1, 5}, {0, 0, 0, 1}};
  result["inputs"]["source"]["path"] = "a.xyz";
  result["inputs"]["target"]["path"] = "b.xyz";
  write_whole(work() / "result.json", result.dump());
  must_view({"result.json", "-o", "out.html"});
  const json scene = scene_of("out.html");
  // (0..2, 3, 0..1) turned by a right angle: x = 1000 - 3, y = 2000 .. 2002, z = 5 .. 6.
  EXPECT_NEAR(low_of(scene, "side-0")[0], 997.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-0")[1], 2000.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-0")[2], 5.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-1")[0], 1000.0, 1e-6);
  // Looked at from elsewhere: the files are sought from where the result lies, upwards.
  std::filesystem::create_directories(work() / "site/results/one");
  for (const char* name : {"a.xyz", "b.xyz"}) std::filesystem::rename(work() / name, work() / "site" / name);
  std::filesystem::rename(work() / "result.json", work() / "site/results/one/result.json");
  must_view({"site/results/one/result.json", "-o", "out.html"});
  EXPECT_EQ(scene_of("out.html"), scene);
  // A file that is not the registered one would stand anywhere.
  result["inputs"]["source"]["sha256"] = std::string(64, 'a');
  write_whole(work() / "site/result.json", result.dump());
  EXPECT_NE(error_of({"site/result.json", "-o", "other.html"}).find("SHA-256"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(work() / "other.html"));
}

TEST_F(ViewTest, AResultKnowsTheUnitsOfItsFiles) {
  write_wall("feet.xyz", 10.0);
  write_wall("metres.xyz", 0.0);
  json result;
  result["target_from_source"] = {{1, 0, 0, 100}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  result["inputs"]["source"] = {{"path", "feet.xyz"}, {"metres_per_unit", 0.3048}};
  result["inputs"]["target"] = {{"path", "metres.xyz"}, {"metres_per_unit", 1.0}};
  write_whole(work() / "result.json", result.dump());
  must_view({"result.json", "-o", "out.html"});
  const json scene = scene_of("out.html");
  EXPECT_NEAR(low_of(scene, "side-0")[0], 103.048, 1e-4);
  EXPECT_NEAR(low_of(scene, "side-1")[0], 0.0, 1e-6);
  EXPECT_FALSE(scene["side-0"].contains("path"));  // its places are not those of the file
}

TEST_F(ViewTest, AllPlacedScansOfAProject) {
  ASSERT_EQ(run({"simulate", "room", "--points-indoor", "30000", "-o", ".", "--quiet"}).status, 0);
  ASSERT_EQ(run({"project", "indoor_00.ply", "indoor_01.ply", "-o", "building", "--quiet"}).status, 0);
  const json project = json::parse(read_whole(work() / "building/project.json"));
  must_view({"building/project.json", "-o", "out.html", "--most-points", "8000"});
  const json scene = scene_of("out.html");
  std::size_t placed = 0;
  for (const json& scan : project["scans"]) placed += scan["frame_from_scan"].is_null() ? 0 : 1;
  ASSERT_EQ(scene["sides"].size(), placed);
  ASSERT_EQ(placed, 2U);
  int shown = 0;
  for (const std::string side : {"side-0", "side-1"}) shown += scene[side]["count"].get<int>();
  EXPECT_LE(shown, 8000);
  EXPECT_GE(shown, 5000);

  std::filesystem::copy_file(work() / "indoor_00.ply", work() / "indoor_01.ply",
                             std::filesystem::copy_options::overwrite_existing);
  const ProgramRun changed = run({"view", "building/project.json", "-o", "changed.html"});
  EXPECT_EQ(changed.status, 2);
  EXPECT_NE(changed.err.find("SHA-256"), std::string::npos) << changed.err;
  const ProgramRun several = run({"view", "building/project.json", "--alternative", "7"});
  EXPECT_NE(several.err.find("--alternative"), std::string::npos) << several.err;
}

TEST_F(ViewTest, APassThatDriftedIsShownBentBack) {
  std::string drive = "x,y,z,x_origin,y_origin,z_origin,gps_time\n";
  for (int k = 0; k < 200; ++k) {
    const std::string x = std::to_string(0.5 * k);
    drive.append(x).append(",5,1,").append(x).append(",0,2,").append(std::to_string(100.0 + k)).append("\n");
  }
  write_whole(work() / "drive.csv", drive);
  json knots = json::array();
  for (int k = 0; k < 5; ++k)
    knots.push_back({{"time_s", 100.0 + 50.0 * k}, {"turn_rad", {0, 0, 0}}, {"shift_m", {0, 0, 0.25}}});
  json scan = {{"file", "drive.csv"}, {"index", 0}, {"kind", "scan"}, {"state", "registered"}};
  scan["frame_from_scan"] = {{0, -1, 0, 1000}, {1, 0, 0, 2000}, {0, 0, 1, 5}, {0, 0, 0, 1}};
  scan["correction"] = {{"pivot", {1000, 2000, 5}}, {"knots", knots}};
  write_whole(work() / "project.json", json{{"scans", json::array({scan})}, {"links", json::array()}}.dump());
  must_view({"project.json"});
  const json scene = scene_of("view.html");
  // (0 .. 99.5, 5, 1) turned by a right angle, moved, and lifted by the correction.
  EXPECT_NEAR(low_of(scene, "side-0")[0], 995.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-0")[1], 2000.0, 1e-6);
  EXPECT_NEAR(low_of(scene, "side-0")[2], 6.25, 1e-6);
}

TEST_F(ViewTest, AModelBesideAScanAndTheSameBytesForAnyThreads) {
  ASSERT_EQ(run({"simulate", "office", "--points-indoor", "20000", "-o", ".", "--quiet"}).status, 0);
  must_view({"model.ifc", "scan_01.ply", "-o", "one.html", "--threads", "1"});
  must_view({"model.ifc", "scan_01.ply", "-o", "two.html", "--threads", "3"});
  EXPECT_EQ(read_whole(work() / "one.html"), read_whole(work() / "two.html"));
  const json scene = scene_of("one.html");
  EXPECT_EQ(scene["side-0"]["shape"], "faces");
  EXPECT_GT(scene["side-0"]["planes"].size(), 50U);
  EXPECT_EQ(scene["side-1"]["shape"], "points");
}

TEST_F(ViewTest, WhatIsWrongIsStated) {
  write_wall("a.xyz", 0.0);
  write_whole(work() / "pose.txt", kTurned);
  write_whole(work() / "other.json", "{\"a\": 1}");
  EXPECT_NE(error_of({"missing.ply"}).find("missing.ply"), std::string::npos);
  EXPECT_NE(error_of({"a.xyz", "-o", "a.xyz"}).find("overwrite the input"), std::string::npos);
  EXPECT_NE(error_of({"a.xyz", "--most-points", "5"}).find("--most-points"), std::string::npos);
  EXPECT_NE(error_of({"a.xyz", "--most-points", "9000000"}).find("--most-points"), std::string::npos);
  EXPECT_NE(error_of({"other.json"}).find("other.json"), std::string::npos);
  EXPECT_NE(error_of({}).find("FILE"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(work() / "view.html"));
}

}  // namespace
}  // namespace limen
