// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Whatever the user gets wrong: one line that says so, the status of the contract, and nothing written.
#include <algorithm>
#include <functional>
#include <ostream>

#include "run_program.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

/// Points of the square [0, 10) x [0, 10), heights by `height`, as text.
std::string grid_text(int side, const std::function<double(int, int)>& height) {
  std::string text;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      text += std::to_string(10.0 * i / side) + " " + std::to_string(10.0 * j / side) + " " +
              std::to_string(height(i, j)) + "\n";
    }
  }
  return text;
}

std::string ply_text(const std::string& format, long points, const std::string& body) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + body;
}

std::string repeated(const std::string& line, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += line;
  return text;
}

/// Names a case of a table in the test's own name.
constexpr auto name_of_case = [](const auto& tested) { return tested.param.name; };

struct BadFile {
  std::string name;
  std::string file;
  std::string contents;
};

std::vector<BadFile> bad_files() {
  return {
      {"Empty", "a.ply", ""},
      {"EmptyText", "a.xyz", ""},
      {"UnknownFormat", "a.docx", "PK\x03\x04 some other thing \x01\x02\xff"},
      {"WordsOnly", "a.txt", "there is no point in this\nnor in that\n"},
      {"CutPlyHeader", "a.ply", "ply\nformat ascii 1.0\nelement ver"},
      {"CutBinaryPly", "a.ply", ply_text("binary_little_endian", 100, std::string(12 * 50, 'x'))},
      {"PromisesMoreAscii", "a.ply", ply_text("ascii", 5, "0 0 0\n1 0 0\n0 1 0\n")},
      {"PromisesTheMoon", "a.ply", ply_text("binary_little_endian", 4000000000000000000L, "xyz")},
      {"NegativeCount", "a.ply", ply_text("ascii", -5, "0 0 0\n")},
      {"PlyWithoutZ", "a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"},
      {"UnknownPlyType", "a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nproperty float y\nproperty float "
       "z\nend_header\n0 "
       "0 0\n"},
      {"NoPoints", "a.ply", ply_text("ascii", 0, "")},
      {"OnlyNan", "a.ply", ply_text("ascii", 3, "nan nan nan\nnan nan nan\nnan nan nan\n")},
      {"OnlyInfinite", "a.xyz", "inf 0 0\n0 -inf 0\n0 0 inf\n"},
      {"TwoNumbersPerLine", "a.xyz", "1 2\n3 4\n5 6\n"},
      {"CutPcd", "a.pcd",
       "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1000\nHEIGHT 1\n"
       "POINTS 1000\nDATA binary\nxxxxxxxxxxxx"},
      {"CutPtx", "a.ptx", "100\n100\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n"},
  };
}

void PrintTo(const BadFile& tested, std::ostream* stream) {
  *stream << tested.name;
}

class BadFileTest : public ProgramTest, public testing::WithParamInterface<BadFile> {};

/// One line, that begins as every error of the program does and names `must_name`.
void expect_one_error(const ProgramRun& done, int status, const std::string& must_name) {
  EXPECT_EQ(done.status, status) << done.err;
  EXPECT_EQ(done.out, "");
  EXPECT_EQ(done.err.rfind("limen: error: ", 0), 0U) << done.err;
  EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  EXPECT_NE(done.err.find(must_name), std::string::npos) << done.err;
  EXPECT_EQ(done.err.find("please report"), std::string::npos) << done.err;
}

