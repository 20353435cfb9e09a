// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Files that no scanner and no modeller writes, but a damaged disk, a wrong export or an enemy: one clear
// error, little memory, no fault of limen.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "run_program.h"
#include "support/sanitizers.h"
#include "support/synthetic_laz.h"
#include "support/test_support.h"
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "limen/files/zip.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

/// While it lives this process and its children may have no more memory than so many bytes. A sanitizer
/// takes far more for itself: there it does nothing.
class LittleMemory {
 public:
  explicit LittleMemory(std::size_t bytes) {
    getrlimit(RLIMIT_AS, &before_);
#if !defined(LIMEN_SANITIZES_ADDRESSES) && !defined(LIMEN_SANITIZES_THREADS)
    rlimit little = before_;
    little.rlim_cur = bytes;
    setrlimit(RLIMIT_AS, &little);
#else
    static_cast<void>(bytes);
#endif
  }
  ~LittleMemory() {
    setrlimit(RLIMIT_AS, &before_);
  }
  LittleMemory(const LittleMemory&) = delete;
  LittleMemory& operator=(const LittleMemory&) = delete;

 private:
  rlimit before_{};
};

constexpr std::size_t kGigabyte = std::size_t{1} << 30U;

class HostileFiles : public ProgramTest {
 protected:
  void write(const std::string& name, const std::string& bytes) const { write_whole(work() / name, bytes); }

  /// Runs with little memory, and on one thread, for each takes some.
  [[nodiscard]] ProgramRun run_small(std::vector<std::string> arguments) const {
    const LittleMemory memory(2 * kGigabyte);
    arguments.insert(arguments.end(), {"--threads", "1"});
    return run(arguments);
  }

  /// That the command says what is wrong with its file in one line, and what that line has in it.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& said) const {
    const ProgramRun done = run_small(arguments);
    EXPECT_EQ(done.status, 2) << arguments[0] << ": " << done.err;
    EXPECT_NE(done.err.find(said), std::string::npos) << arguments[0] << ": " << done.err;
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << arguments[0] << ": " << done.err;
  }

  /// Every command that takes a scan or a model and finds something in it.
  [[nodiscard]] static std::vector<std::vector<std::string>> commands_on(const std::string& file) {
    return {{"planes", file, "-o", "planes.json"},
            {"openings", file, "-o", "openings.json"},
            {"segments", file, "-o", "segments.json"},
            {"view", file, "-o", "view.html"}};
  }
};

/// A box as OBJ, its 12 triangles; `first`: vertices before it.
std::string box_as_obj(double x, double y, double z, int first) {
  static constexpr int kTriangles[12][3] = {{1, 3, 4}, {1, 4, 2}, {5, 6, 8}, {5, 8, 7}, {1, 2, 6}, {1, 6, 5},
                                            {3, 7, 8}, {3, 8, 4}, {1, 5, 7}, {1, 7, 3}, {2, 4, 8}, {2, 8, 6}};
  std::string text;
  for (int k = 0; k < 8; ++k)
    text += fmt::format("v {} {} {}\n", (k & 1) * x, (k >> 1 & 1) * y, (k >> 2 & 1) * z);
  for (const auto& corners : kTriangles)
    text += fmt::format("f {} {} {}\n", first + corners[0], first + corners[1], first + corners[2]);
  return text;
}

TEST_F(HostileFiles, AModelInMillimetresIsRefusedByEveryCommandThatWorksOnIt) {
  write("mm.obj", box_as_obj(8000, 5000, 3000, 0) + box_as_obj(12000, 200, 3000, 8));
  for (const std::vector<std::string>& command : commands_on("mm.obj")) {
    const ProgramRun done = run_small(command);
    EXPECT_EQ(done.status, 2) << command[0] << done.err;
    EXPECT_NE(done.err.find("are they millimetres?"), std::string::npos) << command[0] << done.err;
    EXPECT_NE(done.err.find("--units"), std::string::npos) << command[0] << done.err;
  }
  EXPECT_EQ(run_small({"info", "mm.obj"}).status, 0) << "what it measures may be asked";
  for (std::vector<std::string> command : commands_on("mm.obj")) {
    command.insert(command.end(), {"--units", "mm"});
    const ProgramRun done = run_small(command);
    EXPECT_EQ(done.status, 0) << command[0] << done.err;
  }
}

