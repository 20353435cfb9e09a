// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Large and foreign clouds through the program: thinned, moved, merged, with trajectories.
#include <cmath>
#include <cstring>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

constexpr const char* kShifted = "1 0 0 1000.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class CloudsTest : public ProgramTest {
 protected:
  /// Points on a floor of 20 x 20 m, with times and a number of their own.
  void write_floor(const std::string& name, int side) const {
    std::string text = "x,y,z,gps_time,label\n";
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        const int k = i * side + j;
        text += std::to_string(20.0 * i / side) + "," + std::to_string(20.0 * j / side) + ",1.5," +
                std::to_string(100.0 + 0.001 * k) + "," + std::to_string(k % 50) + "\n";
      }
    }
    write_whole(work() / name, text);
  }
  [[nodiscard]] Json info(const std::string& name) const {
    const ProgramRun done = run({"info", name, "--json"});
    EXPECT_EQ(done.status, 0) << done.err;
    return done.status == 0 ? Json::parse(done.out) : Json();
  }
};

TEST_F(CloudsTest, ThinKeepsAboutAsManyAsAskedForInEveryFormat) {
  write_floor("floor.csv", 200);
  for (const std::string ending : {"ply", "las", "laz", "copc.laz", "e57"}) {
    const ProgramRun done = run({"thin", "floor.csv", "out." + ending, "--points", "5000", "--json"});
    ASSERT_EQ(done.status, 0) << done.err;
    const Json stated = Json::parse(done.out);
    EXPECT_EQ(stated["points_read"], 40000);
    const auto kept = stated["points_written"].get<int>();
    EXPECT_LE(kept, 5000);
    EXPECT_GE(kept, 3500);
    EXPECT_NEAR(stated["spacing_m"].get<double>(), 20.0 / std::sqrt(kept), 0.1);
    const Json file = info("out." + ending);
    EXPECT_EQ(file["scans"][0]["points"], kept) << ending;
    EXPECT_NE(file["fields"].dump().find("\"label\""), std::string::npos) << ending;
  }
}

TEST_F(CloudsTest, ThinGivesTheSameBytesForAnyNumberOfThreads) {
  write_floor("floor.csv", 200);
  ASSERT_EQ(run({"thin", "floor.csv", "one.ply", "--points", "3000", "--threads", "1"}).status, 0);
  ASSERT_EQ(run({"thin", "floor.csv", "four.ply", "--points", "3000", "--threads", "4"}).status, 0);
  EXPECT_EQ(read_whole(work() / "one.ply"), read_whole(work() / "four.ply"));
}

TEST_F(CloudsTest, ThinOfFewPointsKeepsThemAll) {
  write_floor("floor.csv", 20);
  ASSERT_EQ(run({"thin", "floor.csv", "all.ply", "--points", "1000"}).status, 0);
  EXPECT_EQ(info("all.ply")["scans"][0]["points"], 400);
}

TEST_F(CloudsTest, ThinToE57KeepsEachScanAndItsScanner) {
  std::string text;
  for (const int x : {1000, 1030}) {
    text += "40\n20\n" + std::to_string(x) + " 2000 50\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" +
            std::to_string(x) + " 2000 50 1\n";
    for (int i = 0; i < 800; ++i)
      text += std::to_string(0.2 * (i % 20)) + " " + std::to_string(0.1 * static_cast<int>(i / 20)) +
              " -1.5 0.5\n";
  }
  write_whole(work() / "two.ptx", text);
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--points", "600"}, {"--spacing-m", "0.3"}, {"--points", "10000"}}) {
    ASSERT_EQ(run({"thin", "two.ptx", "two.e57", how[0], how[1]}).status, 0);
    const Json scans = info("two.e57")["scans"];
    ASSERT_EQ(scans.size(), 2U) << how[1];
    int points = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(scans[k]["scanner"]["place"][0], k == 0 ? 1000.0 : 1030.0);
      points += scans[k]["points"].get<int>();
    }
    EXPECT_LE(points, how[1] == "600" ? 600 : how[1] == "0.3" ? 800 : 1600) << how[1];
    EXPECT_GE(points, how[1] == "10000" ? 1600 : 300) << how[1];
  }
}

TEST_F(CloudsTest, WhatHasNoTimesHasNoneAfterwards) {
  write_whole(work() / "corner.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 0\n");
  for (const std::string ending : {"las", "laz", "e57", "ply"}) {
    ASSERT_EQ(run({"thin", "corner.xyz", "out." + ending, "--points", "9"}).status, 0);
    const std::string text = info("out." + ending).dump();
    EXPECT_EQ(text.find("\"time\""), std::string::npos) << text;
    EXPECT_EQ(text.find("GPS times"), std::string::npos) << text;
  }
}

TEST_F(CloudsTest, OneScanOfAPtxIsNotWrittenAsPtx) {
  write_whole(work() / "pose.txt", kShifted);
  const std::string scan =
      "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n2 2 3 0.5\n";
  write_whole(work() / "two.ptx", scan + scan);
  const ProgramRun part = run({"transform", "pose.txt", "two.ptx #1", "one.ptx"});
  EXPECT_EQ(part.status, 2);
  EXPECT_NE(part.err.find("move the whole file alone"), std::string::npos) << part.err;
  EXPECT_EQ(run({"transform", "pose.txt", "two.ptx", "both.ptx"}).status, 0);
}

