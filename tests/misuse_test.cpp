// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A table of misuses: each gives one line that says what, where and what to do, with status 2, and
// leaves everything as it was. bad_input_test.cpp has the damages of single formats.
#include <algorithm>
#include <cstdint>
#include <map>

#include "run_program.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

struct Misuse {
  std::vector<std::string> arguments;
  std::string must_say;
};

class MisuseTest : public ProgramTest {
 protected:
  /// A room, a model, results of each kind, and what is none of these.
  void SetUp() override {
    ProgramTest::SetUp();
    make({"simulate", "room", "-o", "room", "--points-indoor", "2000"});
    make({"simulate", "office", "-o", "office", "--points-indoor", "2000"});
    write_whole(work() / "pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    fs::copy_file(work() / "room/indoor_00.ply", work() / "a.ply");
    fs::copy_file(work() / "room/indoor_01.ply", work() / "b.ply");
    fs::copy_file(work() / "office/model.ifc", work() / "m.ifc");
    for (const std::string ending : {"las", "laz", "e57", "xyz"})
      make({"transform", "pose.txt", "a.ply", "a." + ending});
    make({"register", "a.ply", "b.ply", "-o", "result"});
    make({"project", "a.ply", "b.ply", "-o", "project"});
    write_whole(work() / "no.json", "{}");
    write_whole(work() / "cut.json", R"({"outcome": "registered", "target_from_sou)");
    write_whole(work() / "list.json", "[1, 2]");
    write_whole(work() / "names.txt", "missing.ply\n");
    write_whole(work() / "empty.json", "");
    write_whole(work() / "words.csv", "there,is\nno,point\n");
    write_whole(work() / "commas.csv", "name,x,y,sigma\nA,1,5,2,5,3\n");
    write_whole(work() / "nan.xyz", "nan nan nan\nnan nan nan\nnan nan nan\n");
    fs::create_directory(work() / "folder");
  }

  /// All files and the bytes of each.
  [[nodiscard]] std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> all;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(work()))
      all[entry.path().string()] = entry.is_regular_file() ? read_whole(entry.path()) : "";
    return all;
  }

  void expect_stated(const std::vector<Misuse>& table) const {
    const auto before = everything();
    for (const Misuse& misuse : table) {
      std::string line = "limen";
      for (const std::string& word : misuse.arguments) line += " " + (word.empty() ? "''" : word);
      SCOPED_TRACE(line);
      const ProgramRun done = run(misuse.arguments);
      EXPECT_EQ(done.status, 2);
      EXPECT_EQ(done.out, "");
      EXPECT_EQ(done.err.rfind("limen: error: ", 0), 0U) << done.err;
      EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
      EXPECT_NE(done.err.find(misuse.must_say), std::string::npos) << done.err;
      EXPECT_EQ(done.err.find("please report"), std::string::npos) << done.err;
      EXPECT_TRUE(done.err.ends_with(")\n")) << "it does not say what to do: " << done.err;
      EXPECT_TRUE(std::all_of(done.err.begin(), done.err.end() - 1, [](char c) {
        return static_cast<unsigned char>(c) >= 0x20U;
      })) << done.err;
    }
    EXPECT_TRUE(everything() == before) << "something was written, or left behind";
  }

 private:
  void make(const std::vector<std::string>& arguments) const {
    const ProgramRun done = run(arguments);
    ASSERT_TRUE(done.status == 0 || done.status == 3 || done.status == 4) << done.err;
  }
};

