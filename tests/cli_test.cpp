// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// The command line as a script meets it: statuses, what goes to stdout, what to stderr.
#include <array>
#include <cmath>
#include <sstream>

#include "run_program.h"
#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

constexpr const char* kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
constexpr const char* kShiftedPose = "1 0 0 0.25\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class CliTest : public ProgramTest {
 protected:
  /// An empty room of 5 m x 4 m x 3 m seen from its middle: points every 5 cm on six faces.
  void write_room(const std::string& name) const {
    std::string text;
    const double size[3] = {5.0, 4.0, 3.0};
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (double a = 0.025; a < size[u]; a += 0.05) {
        for (double b = 0.025; b < size[v]; b += 0.05) {
          for (const double side : {-0.5, 0.5}) {
            double x[3];
            x[axis] = side * size[axis];
            x[u] = a - 0.5 * size[u];
            x[v] = b - 0.5 * size[v];
            text += std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
          }
        }
      }
    }
    write_whole(work() / name, text);
  }
};

/// A wall at x = 2.5 m with a window of 1.2 m x 1.4 m about its middle, and what is seen through it; all
/// moved along x by `shift_m`.
std::string window_room(double shift_m) {
  std::string text;
  for (double y = -2.0; y < 2.0; y += 0.025) {
    for (double z = -1.5; z < 1.5; z += 0.025) {
      const double share = std::abs(y) < 0.6 && std::abs(z) < 0.7 ? 2.0 : 1.0;
      text += std::to_string(2.5 * share + shift_m) + " " + std::to_string(share * y) + " " +
              std::to_string(share * z) + "\n";
      text += std::to_string(-2.5 + shift_m) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  }
  return text;
}

TEST_F(CliTest, HelpEverywhere) {
  const ProgramRun all = run({"--help"});
  EXPECT_EQ(all.status, 0);
  EXPECT_EQ(all.err, "");
  for (const std::string command :
       {"info", "planes", "openings", "register", "transform", "simulate", "evaluate"}) {
    EXPECT_NE(all.out.find("\n  " + command), std::string::npos) << command;
    const ProgramRun help = run({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    for (const std::string option : {"--quiet", "--json", "--threads", "--seed", "--help"}) {
      EXPECT_NE(help.out.find(option), std::string::npos) << command << " " << option;
    }
  }
}

TEST_F(CliTest, HelpAndVersionComeByEitherName) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "register"}).out, run({"register", "--help"}).out);
  EXPECT_EQ(run({"-V"}).out, run({"--version"}).out);
}

TEST_F(CliTest, MillimetresAgainstMillimetres) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "40000"}).status, 0);
  write_whole(work() / "thousand.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  for (const char* name : {"indoor_00", "indoor_01"}) {
    const std::string metres = std::string(name) + ".csv";
    ASSERT_EQ(run({"transform", "thousand.txt", std::string("room/") + name + ".ply", metres}).status, 0);
    std::istringstream rows(read_whole(work() / metres));
    std::string line;
    std::getline(rows, line);
    std::string scaled;
    double x = 0;
    double y = 0;
    double z = 0;
    char comma = 0;
    while (std::getline(rows, line)) {
      std::istringstream(line) >> x >> comma >> y >> comma >> z;
      scaled +=
          std::to_string(1000 * x) + " " + std::to_string(1000 * y) + " " + std::to_string(1000 * z) + "\n";
    }
    write_whole(work() / (std::string(name) + ".xyz"), scaled);
  }
  ASSERT_EQ(run({"register", "indoor_00.xyz", "indoor_01.xyz", "-o", "out", "--source-units", "mm",
                 "--target-units", "mm"})
                .status,
            0);
  ASSERT_EQ(run({"transform", "out/result.json", "indoor_00.xyz", "moved.xyz"}).status, 0);
  const auto side = [&](const char* file) {
    return nlohmann::json::parse(run({"info", file, "--json"}).out)["scans"][0];
  };
  // Both clouds are in millimetres and lie on one another.
  const auto moved = side("moved.xyz");
  EXPECT_EQ(moved["points"], side("indoor_00.xyz")["points"]);
  std::istringstream matrix(read_whole(work() / "out/transform.txt"));
  std::array<double, 16> numbers{};
  for (double& number : numbers) matrix >> number;
  const auto pose = nlohmann::json::parse(read_whole(work() / "out/result.json"))["target_from_source"];
  EXPECT_NEAR(numbers[3], 1000 * pose[0][3].get<double>(), 1e-6);
  EXPECT_EQ(numbers[0], pose[0][0].get<double>());
  std::istringstream before(read_whole(work() / "indoor_00.xyz"));
  std::istringstream after(read_whole(work() / "moved.xyz"));
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  before >> from.x() >> from.y() >> from.z();
  after >> to.x() >> to.y() >> to.z();
  const double expected = numbers[0] * from.x() + numbers[1] * from.y() + numbers[2] * from.z() + numbers[3];
  EXPECT_NEAR(to.x(), expected, 1e-3);
}