TEST_F(HostileFiles, SliversAsLongAsACountryAreRefused) {
  std::string text;
  for (int k = 0; k < 400; ++k)
    text += fmt::format("v 0 0 {0}\nv 90000 90000 {0}\nv 90000 90000.02 {0}\nf -3 -2 -1\n", k);
  write("slivers.obj", text);
  for (const std::vector<std::string>& command : commands_on("slivers.obj")) {
    const ProgramRun done = run_small(command);
    EXPECT_EQ(done.status, 2) << command[0] << done.err;
    EXPECT_NE(done.err.find("outlines"), std::string::npos) << command[0] << done.err;
  }
}

TEST_F(HostileFiles, PointsThatAllLieInOnePlaceAreStatedSo) {
  std::string text;
  for (int k = 0; k < 300000; ++k) text += "0 0 0\n";
  write("zeros.xyz", text);
  std::vector<std::vector<std::string>> commands = commands_on("zeros.xyz");
  commands.push_back({"info", "zeros.xyz"});
  commands.push_back({"register", "zeros.xyz", "zeros.xyz", "-o", "out"});
  for (const std::vector<std::string>& command : commands) {
    // What is drawn is thinned first, to one point of a place.
    if (command[0] == "view") {
      const int status = run_small(command).status;
      EXPECT_TRUE(status == 0 || status == 2) << status;
    } else {
      expect_refused(command, "all 300000 points have the same position");
    }
  }
  expect_refused({"project", "zeros.xyz", "-o", "project"}, "all 300000 points have the same position");
}

TEST_F(HostileFiles, PointsInTwoPlacesBringNoCommandDown) {
  std::string text;
  for (int k = 0; k < 300000; ++k) text += k % 2 == 0 ? "0 0 0\n" : "0.0001 0 0\n";
  write("two.xyz", text);
  std::vector<std::vector<std::string>> commands = commands_on("two.xyz");
  commands.push_back({"info", "two.xyz"});
  commands.push_back({"project", "two.xyz", "-o", "project"});
  for (const std::vector<std::string>& command : commands) {
    const ProgramRun done = run(command);
    EXPECT_TRUE(done.status == 0 || done.status == 2 || done.status == 4) << command[0] << done.err;
  }
}

TEST_F(HostileFiles, ACountThatTheFileHasNoRoomForIsRefused) {
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    for (const std::string count : {"9223372036854775807", "18446744073709551615", "4000000000"}) {
      write("count.ply",
            "ply\nformat " + format + " 1.0\nelement vertex " + count +
                "\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n4 5 6\n");
      expect_refused({"info", "count.ply"}, count);
    }
  }
  write("count.pcd",
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 9223372036854775807\nHEIGHT 1\n"
        "POINTS 9223372036854775807\nDATA ascii\n1 2 3\n");
  expect_refused({"info", "count.pcd"}, "9223372036854775807");
}

TEST_F(HostileFiles, ACountOfPackedPointsTakesNoMemoryBeforeTheyAreThere) {
  testing_las::Parts parts;
  parts.minor = 2;
  parts.format = 0;
  RandomStream random(3);
  for (int k = 0; k < 20000 * 20; ++k) parts.points += static_cast<char>(random.below(256));
  testing_laz::Packing packing;
  packing.one_run = true;
  std::string bytes = testing_laz::file(parts, packing);
  ASSERT_GT(bytes.size(), 100000U);
  testing_las::put(bytes, 107, static_cast<std::uint32_t>(4000 * 100000));
  write("count.laz", bytes);
  expect_refused({"info", "count.laz"}, "compressed chunk 1 of 1 is damaged");
}

TEST_F(HostileFiles, WhatIsNoFileIsNotWaitedFor) {
  ASSERT_EQ(mkfifo((work() / "pipe.ply").c_str(), 0600), 0);
  write("scan.xyz", "0 0 0\n1 1 1\n2 0 1\n");
  write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  for (const std::string name : {"pipe.ply", "/dev/zero", "/dev/null"}) {
    std::vector<std::vector<std::string>> commands = commands_on(name);
    commands.push_back({"info", name});
    commands.push_back({"register", name, name, "-o", "out"});
    commands.push_back({"project", name, "-o", "project"});
    commands.push_back({"transform", "pose.txt", name, "out.xyz"});
    commands.push_back({"transform", name, "scan.xyz", "out.xyz"});
    for (const std::vector<std::string>& command : commands) expect_refused(command, "is a pipe or a device");
  }
}

