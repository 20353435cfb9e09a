// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/deviation/deviation_report.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/report/deviation/building_report.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

BimModel model_with_names() {
  BimModel model;
  model.local_origin = {1000, 2000, 30};
  model.elements.push_back({BimKind::wall, "IfcWall", "0abc", "Wall \"A\", north", "Ground", 12});
  model.elements.push_back({BimKind::door, "IfcDoor", "1def", "Door", "", 13});
  return model;
}

DeviationReport report_of_two() {
  DeviationReport report;
  report.scan.path = "scan.ply";
  report.model.path = "model.ifc";
  report.result_path = "result.json";
  report.result_outcome = "registered";
  report.model_from_scan.translation = {1, 2, 3};
  ElementDeviation wall;
  wall.element = 0;
  wall.presence = Presence::found;
  wall.points = 1234;
  wall.median_m = -0.0123;
  wall.p95_m = 0.0149;
  wall.loa = 30;
  wall.covered_m2 = 3.0;
  wall.passed_m2 = 1.0;
  wall.covered_share = 0.75;
  wall.shift.shift_m = {0.0, -0.0123, 0.0};
  wall.shift.held = 1;
  wall.shift.open = {Vector3d::UnitX(), Vector3d::UnitZ()};
  ElementDeviation door;
  door.element = 1;
  door.presence = Presence::not_found;
  door.passed_m2 = 1.5;
  report.deviation.elements = {wall, door};
  report.deviation.unmodelled.push_back(
      {77, Vector3d(0, 0, 0), Vector3d(1, 2, 1), Vector3d(0.5, 1, 0.5), true});
  report.deviation.distance_m = {0.01F, -0.02F, std::numeric_limits<float>::quiet_NaN()};
  report.deviation.element = {0, 0, -1};
  report.deviation.matched = 2;
  report.deviation.far = 1;
  return report;
}

TEST(DeviationReport, JsonHoldsElementsSummaryAndWhatIsNotModelled) {
  const Json json = Json::parse(deviation_json(report_of_two(), model_with_names()));
  EXPECT_EQ(json["summary"]["points"], 3);
  EXPECT_EQ(json["summary"]["points_on_faces"], 2);
  EXPECT_EQ(json["summary"]["elements"]["found"], 1);
  EXPECT_EQ(json["summary"]["elements"]["not_found"], 1);
  EXPECT_EQ(json["summary"]["found_by_loa"]["LOA30"], 1);
  EXPECT_EQ(json["pose"]["outcome"], "registered");
  EXPECT_EQ(json["pose"]["model_from_scan"][1][3], 2.0);
  const Json& wall = json["elements"][0];
  EXPECT_EQ(wall["name"], "Wall \"A\", north");
  EXPECT_EQ(wall["loa"], "LOA30");
  EXPECT_EQ(wall["shift"]["shift_m"][1], -0.0123);
  EXPECT_EQ(wall["shift"]["open"].size(), 2U);
  EXPECT_EQ(json["elements"][1]["presence"], "not_found");
  EXPECT_FALSE(json["elements"][1].contains("median_m"));
  EXPECT_EQ(json["unmodelled"][0]["centre"][0], 1000.5);
  EXPECT_EQ(json["unmodelled"][0]["size_m"][1], 2.0);
}