TEST_F(MisuseTest, RandomBytesUnderAnyNameAreNoFile) {
  std::vector<Misuse> table;
  std::uint64_t state = 20240229;
  for (const std::string ending : {"las", "laz", "e57", "ply", "pcd", "ptx", "pts", "xyz", "txt", "csv",
                                   "asc", "ifc", "ifczip", "obj", "json", "bin", "docx"}) {
    std::string bytes(5000, '\0');
    for (char& c : bytes) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      c = static_cast<char>(state >> 56U);
    }
    const std::string name = "random." + ending;
    write_whole(work() / name, bytes);
    for (const std::string command : {"info", "view"}) table.push_back({{command, name}, name});
    table.push_back({{"register", name, "b.ply", "-o", "out"}, name});
    table.push_back({{"register", "a.ply", name, "-o", "out"}, name});
    table.push_back({{"deviation", "a.ply", name, "--identity", "-o", "out"}, name});
    table.push_back({{"project", name, "-o", "out"}, name});
    table.push_back({{"transform", "pose.txt", name, "out.ply"}, name});
    table.push_back({{"transform", name, "a.ply", "out.ply"}, name});
    table.push_back({{"evaluate", name, "pose.txt"}, name});
    table.push_back({{"project", "a.ply", "b.ply", "--decide", name, "-o", "out"}, name});
    table.push_back({{"project", "a.ply", "b.ply", "--control", name, "-o", "out"}, name});
    table.push_back({{"project", "--scans", name, "-o", "out"}, name});
    table.push_back({{"register", "a.ply", "b.ply", "--source-trajectory", name, "-o", "out"}, name});
  }
  table.push_back({{"info", "random.las"}, "this is not a LAS file"});
  table.push_back({{"info", "random.laz"}, "this is not a LAS file"});
  table.push_back({{"info", "random.e57"}, "does not begin like an E57 file"});
  expect_stated(table);
}

TEST_F(MisuseTest, FilesThatEndTooEarlyAreNotTakenForWholeOnes) {
  std::vector<Misuse> table;
  const std::map<std::string, std::string> kinds = {
      {"a.las", "header promises"}, {"a.laz", "get the whole file"}, {"a.e57", "cut off"},
      {"a.ply", "header promises"}, {"a.xyz", "numbers, not"},       {"m.ifc", "cut off"}};
  for (const auto& [whole, must_say] : kinds) {
    const std::string bytes = read_whole(work() / whole);
    for (const std::size_t percent : {30U, 60U, 95U}) {
      const std::string name = "cut" + std::to_string(percent) + whole;
      // A text's last line is cut within its second number.
      std::size_t length = bytes.size() * percent / 100;
      if (whole == "a.xyz") length = bytes.find(' ', bytes.find('\n', length)) + 2;
      write_whole(work() / name, bytes.substr(0, length));
      table.push_back({{"info", name}, must_say});
      table.push_back({{"register", name, "b.ply", "-o", "out"}, name});
      table.push_back({{"project", name, "-o", "out"}, name});
      table.push_back({{"view", name, "-o", "out.html"}, name});
      if (whole != "m.ifc") table.push_back({{"transform", "pose.txt", name, "out.ply"}, name});
    }
    const std::string empty = "empty" + whole;
    write_whole(work() / empty, "");
    table.push_back({{"info", empty}, "the file is empty"});
    table.push_back({{"register", "a.ply", empty, "-o", "out"}, "the file is empty"});
  }
  expect_stated(table);
}

TEST_F(MisuseTest, AFormatOfOneMakersProgramsIsNamedWithItsWayOut) {
  std::vector<Misuse> table;
  const std::string zip = "PK\x03\x04" + std::string(500, '\x7f');
  const auto refused = [&](const std::string& name, const std::string& maker) {
    table.push_back({{"info", name}, "is " + maker});
    table.push_back({{"view", name, "-o", "out.html"}, maker});
    table.push_back({{"planes", name, "-o", "out.json"}, maker});
    table.push_back({{"thin", name, "out.ply", "--points", "9"}, maker});
    table.push_back({{"register", name, "b.ply", "-o", "out"}, maker});
    table.push_back({{"register", "a.ply", name, "-o", "out"}, maker});
    table.push_back({{"deviation", "a.ply", name, "--identity", "-o", "out"}, maker});
    table.push_back({{"transform", "pose.txt", name, "out.ply"}, maker});
    if (name == "nothing") return;  // where no name tells, a project goes on without the scan
    table.push_back({{"project", "a.ply", name, "-o", "out"}, maker});
    table.push_back({{"project", "a.ply", "--model", name, "-o", "out"}, maker});
  };
  for (const auto& [ending, maker] : std::map<std::string, std::string>{{"fls", "FARO"},
                                                                        {"LSPROJ", "FARO"},
                                                                        {"fws", "FARO"},
                                                                        {"rcp", "Autodesk ReCap"},
                                                                        {"rcs", "Autodesk ReCap"},
                                                                        {"zfs", "Zoller"},
                                                                        {"imp", "Leica"},
                                                                        {"dp", "DotProduct"},
                                                                        {"rvt", "an Autodesk Revit model"}}) {
    write_whole(work() / ("scan." + ending), zip);
    refused("scan." + ending, maker);
  }
  write_whole(work() / "nothing", std::string("PTG\0\xC7\xA3\x8F\x92", 8) + zip);
  refused("nothing", "Leica Geosystems scan data (.ptg)");
  fs::create_directory(work() / "whole.lsproj");
  table.push_back({{"info", "whole.lsproj"}, "open it in FARO SCENE"});
  expect_stated(table);
  // The content decides: text is text under any name.
  fs::copy_file(work() / "a.xyz", work() / "text.imp");
  EXPECT_EQ(run({"info", "text.imp"}).status, 0);
}