TEST_F(CloudsTest, ThinSaysThatTheMemoryAllowsFewerThanAsked) {
  write_floor("floor.csv", 300);
  const ProgramRun small = run({"thin", "floor.csv", "out.ply", "--points", "80000", "--memory", "1M"});
  EXPECT_NE(small.err.find("--memory 1M allows no more"), std::string::npos) << small.err;
  const ProgramRun large = run({"thin", "floor.csv", "out.ply", "--points", "80000", "--memory", "1G"});
  EXPECT_EQ(large.err.find("--memory"), std::string::npos) << large.err;
}

TEST_F(CloudsTest, ThinSaysWhatIsWrong) {
  write_floor("floor.csv", 20);
  EXPECT_NE(run({"thin", "floor.csv", "out.ply"}).err.find("--points"), std::string::npos);
  EXPECT_NE(run({"thin", "floor.csv", "out.pcd", "--points", "10"}).err.find("name the output .ply"),
            std::string::npos);
  EXPECT_NE(run({"thin", "floor.csv", "floor.csv", "--points", "10"}).err.find("overwrite the input"),
            std::string::npos);
  EXPECT_NE(run({"thin", "floor.csv", "out.ply", "--memory", "much"}).err.find("--memory"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(work() / "out.ply"));
}

TEST_F(CloudsTest, AScanLargerThanItsMemoryIsThinnedAndTellsSo) {
  write_floor("floor.csv", 300);
  const ProgramRun whole = run({"planes", "floor.csv", "-o", "whole.json", "--memory", "1G"});
  EXPECT_EQ(whole.err.find("thinned"), std::string::npos) << whole.err;
  const ProgramRun small = run({"planes", "floor.csv", "-o", "small.json", "--memory", "1M"});
  EXPECT_EQ(small.status, 0) << small.err;
  EXPECT_NE(small.err.find("thinned from 90000 points to"), std::string::npos) << small.err;
  const ProgramRun stated = run({"info", "floor.csv", "--memory", "1M", "--json"});
  EXPECT_LT(Json::parse(stated.out)["scans"][0]["points"].get<int>(), 20000);
}

TEST_F(CloudsTest, TransformThereAndBackInEachFormat) {
  write_floor("floor.csv", 30);
  write_whole(work() / "pose.txt", kShifted);
  for (const std::string ending : {"ply", "las", "laz", "copc.laz", "e57"}) {
    const std::string there = "there." + ending;
    ASSERT_EQ(run({"transform", "pose.txt", "floor.csv", there}).status, 0) << ending;
    EXPECT_NEAR(info(there)["scans"][0]["low"][0].get<double>(), 1000.25, 1e-4) << ending;
    // Its own format now, and back.
    ASSERT_EQ(run({"transform", "pose.txt", there, "back." + ending, "--invert"}).status, 0) << ending;
    const Json back = info("back." + ending);
    EXPECT_NEAR(back["scans"][0]["low"][0].get<double>(), 0.0, 1e-4) << ending;
    EXPECT_EQ(back["scans"][0]["points"], 900) << ending;
    EXPECT_NE(back["fields"].dump().find("\"label\""), std::string::npos) << ending;
    EXPECT_EQ(back["format"].dump().find("COPC") != std::string::npos, ending == "copc.laz");
  }
  EXPECT_NE(
      run({"transform", "pose.txt", "floor.csv", "out.pcd"}).err.find(".ply, .las, .laz, .e57, .xyz or .csv"),
      std::string::npos);
}

TEST_F(CloudsTest, MergeWritesOneCloudOfAll) {
  write_floor("floor.csv", 30);
  write_whole(work() / "more.xyz", "1 2 3 0.5\n4 5 6 0.75\n");
  write_whole(work() / "pose.txt", kShifted);
  const ProgramRun done = run({"transform", "pose.txt", "floor.csv", "all.las", "--merge", "more.xyz",
                               "--merge", "floor.csv", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(Json::parse(done.out)["points"], 1802);
  const Json all = info("all.las");
  EXPECT_EQ(all["scans"][0]["points"], 1802);
  EXPECT_NE(all["fields"].dump().find("\"source_cloud\""), std::string::npos);
  EXPECT_NEAR(all["scans"][0]["low"][0].get<double>(), 0.0, 1e-4);
  EXPECT_GT(all["scans"][0]["high"][0].get<double>(), 1010.0);
}

TEST_F(CloudsTest, ATrajectoryGivesTheOpticalCentres) {
  write_floor("floor.csv", 30);
  write_whole(work() / "drive.csv", "time,x,y,z\n99,0,-5,2\n100,0,-5,2\n101,20,-5,2\n");
  const ProgramRun done = run({"info", "floor.csv", "--trajectory", "drive.csv", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(Json::parse(done.out)["scans"][0]["optical_centre"], "per point");
  const ProgramRun late =
      run({"info", "floor.csv", "--trajectory", "drive.csv", "--trajectory-time-offset-s", "500"});
  EXPECT_EQ(late.status, 2);
  EXPECT_NE(late.err.find("100.000 to 100.899 s"), std::string::npos) << late.err;
  EXPECT_NE(late.err.find("599.000 to 601.000 s"), std::string::npos) << late.err;
  const ProgramRun arm = run({"info", "floor.csv", "--trajectory", "drive.csv", "--lever-arm", "1,0,0"});
  EXPECT_NE(arm.err.find("no attitude"), std::string::npos) << arm.err;
}

}  // namespace
}  // namespace limen