TEST(BuildingPage, LacksNoTextInAnyLanguage) {
  BuildingReport report;
  report.model = model_with_names();
  const DeviationReport two = report_of_two();
  report.deviation.elements = two.deviation.elements;
  report.deviation.elements.push_back(two.deviation.elements.back());
  report.deviation.elements.back().presence = Presence::not_judged;
  report.model.elements.push_back(report.model.elements.back());
  report.deviation.seen_by = {2, 0, 0};
  report.deviation.unmodelled = two.deviation.unmodelled;
  for (const char* place : {"project", "with the first", "in the frame"})
    report.models.push_back({"house.ifc", 2, Rigid3{}, place});
  report.scans.push_back({"hall.ply", 0, 0.0015, true, Rigid3{}});
  report.deviation.scans = {{100, 90, 10, false, {}}};
  report.left_out.push_back({"far.ply", 0, "no reliable overlap with any other scan"});
  const std::string page = building_page(report);
  for (const Language language : {Language::french, Language::german}) {
    std::set<std::string> missing;
    static_cast<void>(page_in_language(page, language, &missing));
    EXPECT_EQ(missing, std::set<std::string>());
  }
  const std::string german = building_page(report, {"", "", "", "", Language::german});
  EXPECT_NE(german.find("1 fehlen, "), std::string::npos);
  EXPECT_NE(german.find(">14,9<"), std::string::npos) << "the decimal sign of the language";
  EXPECT_NE(german.find(">IfcWall<"), std::string::npos);
}

TEST(DeviationReport, CsvHasAFieldForEveryName) {
  const std::string csv = csv_of(deviation_sheet(report_of_two(), model_with_names()));
  std::vector<std::vector<std::string>> rows(1);
  std::string text;
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (c == '"' && quoted && i + 1 < csv.size() && csv[i + 1] == '"') {
      text += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == ',' || c == '\n')) {
      rows.back().push_back(text);
      text.clear();
      if (c == '\n') rows.emplace_back();
    } else if (c != '\r') {
      text += c;
    }
  }
  ASSERT_EQ(rows.size(), 4U);  // names, two elements, the end
  EXPECT_EQ(rows[1].size(), rows[0].size());
  EXPECT_EQ(rows[2].size(), rows[0].size());
  const auto at = [&](std::size_t row, const std::string& name) {
    const auto column = std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin();
    return rows[row][static_cast<std::size_t>(column)];
  };
  EXPECT_EQ(at(1, "name"), "Wall \"A\", north");
  EXPECT_EQ(at(1, "loa"), "LOA30");
  EXPECT_EQ(at(1, "shift_y_m"), "-0.01230");
  EXPECT_EQ(at(1, "shift_open"), "(1.00 0.00 0.00) (0.00 0.00 1.00)");
  EXPECT_EQ(at(2, "presence"), "not_found");
  EXPECT_EQ(at(2, "median_m"), "");
}

TEST(DeviationReport, ColoursDivergeFromLightGrey) {
  const Colour low = deviation_colour(-0.2, 0.05);
  const Colour middle = deviation_colour(0.0, 0.05);
  const Colour high = deviation_colour(0.05, 0.05);
  EXPECT_GT(low.blue, low.red + 100);
  EXPECT_GT(high.red, high.blue + 100);
  EXPECT_EQ(middle.red, middle.blue);
  EXPECT_GT(middle.green, 200);
  EXPECT_GT(deviation_colour(0.01, 0.05).blue, deviation_colour(0.04, 0.05).blue);
}

TEST(DeviationReport, ThePlyHasEveryPointWithItsDeviation) {
  Scan scan;
  scan.local_origin = {100, 0, 0};
  scan.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const auto path =
      std::filesystem::temp_directory_path() / ("limen-deviation-" + std::to_string(getpid()) + ".ply");
  write_deviation_ply(path, scan, report_of_two(), 0.05);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove(path);
  const std::size_t body = bytes.find("end_header\n") + 11;
  constexpr std::size_t kRecord = 35;
  ASSERT_EQ(bytes.size(), body + 3 * kRecord);
  const auto x = [&](std::size_t i) {
    double value = 0.0;
    std::memcpy(&value, bytes.data() + body + i * kRecord, sizeof value);
    return value;
  };
  const auto deviation = [&](std::size_t i) {
    float value = 0.0F;
    std::memcpy(&value, bytes.data() + body + i * kRecord + 27, sizeof value);
    return value;
  };
  EXPECT_EQ(x(1), 102.0);
  EXPECT_EQ(deviation(1), -0.02F);
  EXPECT_TRUE(std::isnan(deviation(2)));
  EXPECT_THROW(write_deviation_ply(path, scan, report_of_two(), 0.0), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace limen
