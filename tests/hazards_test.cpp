// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// What a machine or a file can do to the program: no room on the disk, numbers that cannot be metres, a kill.
#include <ctime>
#include <string>

#include "run_program.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace limen {
namespace {

/// While it lives no file of this process and its children may grow beyond so many bytes, as on a full disk.
class LittleRoom {
 public:
  explicit LittleRoom(std::size_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit little = before_;
    little.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &little);
  }
  ~LittleRoom() { setrlimit(RLIMIT_FSIZE, &before_); }
  LittleRoom(const LittleRoom&) = delete;
  LittleRoom& operator=(const LittleRoom&) = delete;

 private:
  rlimit before_{};
};

/// The lines of a box as OBJ, its 12 triangles; sides in the file's unit.
std::string box_as_obj(double x, double y, double z) {
  std::string text;
  for (int k = 0; k < 8; ++k)
    text += fmt::format("v {} {} {}\n", (k & 1) * x, (k >> 1 & 1) * y, (k >> 2 & 1) * z);
  return text +
         "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 "
         "8\nf 2 8 "
         "6\n";
}

/// Points on a wall and a floor, sides in the file's unit.
std::string corner_as_xyz(double side) {
  std::string text;
  for (int k = 0; k < 900; ++k) {
    const double u = side * (k % 30) / 29.0;
    const double v = side * (k / 30) / 29.0;
    text += fmt::format("{} {} 0\n0 {} {}\n{} 0 {}\n", u, v, u, v, u, v);
  }
  return text;
}

class HazardTest : public ProgramTest {
 protected:
  [[nodiscard]] std::size_t size_of(const std::string& name) const {
    return read_whole(work() / name).size();
  }
  [[nodiscard]] std::size_t files_in(const std::string& folder) const {
    const std::filesystem::directory_iterator begin(work() / folder);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }
};

TEST_F(HazardTest, WhereTheReportHasNoRoomTheNumbersAreThere) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "40000"}).status, 0);
  const std::vector<std::string> command = {"register", "room/indoor_00.ply", "room/indoor_01.ply", "-o",
                                            "out"};
  ASSERT_EQ(run(command).status, 0);
  const std::size_t numbers = size_of("out/result.json");
  ASSERT_LT(2 * numbers, size_of("out/report.html"));
  const std::string transform = read_whole(work() / "out/transform.txt");
  ProgramRun full;
  {
    const LittleRoom room(numbers + numbers / 2);
    full = run(command);
  }
  EXPECT_EQ(full.status, 0) << full.err;
  EXPECT_NE(full.err.find("warning: the report could not be written"), std::string::npos) << full.err;
  EXPECT_NE(full.err.find("result.json and transform.txt are complete"), std::string::npos) << full.err;
  EXPECT_EQ(nlohmann::json::parse(read_whole(work() / "out/result.json"))["outcome"], "registered");
  EXPECT_EQ(read_whole(work() / "out/transform.txt"), transform);
  EXPECT_EQ(files_in("out"), 2U);  // neither the earlier report nor half of a new one
}

TEST_F(HazardTest, WhereNotEvenTheNumbersHaveRoomTheEarlierOnesStay) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "40000"}).status, 0);
  const std::vector<std::string> command = {"register", "room/indoor_00.ply", "room/indoor_01.ply", "-o",
                                            "out",      "--no-report"};
  ASSERT_EQ(run(command).status, 0);
  const std::string json = read_whole(work() / "out/result.json");
  const std::string transform = read_whole(work() / "out/transform.txt");
  ProgramRun full;
  {
    const LittleRoom room(1024);
    full = run(command);
  }
  EXPECT_EQ(full.status, 2) << full.err;
  EXPECT_NE(full.err.find("result.json: cannot be"), std::string::npos) << full.err;
  EXPECT_EQ(read_whole(work() / "out/result.json"), json);
  EXPECT_EQ(read_whole(work() / "out/transform.txt"), transform);
  EXPECT_EQ(files_in("out"), 2U);
}

TEST_F(HazardTest, AModelInMillimetresIsRefusedAtOnce) {
  write_whole(work() / "model.obj", box_as_obj(10000.0, 8000.0, 3000.0));
  write_whole(work() / "scan.xyz", corner_as_xyz(3.0));
  const ProgramRun refused = run({"register", "scan.xyz", "model.obj", "-o", "out"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("are they millimetres?"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("model.obj"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "out"));
}

TEST_F(HazardTest, AScanInMillimetresOrKilometresIsRefusedAtOnce) {
  write_whole(work() / "model.obj", box_as_obj(10.0, 8.0, 3.0));
  for (const double side : {3000.0, 0.003}) {
    write_whole(work() / "scan.xyz", corner_as_xyz(side));
    const ProgramRun refused = run({"register", "scan.xyz", "model.obj", "-o", "out"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find(side > 1.0 ? "are they millimetres?" : "are they kilometres?"),
              std::string::npos)
        << refused.err;
    EXPECT_NE(refused.err.find("scan.xyz"), std::string::npos) << refused.err;
  }
}

}  // namespace
}  // namespace limen
