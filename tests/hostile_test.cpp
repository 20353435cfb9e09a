// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Files, folders and words of somebody who does not mean well: one error, or a result that does no harm
// elsewhere.
#include <algorithm>
#include <string>

#include "run_program.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

namespace limen {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTurned = "\xe2\x80\xae";  // U+202E

class HostileTest : public ProgramTest {
 protected:
  void expect_one_error(const std::vector<std::string>& arguments, const std::string& words) const {
    const ProgramRun done = run(arguments);
    EXPECT_EQ(done.status, 2) << arguments.front() << ": " << done.err;
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    EXPECT_NE(done.err.find(words), std::string::npos) << done.err;
  }
  /// Points on a floor and two walls.
  void write_corner(const std::string& name) const {
    std::string text;
    for (int k = 0; k < 900; ++k) {
      const double u = 0.1 * (k % 30);
      const double v = 0.1 * (k / 30);
      text += fmt::format("{} {} 0\n0 {} {}\n{} 0 {}\n", u, v, u, v, u, v);
    }
    write_whole(work() / name, text);
  }
};

TEST_F(HostileTest, JsonOfAnyDepthIsOneError) {
  constexpr int kDepth = 130000;
  const std::string deep = std::string(kDepth, '[') + std::string(kDepth, ']');
  write_corner("scan.xyz");
  write_corner("other.xyz");
  write_whole(work() / "deep.json", "{\"scans\": " + deep + ", \"links\": []}");
  write_whole(work() / "decide.json", "{\"decisions\": " + deep + "}");
  write_whole(work() / "segments.json", "{\"segments\": " + deep + "}");
  fs::create_directories(work() / "project" / "store");
  write_whole(work() / "project" / "store" / "status.json", deep);
  expect_one_error({"transform", "deep.json", "scan.xyz", "out.xyz"}, "deep.json");
  expect_one_error({"view", "deep.json", "-o", "out.html"}, "deep.json");
  expect_one_error({"deviation", "scan.xyz", "other.xyz", "--result", "deep.json", "-o", "out"}, "deep.json");
  expect_one_error({"evaluate", "deep.json", "deep.json"}, "deep.json");
  expect_one_error({"project", "scan.xyz", "other.xyz", "--decide", "decide.json", "-o", "out"},
                   "decide.json");
  expect_one_error({"project", "status", "project"}, "status.json");
  expect_one_error({"register", "segments.json", "segments.json", "-o", "out"}, "segments.json");
  EXPECT_FALSE(fs::exists(work() / "out"));
}

TEST_F(HostileTest, OneRunAtATimeInAFolder) {
  write_corner("a.xyz");
  write_corner("b.xyz");
  fs::create_directories(work() / "out");
  const int lock = open((work() / "out" / ".limen-lock").c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  expect_one_error({"project", "a.xyz", "b.xyz", "-o", "out"}, "another limen is working in this folder");
  EXPECT_FALSE(fs::exists(work() / "out" / "store"));
  close(lock);
  EXPECT_NE(run({"project", "a.xyz", "b.xyz", "-o", "out"}).status, 2);
  EXPECT_FALSE(fs::exists(work() / "out" / ".limen-lock"));
}

TEST_F(HostileTest, LongWordsAreShortenedInMessages) {
  const std::string word(5000, 'x');
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{word},
                                             {"--" + word},
                                             {"info", "--" + word},
                                             {"info", word},
                                             {"serve", "out", "--most-upload", word},
                                             {"register", "a", "b", "-o", "out", "--source-units", word}}) {
    const ProgramRun done = run(arguments);
    EXPECT_EQ(done.status, 2);
    EXPECT_LT(done.err.size(), 1100U) << arguments.front().substr(0, 20);
    EXPECT_NE(done.err.find("xx [4"), std::string::npos) << done.err;
  }
}

TEST_F(HostileTest, NamesThatTurnALineRoundAreEscaped) {
  const std::string name = std::string("scan") + kTurned + "zyx.xyz";
  write_corner(name);
  const ProgramRun missing = run({"info", std::string("no") + kTurned + ".ply"});
  EXPECT_NE(missing.err.find("no\\u202E.ply"), std::string::npos) << missing.err;
  const ProgramRun stated = run({"info", name});
  EXPECT_EQ(stated.status, 0) << stated.err;
  EXPECT_EQ(stated.out.find(kTurned), std::string::npos);
  ASSERT_EQ(run({"view", name, "-o", "view.html"}).status, 0);
  const std::string page = read_whole(work() / "view.html");
  EXPECT_EQ(page.find(kTurned), std::string::npos);
  EXPECT_NE(page.find("\\u202Ezyx"), std::string::npos);
}

TEST_F(HostileTest, ANameIsNoFormulaInATable) {
  // Columns of a cloud are named by its file.
  write_whole(
      work() / "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float =cmd|calc\nend_header\n0 0 0 1\n1 1 1 2\n");
  write_whole(work() / "pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ASSERT_EQ(run({"transform", "pose.txt", "a.ply", "a.csv"}).status, 0);
  EXPECT_EQ(read_whole(work() / "a.csv").substr(0, 17), "x,y,z,'=cmd|calc\n");
}

}  // namespace
}  // namespace limen