TEST_P(BadFileTest, PlanesRefusesIt) {
  write_whole(work() / GetParam().file, GetParam().contents);
  expect_one_error(run({"planes", GetParam().file, "-o", "planes.json"}), 2, GetParam().file);
  EXPECT_FALSE(fs::exists(work() / "planes.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(work()), fs::directory_iterator()), 1)
      << "something was left";
}

TEST_P(BadFileTest, RegisterRefusesIt) {
  write_whole(work() / GetParam().file, GetParam().contents);
  write_whole(work() / "good.xyz", grid_text(100, [](int i, int) { return i < 50 ? 0.0 : 2.0; }));
  expect_one_error(run({"register", "good.xyz", GetParam().file, "-o", "out"}), 2, GetParam().file);
  EXPECT_FALSE(fs::exists(work() / "out"));
}

TEST_P(BadFileTest, InfoRefusesIt) {
  write_whole(work() / GetParam().file, GetParam().contents);
  expect_one_error(run({"info", GetParam().file}), 2, GetParam().file);
}

INSTANTIATE_TEST_SUITE_P(Files, BadFileTest, testing::ValuesIn(bad_files()), name_of_case);

struct PoorCloud {
  std::string name;
  std::string contents;
};

std::vector<PoorCloud> poor_clouds() {
  std::string line;
  for (int i = 0; i < 5000; ++i) line += std::to_string(0.01 * i) + " 0 0\n";
  return {
      {"OnePoint", "1 2 3\n"},
      {"ThreePoints", "0 0 0\n1 0 0\n0 1 0\n"},
      {"OneLine", line},
      {"OnePlane", grid_text(100, [](int, int) { return 0.0; })},
      {"Duplicates", repeated("1 2 3\n", 5000)},
      {"AbsurdExtent", grid_text(60, [](int, int) { return 0.0; }) + "1e300 0 0\n0 1e300 0\n"},
      {"FarStray", grid_text(60, [](int, int) { return 0.0; }) + "9e12 0 0\n"},
  };
}

void PrintTo(const PoorCloud& tested, std::ostream* stream) {
  *stream << tested.name;
}

class PoorCloudTest : public ProgramTest, public testing::WithParamInterface<PoorCloud> {};

TEST_P(PoorCloudTest, PlanesGivesAListOrOneError) {
  write_whole(work() / "a.xyz", GetParam().contents);
  const ProgramRun done = run({"planes", "a.xyz", "-o", "planes.json"});
  if (done.status == 0) {
    EXPECT_TRUE(fs::exists(work() / "planes.json"));
  } else {
    expect_one_error(done, 2, "a.xyz");
  }
}

/// Too little to register by: an error or a named outcome, never a pose that calls itself right.
TEST_P(PoorCloudTest, RegisterNeverCallsItRegistered) {
  write_whole(work() / "a.xyz", GetParam().contents);
  write_whole(work() / "b.xyz", GetParam().contents);
  const ProgramRun done = run({"register", "a.xyz", "b.xyz", "-o", "out"});
  if (done.status == 2) {
    expect_one_error(done, 2, "");
    EXPECT_FALSE(fs::exists(work() / "out"));
    return;
  }
  EXPECT_TRUE(done.status == 3 || done.status == 4) << done.status << done.err;
  EXPECT_TRUE(fs::exists(work() / "out" / "result.json"));
  EXPECT_EQ(fs::exists(work() / "out" / "transform.txt"), done.status == 3);
}

INSTANTIATE_TEST_SUITE_P(Clouds, PoorCloudTest, testing::ValuesIn(poor_clouds()), name_of_case);

struct BadUsage {
  std::string name;
  std::vector<std::string> arguments;
  std::string must_name;
};

/// In the folder: good.xyz, pose.txt, scaled.txt (not rigid), a file `file` and a folder `folder`.
std::vector<BadUsage> bad_usages() {
  return {
      {"Nothing", {}, "limen --help"},
      {"UnknownCommand", {"frobnicate"}, "frobnicate is not a command"},
      {"UnknownOption", {"planes", "good.xyz", "-o", "x.json", "--frobnicate"}, "--frobnicate"},
      {"MissingArgument", {"register", "good.xyz", "-o", "out"}, "TARGET"},
      {"MissingOutput", {"planes", "good.xyz"}, "--output"},
      {"MissingFile", {"planes", "missing.ply", "-o", "x.json"}, "missing.ply"},
      {"FolderAsScan", {"planes", "folder", "-o", "x.json"}, "folder"},
      {"OutputBelowAFile", {"register", "good.xyz", "good.xyz", "-o", "file/out"}, "file/out"},
      {"OutputIsAFile", {"register", "good.xyz", "good.xyz", "-o", "file"}, "file"},
      {"PlanesBelowAFile", {"planes", "good.xyz", "-o", "file/x.json"}, "file/x.json"},
      {"PlanesOntoAFolder", {"planes", "good.xyz", "-o", "folder"}, "folder"},
      {"PlanesOntoItsInput", {"planes", "good.xyz", "-o", "./good.xyz"}, "good.xyz"},
      {"BadThreads", {"info", "good.xyz", "--threads", "-1"}, "--threads"},
      {"ThreadsInWords", {"info", "good.xyz", "--threads", "two"}, "--threads"},
      {"BadSeed", {"register", "good.xyz", "good.xyz", "-o", "out", "--seed", "-7"}, "--seed"},
      {"BadGravity", {"register", "good.xyz", "good.xyz", "-o", "out", "--gravity", "down"}, "--gravity"},
      {"BadMethod", {"register", "good.xyz", "good.xyz", "-o", "out", "--method", "magic"}, "--method"},
      {"BadOrigin", {"planes", "good.xyz", "-o", "x.json", "--origin", "1,2"}, "--origin"},
      {"NanOrigin", {"planes", "good.xyz", "-o", "x.json", "--origin", "nan,0,0"}, "--origin"},
      {"BadThreshold", {"planes", "good.xyz", "-o", "x.json", "--inlier-threshold-m", "-1"}, "threshold"},
      {"NanThreshold", {"planes", "good.xyz", "-o", "x.json", "--inlier-threshold-m", "nan"}, "threshold"},
      {"NotRigid", {"transform", "scaled.txt", "good.xyz", "moved.ply"}, "scaled.txt"},
      {"NotRigidEvaluated", {"evaluate", "scaled.txt", "pose.txt"}, "scaled.txt"},
      {"PoseIsACloud", {"transform", "good.xyz", "good.xyz", "moved.ply"}, "good.xyz"},
      {"MissingTruth", {"evaluate", "pose.txt", "missing.json"}, "missing.json"},
      {"TransformBelowAFile", {"transform", "pose.txt", "good.xyz", "file/moved.ply"}, "file/moved.ply"},
      {"UnknownScene", {"simulate", "atlantis", "-o", "out"}, "atlantis"},
      {"CommandWithASlip", {"regsiter", "good.xyz", "good.xyz", "-o", "out"}, "did you mean register?"},
      {"CommandCutShort", {"trans"}, "did you mean transform?"},
      {"HelpOfNothing", {"help", "regster"}, "did you mean register?"},
      {"OptionWithASlip", {"planes", "good.xyz", "--ouptut", "x.json"}, "did you mean --output?"},
      {"OptionOfTheProgram", {"--treads", "3"}, "did you mean --threads?"},
      {"OptionWithAnEqualSign", {"info", "good.xyz", "--unit=mm"}, "did you mean --units?"},
      {"UnknownUnit", {"info", "good.xyz", "--units", "furlong"}, "--units"},
      {"UnitOfTheOtherSide",
       {"register", "good.xyz", "good.xyz", "-o", "out", "--target-unit", "mm"},
       "--target-units"},
      {"NoSuchAlternative",
       {"transform", "pose.txt", "good.xyz", "moved.ply", "--alternative", "2"},
       "alternative"},
      {"NegativeAlternative",
       {"transform", "pose.txt", "good.xyz", "moved.ply", "--alternative", "-2"},
       "--alternative"},
      {"UnwrittenEnding", {"transform", "pose.txt", "good.xyz", "moved.docx"}, "moved.docx"},
      {"TransformOntoItsInput", {"transform", "pose.txt", "good.xyz", "./good.xyz"}, "good.xyz"},
      {"DeviationWithoutAModel",
       {"deviation", "good.xyz", "good.xyz", "--identity", "-o", "out"},
       "good.xyz"},
      {"DeviationWithoutAPose", {"deviation", "good.xyz", "house.ifc", "-o", "out"}, "--result"},
      {"ThinToNothing", {"thin", "good.xyz", "thin.ply"}, "--points"},
      {"SchemaOfNothing", {"schema", "everything"}, "everything"},
      {"RiskOfMoreThanAll", {"register", "good.xyz", "good.xyz", "-o", "out", "--risk", "2"}, "risk"},
      {"MemoryInWords", {"info", "good.xyz", "--memory", "lots"}, "--memory"},
      {"WithoutItsPose",
       {"register", "good.xyz", "good.xyz", "-o", "out", "--source-with", "good.xyz"},
       "--source-with"},
      {"WithAPoseThatIsNone",
       {"register", "good.xyz", "good.xyz", "-o", "out", "--source-with", "good.xyz", "file"},
       "file"},
      {"CompletionOfAnUnknownShell", {"completion", "csh"}, "csh"},
      {"SimulateBelowAFile", {"simulate", "room", "-o", "file/out"}, "file/out"},
  };
}

void PrintTo(const BadUsage& tested, std::ostream* stream) {
  *stream << tested.name;
}

class BadUsageTest : public ProgramTest, public testing::WithParamInterface<BadUsage> {};

TEST_P(BadUsageTest, IsOneErrorAndWritesNothing) {
  write_whole(work() / "good.xyz", grid_text(100, [](int i, int) { return i < 50 ? 0.0 : 2.0; }));
  write_whole(work() / "pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  write_whole(work() / "scaled.txt", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
  write_whole(work() / "file", "x");
  fs::create_directory(work() / "folder");
  const std::string good = read_whole(work() / "good.xyz");
  expect_one_error(run(GetParam().arguments), 2, GetParam().must_name);
  EXPECT_EQ(std::distance(fs::recursive_directory_iterator(work()), fs::recursive_directory_iterator()), 5);
  EXPECT_EQ(read_whole(work() / "file"), "x");
  EXPECT_EQ(read_whole(work() / "good.xyz"), good);
}

class BadUnitTest : public ProgramTest {};

TEST_F(BadUnitTest, ARoomInMillimetresIsRefusedInOneLineThatSaysWhatToDo) {
  std::string text;
  for (int k = 0; k < 4000; ++k)
    text += std::to_string(k % 20 * 400) + " " + std::to_string(k / 20 % 20 * 300) + " " +
            std::to_string(k / 400 * 290) + "\n";
  write_whole(work() / "mm.xyz", text);
  expect_one_error(run({"register", "mm.xyz", "mm.xyz", "-o", "out"}), 2, "--source-units");
  const ProgramRun stated = run({"info", "mm.xyz"});
  EXPECT_EQ(stated.status, 0) << stated.err;
  EXPECT_NE(stated.out.find("--units mm"), std::string::npos) << stated.out;
  const ProgramRun metres = run({"info", "mm.xyz", "--units", "mm"});
  EXPECT_NE(metres.out.find("size            7.600 x 5.700 x 2.610 m"), std::string::npos) << metres.out;
}

INSTANTIATE_TEST_SUITE_P(Usages, BadUsageTest, testing::ValuesIn(bad_usages()), name_of_case);

}  // namespace
}  // namespace limen
