// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/evaluate_project.h"

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/geometry/rigid.h"

namespace limen {
namespace {

const Vector3d kGrid(1050012.5, 6840987.25, 151.125);

/// Four stations, and a pass whose points are on the grid; the project's frame is its own.
struct Building {
  std::vector<ProjectEntry> project;
  std::vector<TrueScan> truth;

  Building() {
    const Rigid3 frame_from_world{rotation_exp(Vector3d(0.01, 0.02, 1.3)), Vector3d(3.0, -4.0, 5.0) - kGrid};
    for (int k = 0; k < 5; ++k) {
      const bool pass = k == 4;
      TrueScan scan;
      scan.name = pass ? "pass" : "station_" + std::to_string(k);
      scan.file = scan.name + ".ply";
      if (!pass) {
        scan.world_from_scan = {rotation_exp(Vector3d(0.0, 0.0, 0.7 * k)), kGrid + Vector3d(4.0 * k, k, 0.0)};
        scan.scanner = Vector3d(0.1, 0.2, 1.6);
      }
      ProjectEntry entry;
      entry.file = "scans/" + scan.file;
      entry.state = "registered";
      entry.frame_from_scan = frame_from_world * scan.world_from_scan;
      truth.push_back(scan);
      project.push_back(entry);
    }
  }
  [[nodiscard]] ProjectErrors errors() const { return evaluate_project(project, truth, "truth.json"); }
};

TEST(EvaluateProject, TheFrameOfTheProjectIsItsOwn) {
  const ProjectErrors errors = Building().errors();
  EXPECT_EQ(errors.scans, 5U);
  ASSERT_EQ(errors.each.size(), 5U);
  for (const PlaceError& error : errors.each) {
    EXPECT_LT(error.shift_m, 1e-7) << error.file;
    EXPECT_LT(error.turn_rad, 1e-9) << error.file;
  }
}

TEST(EvaluateProject, OneScanThatStandsElsewhereIsTheOneThatErrs) {
  Building building;
  building.project[0].frame_from_scan->translation += Vector3d(0.0, 3.0, 0.0);
  const ProjectErrors errors = building.errors();
  EXPECT_NE(errors.reference, 0U);
  EXPECT_NEAR(errors.each[0].shift_m, 3.0, 1e-6);
  EXPECT_NEAR(errors.shift_of(1.0), 3.0, 1e-6);
  EXPECT_LT(errors.shift_of(0.5), 1e-6);
}

TEST(EvaluateProject, OnlyRegisteredScansAreHeldAgainstTheTruth) {
  Building building;
  building.project[1].state = "ambiguous";
  building.project[1].frame_from_scan->translation += Vector3d(0.0, 3.0, 0.0);
  building.project[2].state = "floating";
  building.project[2].frame_from_scan.reset();
  const ProjectErrors errors = building.errors();
  EXPECT_EQ(errors.scans, 5U);
  ASSERT_EQ(errors.each.size(), 3U);
  EXPECT_LT(errors.shift_of(1.0), 1e-6);
}

TEST(EvaluateProject, StationsOfOneFileAreDistinguished) {
  Building building;
  for (std::size_t k = 0; k < 4; ++k) {
    building.project[k].file = "scans/all.e57";
    building.truth[k].file = "all.e57";
    building.project[k].index = building.truth[k].index = static_cast<int>(k);
  }
  EXPECT_LT(building.errors().shift_of(1.0), 1e-6);
  building.project[2].frame_from_scan->translation += Vector3d(0.0, 3.0, 0.0);
  EXPECT_NEAR(building.errors().shift_of(1.0), 3.0, 1e-6);
}

/// Stations of two storeys, called alike in a folder of each; the truth tells their folders or not.
Building two_storeys(const std::string& truth_folder) {
  Building building;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string file = (k < 2 ? "first/" : "ground/") + std::to_string(k % 2) + ".ply";
    building.project[k].file = "scans/" + file;
    building.truth[k].file = truth_folder.empty() ? std::to_string(k % 2) + ".ply" : truth_folder + file;
    building.truth[k].name.clear();
  }
  return building;
}

std::string fault_of_truth(const Building& building) {
  try {
    return std::to_string(building.errors().scans) + " scans";
  } catch (const Error& error) {
    return error.where() + ": " + error.problem();
  }
}

TEST(EvaluateProject, ScansThatAreCalledAlikeAreDistinguishedByTheirFolders) {
  for (const char* folder : {"scans/", "elsewhere/", "./"})
    EXPECT_LT(two_storeys(folder).errors().shift_of(1.0), 1e-6) << folder;
  Building building = two_storeys("scans/");
  std::swap(building.truth[0], building.truth[2]);
  EXPECT_LT(building.errors().shift_of(1.0), 1e-6) << "their order tells nothing";
}

TEST(EvaluateProject, ScansThatCannotBeDistinguishedAreNamed) {
  const std::string truth = fault_of_truth(two_storeys(""));
  EXPECT_NE(truth.find("cannot tell"), std::string::npos) << truth;
  EXPECT_NE(truth.find("scans/first/0.ply"), std::string::npos) << truth;
  // One place for two scans, whether or not both are registered.
  Building building = two_storeys("");
  building.truth.erase(building.truth.begin() + 2, building.truth.begin() + 4);
  building.project[2].state = building.project[3].state = "floating";
  const std::string project = fault_of_truth(building);
  EXPECT_NE(project.find("scans/first/0.ply and scans/ground/0.ply"), std::string::npos) << project;
  // The other has no truth.
  building = two_storeys("scans/");
  building.truth.erase(building.truth.begin() + 2);
  EXPECT_EQ(fault_of_truth(building), "truth.json: holds no pose of the scan scans/ground/0.ply");
}

TEST(EvaluateProject, CopiesCountOnce) {
  Building building;
  building.project.push_back(building.project[0]);
  building.project.back().file = "copies/station_0.ply";
  building.project.back().copy_of = building.project[0].file;
  const ProjectErrors errors = building.errors();
  EXPECT_EQ(errors.scans, 5U);
  EXPECT_EQ(errors.each.size(), 5U);
}

TEST(EvaluateProject, ATruthThatLacksAScanIsNamed) {
  Building building;
  building.truth.erase(building.truth.begin() + 3);
  try {
    FAIL() << building.errors().scans << " scans";
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "truth.json");
    EXPECT_NE(error.problem().find("station_3.ply"), std::string::npos);
  }
}

}  // namespace
}  // namespace limen