TEST_F(CliTest, Version) {
  const ProgramRun done = run({"--version"});
  EXPECT_EQ(done.status, 0);
  EXPECT_EQ(done.out.rfind("limen ", 0), 0U);
  EXPECT_EQ(done.err, "");
}

TEST_F(CliTest, EvaluateTellsAKnownError) {
  write_whole(work() / "found.txt", kShiftedPose);
  write_whole(work() / "true.txt", kIdentity);
  const ProgramRun done = run({"evaluate", "found.txt", "true.txt", "--json"});
  EXPECT_EQ(done.status, 0);
  EXPECT_EQ(done.err, "");
  const Json json = Json::parse(done.out);
  EXPECT_NEAR(json["translation_error_m"].get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(json["rotation_error_deg"].get<double>(), 0.0, 1e-9);
}

TEST_F(CliTest, CommonOptionsMayStandBeforeOrAfterTheCommand) {
  write_whole(work() / "pose.txt", kIdentity);
  const ProgramRun before = run({"--json", "--threads", "1", "evaluate", "pose.txt", "pose.txt"});
  const ProgramRun after = run({"evaluate", "pose.txt", "pose.txt", "--threads", "1", "--json"});
  EXPECT_EQ(before.status, 0);
  EXPECT_TRUE(Json::accept(before.out)) << before.out;
  EXPECT_EQ(before.out, after.out);
}

TEST_F(CliTest, QuietSaysNothing) {
  write_whole(work() / "pose.txt", kIdentity);
  const ProgramRun done = run({"evaluate", "pose.txt", "pose.txt", "--quiet"});
  EXPECT_EQ(done.status, 0);
  EXPECT_EQ(done.out + done.err, "");
}

TEST_F(CliTest, AResultThatCannotBeStatedIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this machine has no /dev/full";
  write_whole(work() / "pose.txt", kIdentity);
  const std::string command = std::string(LIMEN_PROGRAM) + " evaluate " + (work() / "pose.txt").string() +
                              " " + (work() / "pose.txt").string() + " > /dev/full 2> /dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
}

TEST_F(CliTest, PlanesOfARoomAreSix) {
  write_room("room.xyz");
  const ProgramRun done = run({"planes", "room.xyz", "-o", "planes.json", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.err, "") << "not a terminal, so no progress";
  EXPECT_EQ(done.out, read_whole(work() / "planes.json"));
  const Json json = Json::parse(done.out);
  ASSERT_EQ(json["planes"].size(), 6U);
  for (const Json& plane : json["planes"]) {
    EXPECT_LT(plane["rms_m"].get<double>(), 1e-4);
    EXPECT_EQ(plane["outline"].size(), 1U) << "no holes";
  }
}

TEST_F(CliTest, OpeningsOfAWallWithOneWindowAreOne) {
  write_whole(work() / "wall.xyz", window_room(0.0));
  const ProgramRun done =
      run({"openings", "wall.xyz", "-o", "openings.json", "--origin", "0,0,0", "--json", "--quiet"});
  EXPECT_EQ(done.status, 0);
  EXPECT_EQ(done.err, "");
  EXPECT_EQ(done.out, read_whole(work() / "openings.json"));
  const Json json = Json::parse(done.out);
  ASSERT_EQ(json["openings"].size(), 1U);
  const Json& opening = json["openings"][0];
  EXPECT_EQ(opening["view"], "through");
  // Seen from the middle of the room, y runs to the left.
  const std::vector<std::vector<double>> corners = {
      {2.5, 0.6, -0.7}, {2.5, -0.6, -0.7}, {2.5, -0.6, 0.7}, {2.5, 0.6, 0.7}};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(opening["corners"][k][axis].get<double>(), corners[k][axis], 0.02) << k << " " << axis;
    EXPECT_LT(opening["edge_sigma_m"][k].get<double>(), 0.02);
  }
}

TEST_F(CliTest, OpeningsNeedThePlaceOfTheScanner) {
  write_whole(work() / "far.xyz", window_room(100.0));
  const ProgramRun done = run({"openings", "far.xyz", "-o", "openings.json"});
  EXPECT_EQ(done.status, 2);
  EXPECT_EQ(done.out, "");
  EXPECT_NE(done.err.find("--origin"), std::string::npos) << done.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "openings.json"));
}

TEST_F(CliTest, SameBytesForAnyNumberOfThreads) {
  write_room("room.xyz");
  ASSERT_EQ(run({"planes", "room.xyz", "-o", "one.json", "--threads", "1"}).status, 0);
  ASSERT_EQ(run({"planes", "room.xyz", "-o", "four.json", "--threads", "4"}).status, 0);
  EXPECT_EQ(read_whole(work() / "one.json"), read_whole(work() / "four.json"));
}