TEST_F(MisuseTest, WhatIsNoFileOrTheWrongOne) {
  std::vector<Misuse> table = {
      {{"info", "folder"}, "is a folder"},
      {{"register", "room", "b.ply", "-o", "out"}, "is a folder"},
      {{"project", "room", "-o", "out"}, "name the scans in it: room/*"},
      {{"project", "a.ply", "room", "-o", "out"}, "is a folder, not a scan"},
      {{"project", "missing.ply", "missing2.ply", "-o", "out"}, "missing.ply: there is no such file"},
      {{"project", "--scans", "missing.txt", "-o", "out"}, "missing.txt"},
      {{"project", "--scans", "names.txt", "-o", "out"}, "missing.ply"},
      {{"project", "--scans", "a.ply", "-o", "out"}, "a.ply: is not a list of names"},
      {{"thin", "folder", "out.ply", "--points", "9"}, "is a folder"},
      {{"transform", "folder", "a.ply", "out.ply"}, "is a folder"},
      {{"transform", "pose.txt", "folder", "out.ply"}, "is a folder"},
      {{"view", "folder"}, "is a folder"},
      {{"info", ""}, "the name of a file is empty"},
      {{"register", "a.ply", "", "-o", "out"}, "the name of a file is empty"},
      {{"info", "https://example.org/a.las"}, "is a web address"},
      {{"register", "a.ply", "file:///a.ply", "-o", "out"}, "download it"},
      {{"view", "s3://scans/a.laz"}, "is a web address"},
      {{"info", "nan.xyz"}, "nan.xyz"},
      {{"register", "nan.xyz", "b.ply", "-o", "out"}, "nan.xyz"},
      {{"register", "m.ifc", "m.ifc", "-o", "out"}, "both sides are building models"},
      {{"deviation", "m.ifc", "a.ply", "--identity", "-o", "out"}, "give the scan first"},
      {{"deviation", "a.ply", "b.ply", "--identity", "-o", "out"}, "is not a building model"},
      {{"deviation", "a.ply", "missing.ifc", "--identity", "-o", "out"}, "missing.ifc"},
      {{"thin", "m.ifc", "out.ply", "--points", "9"}, "is not read as a scan"},
      {{"transform", "pose.txt", "m.ifc", "out.ply"}, "is not read as a scan"},
      {{"simulate", "a.ply", "-o", "out"}, "a.ply"},
      {{"transform", "m.ifc", "a.ply", "out.ply"}, "is not a pose"},
      {{"transform", "result/report.html", "a.ply", "out.ply"}, "is not a pose"},
      {{"transform", "result/result.json", "a.ply", "out.ply"}, "holds no pose"},
      {{"transform", "project/project.json", "a.ply", "out.ply"}, "with -o OUT and takes no cloud"},
      {{"transform", "result/result.json", "-o", "out"}, "is not a project"},
      {{"transform", "missing.json", "-o", "out"}, "missing.json: there is no such file"},
      {{"deviation", "missing/project.json", "m.ifc", "-o", "out"}, "project.json: there is no such file"},
      {{"project", "--scans", "folder", "-o", "out"}, "folder: is a folder, not a list"},
      {{"project", "a.ply", "b.ply", "--control", "folder", "-o", "out"}, "folder: is a folder, not a table"},
      {{"project", "a.ply", "b.ply", "--check", "missing.csv", "-o", "out"}, "there is no such file"},
      {{"project", "a.ply", "b.ply", "--targets", "commas.csv", "-o", "out"},
       "commas.csv, line 2: 6 fields, 4 columns"},
      {{"evaluate", "project/project.json", "pose.txt"}, "holds no list of scans with poses"},
      {{"evaluate", "pose.txt", "words.csv"}, "words.csv"},
      {{"info", "a.ply", "--trajectory", "missing.txt"}, "missing.txt"},
      {{"register", "a.ply", "b.ply", "--source-trajectory", "a.ply", "-o", "out"}, "a.ply"},
      {{"register", "a.ply", "b.ply", "--target-with", "missing.ply", "pose.txt", "-o", "out"},
       "missing.ply"},
      {{"register", "a.ply", "b.ply", "--start", "missing.txt", "-o", "out"}, "missing.txt"},
      {{"project", "a.ply", "b.ply", "--control", "words.csv", "-o", "out"}, "no column is called name"},
      {{"project", "a.ply", "b.ply", "--targets", "words.csv", "-o", "out"}, "words.csv"},
      {{"project", "status", "folder"}, "holds no project"},
      {{"project", "decide", "folder", "accept", "a.ply", "b.ply"}, "holds no project"},
  };
  for (const std::string json : {"no.json", "cut.json", "list.json", "empty.json"}) {
    table.push_back({{"transform", json, "a.ply", "out.ply"}, json});
    table.push_back({{"evaluate", json, "pose.txt"}, json});
    table.push_back({{"evaluate", "pose.txt", json}, json});
    table.push_back({{"view", json, "-o", "out.html"}, json});
    table.push_back({{"deviation", "a.ply", "m.ifc", "--result", json, "-o", "out"}, json});
    table.push_back({{"project", "a.ply", "b.ply", "--decide", json, "-o", "out"}, json});
    table.push_back({{"transform", json, "-o", "out"}, json});
    table.push_back({{"info", json}, json});
  }
  expect_stated(table);
}

