// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen project --sphere-radius --board-side from outside: targets that the simulator put up.
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.h"
#include <nlohmann/json.hpp>

#include "limen/geometry/rigid.h"

namespace limen {
namespace {

using nlohmann::json;

std::vector<std::string> cells_in(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream stream(text);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) rows.push_back(cells_in(line));
  return rows;
}

Vector3d place_in(const std::vector<std::string>& row, std::size_t first) {
  return {std::stod(row[first]), std::stod(row[first + 1]), std::stod(row[first + 2])};
}

Rigid3 pose_in(const json& rows) {
  Rigid3 pose;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double value = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
      (j < 3 ? pose.rotation(i, j) : pose.translation[i]) = value;
    }
  }
  return pose;
}

class ProjectTargets : public ProgramTest {};

TEST_F(ProjectTargets, AreFoundNamedAndPlaceTheScansInTheSurveysFrame) {
  const ProgramRun made =
      run({"simulate", "terrace", "--project", "--stations", "2", "--passes", "0", "--targets", "8",
           "--points-indoor", "1500000", "--seed", "2", "-o", "case", "--quiet"});
  ASSERT_EQ(made.status, 0) << made.err;
  const std::vector<std::string> inputs = {"project", "case/station_001.ply", "case/station_002.ply",
                                           "--control", "case/control.csv"};
  std::vector<std::string> finding = inputs;
  for (const char* word : {"--sphere-radius", "72.5mm", "--board-side", "300mm", "-o", "out"})
    finding.emplace_back(word);
  const ProgramRun done = run(finding);
  ASSERT_TRUE(done.status == 0 || done.status == 3) << done.err;

  std::map<std::string, Vector3d> exact;
  for (const auto& row : rows_of(read_whole(work() / "case" / "truth" / "control.csv")))
    exact[row[0]] = place_in(row, 1);
  const json truth = json::parse(read_whole(work() / "case" / "truth" / "project.json"));
  const std::string table = read_whole(work() / "out" / "targets.csv");
  std::size_t named = 0;
  std::set<std::string> kinds;
  for (const auto& row : rows_of(table)) {
    if (row[0].starts_with("unknown")) continue;
    ++named;
    kinds.insert(row[6]);
    const std::size_t scan = row[1] == "case/station_001.ply" ? 0 : 1;
    const Rigid3 pose = pose_in(truth["scans"][scan]["world_from_scan"]);
    EXPECT_LT((pose * place_in(row, 2) - exact.at(row[0])).norm(), 0.0005 + 4.0 * std::stod(row[5]))
        << row[0];
  }
  EXPECT_GE(named, 9U) << table;
  EXPECT_EQ(kinds.size(), 2U);

  const json project = json::parse(read_whole(work() / "out" / "project.json"));
  EXPECT_EQ(project["frame"]["kind"], "control");
  const Rigid3 placed = pose_in(project["scans"][0]["frame_from_scan"]);
  const Rigid3 right = pose_in(truth["scans"][0]["world_from_scan"]);
  EXPECT_LT((placed.translation - right.translation).norm(), 0.003);

  // What was written is read as if it had been measured.
  std::filesystem::copy_file(work() / "out" / "targets.csv", work() / "mine.csv");
  std::vector<std::string> reading = inputs;
  for (const char* word : {"--targets", "mine.csv", "-o", "out2"}) reading.emplace_back(word);
  ASSERT_EQ(run(reading).status, done.status);
  const json again = json::parse(read_whole(work() / "out2" / "project.json"));
  EXPECT_EQ(again["points"], project["points"]);
  EXPECT_EQ(again["scans"][0]["frame_from_scan"], project["scans"][0]["frame_from_scan"]);

  // Both at once is a mistake; so is a length that no target has.
  finding.emplace_back("--targets");
  finding.emplace_back("mine.csv");
  EXPECT_EQ(run(finding).status, 2);
  EXPECT_EQ(run({"project", "case/station_001.ply", "--sphere-radius", "72.5m", "-o", "out3"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(work() / "out3"));
}

}  // namespace
}  // namespace limen