TEST_F(CliTest, RegisterWritesItsTwoFilesAndTheSameBytesEachTime) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "60000", "--seed", "5"}).status, 0);
  const std::vector<std::string> scans = {"room/indoor_00.ply", "room/indoor_01.ply"};
  const ProgramRun first = run({"register", scans[0], scans[1], "-o", "a", "--json", "--threads", "1"});
  const ProgramRun second = run({"register", scans[0], scans[1], "-o", "b", "--json", "--threads", "3"});
  EXPECT_EQ(first.err, "");
  Json one = Json::parse(first.out);
  Json two = Json::parse(second.out);
  EXPECT_EQ(first.out, read_whole(work() / "a" / "result.json"));
  ASSERT_EQ(first.status, 0) << first.out.substr(0, 300);
  EXPECT_EQ(one["outcome"], "registered");
  EXPECT_TRUE(one["stages"].contains("reading"));
  one.erase("stages");
  two.erase("stages");
  EXPECT_EQ(one, two) << "only the times may differ";
  EXPECT_EQ(read_whole(work() / "a" / "transform.txt"), read_whole(work() / "b" / "transform.txt"));

  const ProgramRun judged = run({"evaluate", "a/result.json", "room/truth/truth.json", "--json"});
  ASSERT_EQ(judged.status, 0) << judged.err;
  const Json error = Json::parse(judged.out);
  EXPECT_LT(error["translation_error_m"].get<double>(), 0.005);
  EXPECT_LT(error["rotation_error_deg"].get<double>(), 0.05);
}

TEST_F(CliTest, NoMatchTakesAwayTheTransformOfAnEarlierRun) {
  std::string line;
  for (int i = 0; i < 1000; ++i) line += std::to_string(0.01 * i) + " 0 0\n";
  write_whole(work() / "line.xyz", line);
  std::filesystem::create_directory(work() / "out");
  write_whole(work() / "out" / "transform.txt", kShiftedPose);
  const ProgramRun done = run({"register", "line.xyz", "line.xyz", "-o", "out"});
  EXPECT_EQ(done.status, 4) << done.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "out" / "transform.txt"));
  const Json json = Json::parse(read_whole(work() / "out" / "result.json"));
  EXPECT_EQ(json["outcome"], "no_match");
  EXPECT_TRUE(json["target_from_source"].is_null());
}

/// A result about line.xyz and plane.xyz: the identity, and one alternative 0.25 m along x.
class ResultChoiceTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    std::string line;
    for (int i = 0; i < 1000; ++i) line += std::to_string(0.01 * i) + " 0 0\n";
    write_whole(work() / "line.xyz", line);
    write_whole(work() / "other.xyz", line + "10 0 0\n");
    write_whole(work() / "third.xyz", line + "10 0 0\n10 0 1\n");
    ASSERT_EQ(run({"register", "line.xyz", "other.xyz", "-o", "out"}).status, 4);
    Json json = Json::parse(read_whole(work() / "out" / "result.json"));
    const Json identity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    json["outcome"] = "registered";
    json["target_from_source"] = identity;
    json["alternatives"] = Json::array({{{"target_from_source", identity}}});
    json["alternatives"][0]["target_from_source"][0][3] = 0.25;
    write_whole(work() / "result.json", json.dump());
  }
};

TEST_F(ResultChoiceTest, APoseMovesOnlyWhatItWasFoundFor) {
  EXPECT_EQ(run({"transform", "result.json", "line.xyz", "a.xyz"}).status, 0);
  const ProgramRun stranger = run({"transform", "result.json", "third.xyz", "b.xyz"});
  EXPECT_EQ(stranger.status, 2);
  EXPECT_NE(stranger.err.find("third.xyz"), std::string::npos) << stranger.err;
  EXPECT_NE(stranger.err.find("--force"), std::string::npos) << stranger.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "b.xyz"));
  EXPECT_EQ(run({"transform", "result.json", "third.xyz", "b.xyz", "--force"}).status, 0);
  const ProgramRun other_side = run({"transform", "result.json", "other.xyz", "c.xyz"});
  EXPECT_EQ(other_side.status, 2);
  EXPECT_NE(other_side.err.find("--invert"), std::string::npos) << other_side.err;
  EXPECT_EQ(run({"transform", "result.json", "other.xyz", "c.xyz", "--invert"}).status, 0);
}

TEST_F(ResultChoiceTest, AnAlternativeIsChosenByItsNumber) {
  ASSERT_EQ(run({"transform", "result.json", "line.xyz", "a.xyz", "--alternative", "1"}).status, 0);
  EXPECT_EQ(read_whole(work() / "a.xyz").substr(0, 4), "0.25");
  const ProgramRun none = run({"transform", "result.json", "line.xyz", "b.xyz", "--alternative", "2"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("holds 1 alternative, not 2"), std::string::npos) << none.err;
}

TEST_F(CliTest, InfoAnswersInJson) {
  write_room("room.xyz");
  const ProgramRun done = run({"info", "room.xyz", "--json"});
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.err, "");
  EXPECT_TRUE(Json::accept(done.out)) << done.out;
}

}  // namespace
}  // namespace limen