TEST_F(MisuseTest, WordsAndNumbersThatCannotBe) {
  const auto registering = [](std::vector<std::string> more) {
    std::vector<std::string> words = {"register", "a.ply", "b.ply", "-o", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_stated({
      {{""}, "an empty word is not a command"},
      {{"planes", "a.ply", "b.ply", "-o", "planes.json"}, "b.ply"},
      {{"info", "a.ply", "--nonsense"}, "--nonsense is not an option"},
      {{"info", "a.ply", "--seed", "-1"}, "--seed"},
      {{"info", "a.ply", "--seed", "1.5"}, "--seed"},
      {{"info", "a.ply", "--seed", "99999999999999999999999"}, "is too large"},
      {{"info", "a.ply", "--threads", "99999"}, "--threads"},
      {{"info", "a.ply", "--threads", "nan"}, "--threads"},
      {{"thin", "a.ply", "out.ply", "--points", "-5"}, "--points: -5"},
      {{"thin", "a.ply", "out.ply", "--points", "0"}, "number of points to keep"},
      {{"thin", "a.ply", "out.ply", "--points", "1e99"}, "--points"},
      {{"thin", "a.ply", "out.ply", "--spacing-m", "-1"}, "--spacing-m"},
      {{"thin", "a.ply", "out.ply", "--spacing-m", "inf"}, "--spacing-m"},
      {{"simulate", "room", "-o", "out", "--points-indoor", "-5"}, "--points-indoor"},
      {{"simulate", "room", "-o", "out", "--points-indoor", "99999999999999"}, "1e8"},
      {{"simulate", "room", "-o", "out", "--noise-m", "nan"}, "--noise-m"},
      {{"view", "a.ply", "--most-points", "5"}, "--most-points"},
      {{"view", "a.ply", "--alternative", "3"}, "--alternative"},
      {{"view", "a.ply", "--units", "parsec"}, "--units"},
      {registering({"--wall-thickness-m", "nan"}), "--wall-thickness-m"},
      {registering({"--wall-thickness-m", "1000"}), "wall_thickness_m"},
      {registering({"--risk", "nan"}), "risk"},
      {registering({"--risk", "-1"}), "risk"},
      {registering({"--memory", "1"}), "--memory"},
      {registering({"--memory", "1e40G"}), "--memory"},
      {registering({"--origin", "1e999,0,0"}), "--origin"},
      {registering({"--start-sigma", "1"}), "--start"},
      {registering({"--language", "xx"}), "--language"},
      {registering({"--source-lever-arm", "1,2,3"}), "--source-trajectory"},
      {registering({"--target-utm-zone", "32N"}), "--target-trajectory"},
      {{"project", "a.ply", "b.ply", "-o", "out", "--trajectory-time-offset-s", "3"}, "--trajectory FILE"},
      {{"transform", "result/result.json", "a.ply", "out.ply", "--alternative", "0"}, "--alternative"},
      {registering({"--as-published", "1999"}), "--as-published"},
      {registering({"--source-units", "mm"}), "--source-units"},
      {registering({"--source-units", "km"}), "--source-units"},
      {{"deviation", "a.ply", "m.ifc", "--identity", "--result", "pose.txt", "-o", "out"},
       "exclude each other"},
      {{"transform", "project/project.json", "-o", "all.e57"}, "add --merge"},
      {{"transform", "project/project.json", "-o", "folder/all.PLY", "--as", "ply"}, "add --merge"},
      {{"transform", "project/project.json", "-o", "out", "--invert"},
       "--invert does not apply to a project"},
      {{"transform", "project/project.json", "-o", "out", "--alternative", "1"},
       "--alternative does not apply to a project"},
      {{"schema", "everything"}, "everything"},
      {{"schema"}, "FILE is required"},
      {{"completion"}, "SHELL is required"},
      {{"project", "-o", "out"}, "there is no scan"},
      {{"project", "a.ply", "b.ply"}, "-o DIR"},
      {{"project", "status"}, "project status DIR"},
      {{"project", "decide"}, "project decide DIR"},
      {{"project", "decide", "project"}, "accept A B"},
      {{"project", "decide", "project", "perhaps"}, "accept A B"},
      {{"project", "decide", "project", "accept", "a.ply"}, "accept A B"},
      {{"project", "decide", "project", "accept", "a.ply", "c.ply"}, "no scan named c.ply"},
      {{"project", "decide", "project", "choose", "a.ply", "b.ply", "x"}, "choose"},
      {{"project", "decide", "project", "level", "nobody"}, "no scan named nobody"},
  });
}

TEST_F(MisuseTest, NamesThatJsonCannotTellAreRefusedBeforeTheWork) {
  const std::string latin = "caf\xe9.ply";
  fs::copy_file(work() / "b.ply", work() / latin);
  const std::string must_say = "caf?.ply: is not UTF-8";
  expect_stated({
      {{"register", "a.ply", latin, "-o", "out"}, must_say},
      {{"project", "a.ply", latin, "-o", "out"}, must_say},
      {{"project", "a.ply", "--model", latin, "-o", "out"}, must_say},
      {{"planes", latin, "-o", "out.json"}, must_say},
      {{"info", latin}, must_say},
      {{"thin", latin, "out.ply", "--points", "9"}, must_say},
  });
}

TEST_F(MisuseTest, PlacesThatCannotBeWrittenTo) {
  fs::create_directory(work() / "own");
  fs::copy_file(work() / "a.xyz", work() / "own/transform.txt");
  expect_stated({
      {{"planes", "a.ply", "-o", ""}, "no name"},
      {{"register", "a.ply", "b.ply", "-o", ""}, "no name"},
      {{"register", "own/transform.txt", "b.ply", "-o", "own"}, "would overwrite the input"},
      {{"planes", "a.ply", "-o", "missing/out.json"}, "missing/out.json"},
      {{"planes", "a.ply", "-o", "/proc/out.json"}, "/proc/out.json"},
      {{"register", "a.ply", "b.ply", "-o", "/proc/out"}, "/proc/out"},
      {{"project", "a.ply", "b.ply", "-o", "/proc/out"}, "/proc/out"},
      {{"simulate", "room", "-o", "/proc/out"}, "/proc/out"},
      {{"deviation", "a.ply", "m.ifc", "--identity", "-o", "/proc/out"}, "/proc/out"},
      {{"transform", "pose.txt", "a.ply", "/proc/out.ply"}, "/proc/out.ply"},
      {{"view", "a.ply", "-o", "/proc/out.html"}, "/proc/out.html"},
      {{"register", "a.ply", "b.ply", "-o", "a.ply"}, "a.ply"},
      {{"view", "a.ply", "-o", "a.ply"}, "overwrite the input"},
      {{"thin", "a.ply", "a.ply", "--points", "9"}, "overwrite the input"},
      {{"transform", "pose.txt", "a.ply", "pose.txt"}, "overwrite the input"},
      {{"transform", "pose.txt", "a.ply", "folder"}, "folder"},
  });
}

}  // namespace
}  // namespace limen