TEST_F(HostileFiles, AFaceThatCrossesItselfAMillionTimesIsLeftOut) {
  constexpr int kCorners = 40001;
  std::string text;
  std::string face = "f";
  for (int k = 0; k < kCorners; ++k) {
    // Each side goes nearly across the circle.
    const double angle = std::numbers::pi * (kCorners - 1.0) / kCorners * k;
    text += fmt::format("v {:.6f} {:.6f} 0\n", 10 * std::cos(angle), 10 * std::sin(angle));
    face += fmt::format(" {}", k + 1);
  }
  write("star.obj", text + face + "\n" + box_as_obj(4, 3, 2.5, kCorners));
  const ProgramRun done = run_small({"info", "star.obj", "--json"});
  EXPECT_EQ(done.status, 2) << done.out.substr(0, 2000);
  EXPECT_NE(done.err.find("cross one another more than"), std::string::npos) << done.err;
}

TEST_F(HostileFiles, ALineOfAMillionNumbersIsNoPoint) {
  std::string text;
  for (int k = 0; k < 1000000; ++k) text += "1.5 ";
  write("line.xyz", text + "\n");
  expect_refused({"info", "line.xyz"}, "a row of 1000000 numbers is not a point");
}

TEST_F(HostileFiles, AnArchiveThatBecomesAThousandTimesAsLargeIsRefused) {
  const std::string model = "ISO-10303-21;\n" + std::string(50000000, ' ') + "END-ISO-10303-21;\n";
  write("bomb.ifczip", zipped({{"model.ifc", model}}));
  expect_refused({"info", "bomb.ifczip"}, "would need 50 MB unpacked");
}

TEST_F(HostileFiles, PointsThatAreNoNumbersAreCountedInOneNote) {
  std::string half;
  std::string none;
  for (const Vector3d& x : testing_io::room_points(3000, 5)) {
    half += fmt::format("{} {} {}\nnan nan nan\n", x.x(), x.y(), x.z());
    none += "nan nan nan\n";
  }
  write("half.xyz", half);
  write("none.xyz", none);
  const std::string said =
      "3000 points have no finite coordinates below 100 000 km, or are 0 0 0 far from all others, and are "
      "left "
      "out; 3000 are kept";
  for (const std::vector<std::string>& command : commands_on("half.xyz")) {
    const ProgramRun done = run(command);
    const std::size_t at = done.err.find(said);
    ASSERT_NE(at, std::string::npos) << command[0] << done.err;
    EXPECT_EQ(done.err.find(said, at + 1), std::string::npos) << command[0] << done.err;
    EXPECT_NE(done.err.find("half.xyz"), std::string::npos) << command[0] << done.err;
  }
  const ProgramRun info = run({"info", "half.xyz"});
  EXPECT_NE(info.out.find(said), std::string::npos) << info.out;
  expect_refused({"planes", "none.xyz", "-o", "planes.json"}, "no usable points");
}

TEST_F(HostileFiles, WhereNoPointLiesOnTheModelTheStatusSaysSo) {
  std::string far;
  for (const Vector3d& x : testing_io::room_points(5000, 7))
    far += fmt::format("{} {} {}\n", x.x() + 500, x.y(), x.z());
  write("far.xyz", far);
  write("house.obj", box_as_obj(8, 6, 3, 0));
  const ProgramRun done = run({"deviation", "far.xyz", "house.obj", "--identity", "-o", "checked"});
  EXPECT_EQ(done.status, 4) << done.err;
  EXPECT_NE(done.err.find("no point lies on a face of the model"), std::string::npos) << done.err;
  EXPECT_TRUE(fs::exists(work() / "checked/deviation.json"));
}

TEST_F(HostileFiles, AStoreWhoseEntriesWereExchangedIsMadeAnew) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "40000"}).status, 0);
  const std::vector<std::string> command = {"project", "room/indoor_00.ply", "room/indoor_01.ply", "-o",
                                            "out"};
  const ProgramRun first = run(command);
  ASSERT_EQ(first.err.find("a bad entry of the store"), std::string::npos) << first.err;
  const std::string result = read_whole(work() / "out/project.json");
  for (const std::string room : {"files", "features", "digests", "pictures"}) {
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(work() / "out/store" / room))
      entries.push_back(entry.path());
    ASSERT_EQ(entries.size(), 2U) << room;
    fs::rename(entries[0], entries[0].string() + "~");
    fs::rename(entries[1], entries[0]);
    fs::rename(entries[0].string() + "~", entries[1]);
    const ProgramRun again = run(command);
    EXPECT_EQ(again.status, first.status) << room << again.err;
    for (const fs::path& entry : entries) {
      EXPECT_NE(
          again.err.find(fmt::format("{}: a bad entry of the store, made again", entry.filename().string())),
          std::string::npos)
          << room << again.err;
    }
    EXPECT_EQ(read_whole(work() / "out/project.json"), result) << room;
    EXPECT_EQ(run(command).err.find("a bad entry of the store"), std::string::npos) << room;
  }
}

}  // namespace
}  // namespace limen
