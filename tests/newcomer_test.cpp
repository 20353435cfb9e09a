// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// What a new user does in the first hour, and what limen notices about it before the long work.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

#include "run_program.h"
#include "support/synthetic_las.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Place = std::array<double, 3>;

constexpr const char* kSiteGrid = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";
constexpr const char* kStill = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

int times_in(const std::string& text, const std::string& words) {
  int times = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++times;
  return times;
}

class NewcomerTest : public ProgramTest {
 protected:
  /// Two stations of one room, a.ply and b.ply.
  void SetUp() override {
    ProgramTest::SetUp();
    write_whole(work() / "still.txt", kStill);
    ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "20000"}).status, 0);
    fs::copy_file(work() / "room/indoor_00.ply", work() / "a.ply");
    fs::copy_file(work() / "room/indoor_01.ply", work() / "b.ply");
    in_a_ = count_in("a.ply");
    in_b_ = count_in("b.ply");
  }

  [[nodiscard]] std::string count_in(const std::string& cloud) const {
    return Json::parse(run({"info", cloud, "--json"}).out)["scans"][0]["points"].dump();
  }

  void convert(const std::string& from, const std::string& to) const {
    const ProgramRun done = run({"transform", "still.txt", from, to});
    ASSERT_EQ(done.status, 0) << done.err;
  }

  [[nodiscard]] std::vector<Place> points_of(const std::string& cloud) const {
    static_cast<void>(run({"transform", "still.txt", cloud, "points.csv"}));
    std::istringstream rows(read_whole(work() / "points.csv"));
    std::vector<Place> points;
    std::string line;
    std::getline(rows, line);
    while (std::getline(rows, line)) {
      Place x{};
      char comma = 0;
      std::istringstream(line) >> x[0] >> comma >> x[1] >> comma >> x[2];
      points.push_back(x);
    }
    return points;
  }

  /// The points of a cloud after `change`, as text.
  void write_changed(const std::string& cloud, const std::string& name,
                     const std::function<Place(const Place&)>& change) const {
    std::string text;
    for (const Place& x : points_of(cloud)) {
      const Place y = change(x);
      text += fmt::format("{} {} {}\n", y[0], y[1], y[2]);
    }
    write_whole(work() / name, text);
  }

  /// As a.ply with a comment before its points, the numbers single precision.
  void write_ply(const std::string& cloud, const std::string& name, const std::string& comment) const {
    const std::vector<Place> points = points_of(cloud);
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\n{}element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n",
        comment, points.size());
    for (const Place& x : points)
      text += fmt::format("{} {} {}\n", static_cast<float>(x[0]), static_cast<float>(x[1]),
                          static_cast<float>(x[2]));
    write_whole(work() / name, text);
  }

  /// all.e57, which holds a.ply and b.ply as two scans.
  void write_two_in_one() const {
    const ProgramRun project = run({"project", "a.ply", "b.ply", "-o", "project"});
    ASSERT_EQ(project.status, 0) << project.err;
    const ProgramRun moved = run({"transform", "project/project.json", "-o", "all.e57", "--merge"});
    ASSERT_EQ(moved.status, 0) << moved.err;
  }

  [[nodiscard]] Json result_in(const std::string& folder) const {
    return Json::parse(read_whole(work() / folder / "result.json"));
  }

  /// Words that begin with two dashes, and that the command's help does not have.
  [[nodiscard]] std::set<std::string> unknown_options(const std::string& command,
                                                      const std::string& text) const {
    const std::string help = run({command, "--help"}).out;
    std::set<std::string> unknown;
    const std::regex option("--[a-z][a-z0-9-]*");
    for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it) {
      if (!std::regex_search(help, std::regex(it->str() + "([^a-z0-9-]|$)"))) unknown.insert(it->str());
    }
    return unknown;
  }

  std::string in_a_;  ///< how many points a.ply holds
  std::string in_b_;
};

TEST_F(NewcomerTest, TheSameScanOnBothSidesIsSaidInOneLine) {
  convert("a.ply", "copy.las");
  convert("a.ply", "copy.e57");
  fs::copy_file(work() / "a.ply", work() / "c.ply");
  const std::string words = "SOURCE and TARGET hold the same " + in_a_ + " points";
  for (const std::string copy : {"a.ply", "c.ply", "copy.las", "copy.e57"}) {
    SCOPED_TRACE(copy);
    const ProgramRun done = run({"register", "a.ply", copy, "-o", "out", "--no-report"});
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(times_in(done.err, words), 1) << done.err;
    ASSERT_EQ(result_in("out")["notes"].size(), 1U);
    EXPECT_NE(result_in("out")["notes"][0].get<std::string>().find(words), std::string::npos);
  }
  const ProgramRun two = run({"register", "a.ply", "b.ply", "-o", "out", "--no-report"});
  EXPECT_EQ(two.err.find("hold the same"), std::string::npos) << two.err;
  EXPECT_TRUE(result_in("out")["notes"].empty());
}

TEST_F(NewcomerTest, AProjectNamesCopiesBeforeItsWork) {
  fs::copy_file(work() / "a.ply", work() / "c.ply");
  convert("b.ply", "d.las");
  const ProgramRun done = run({"project", "a.ply", "b.ply", "c.ply", "d.las", "-o", "out"});
  EXPECT_EQ(times_in(done.err, "c.ply is identical to a.ply and treated as its copy"), 1) << done.err;
  EXPECT_EQ(times_in(done.err, "seem to hold the same " + in_b_ + " points"), 1) << done.err;
  const Json project = Json::parse(read_whole(work() / "out/project.json"));
  EXPECT_GE(project["notes"].size(), 2U);
}

TEST_F(NewcomerTest, AThinnedCopyIsNamedBeforeTheWork) {
  ASSERT_EQ(run({"thin", "b.ply", "thin.las", "--spacing-m", "0.15"}).status, 0);
  const ProgramRun pair = run({"register", "b.ply", "thin.las", "-o", "out", "--no-report"});
  EXPECT_EQ(times_in(pair.err, "TARGET holds only points of SOURCE"), 1) << pair.err;
  const ProgramRun turned = run({"register", "thin.las", "b.ply", "-o", "out", "--no-report"});
  EXPECT_EQ(times_in(turned.err, "SOURCE holds only points of TARGET"), 1) << turned.err;
  const ProgramRun other = run({"register", "thin.las", "a.ply", "-o", "out", "--no-report"});
  EXPECT_EQ(times_in(other.err, "holds only points"), 0) << other.err;
  const ProgramRun done = run({"project", "a.ply", "b.ply", "thin.las", "-o", "project"});
  EXPECT_EQ(times_in(done.err, "thin.las holds only points of b.ply"), 1) << done.err;
}

TEST_F(NewcomerTest, AProjectNamesWhatIsNoScanInMetresAndGoesOn) {
  write_changed("a.ply", "mm.xyz", [](const Place& x) { return Place{1e3 * x[0], 1e3 * x[1], 1e3 * x[2]}; });
  write_changed("a.ply", "degrees.xyz", [](const Place& x) {
    return Place{7.75 + 1.3e-5 * x[0], 48.58 + 9e-6 * x[1], x[2]};
  });
  write_changed("a.ply", "y_up.xyz", [](const Place& x) { return Place{x[0], x[2], -x[1]}; });
  write_whole(work() / "ten.xyz", "0 0 0\n1 0 0\n2 0 0\n3 1 0\n4 1 0\n0 2 0\n0 3 1\n0 4 1\n1 1 2\n2 2 2\n");
  const ProgramRun done =
      run({"project", "a.ply", "b.ply", "mm.xyz", "degrees.xyz", "y_up.xyz", "ten.xyz", "-o", "project"});
  EXPECT_NE(done.status, 2) << done.err;
  for (const std::string line :
       {"mm.xyz: cannot be read: the points measure", "degrees of longitude and latitude",
        "y_up.xyz: its y axis seems to point up", "ten.xyz: holds 10 points, too few"})
    EXPECT_EQ(times_in(done.err, line), 1) << line << "\n" << done.err;
  // A pair needs both sides: there it is an error, but for the axes.
  EXPECT_EQ(run({"register", "mm.xyz", "b.ply", "-o", "out"}).status, 2);
  EXPECT_EQ(run({"register", "b.ply", "degrees.xyz", "-o", "out"}).status, 2);
  const ProgramRun up = run({"register", "b.ply", "y_up.xyz", "-o", "out", "--no-report"});
  EXPECT_EQ(times_in(up.err, "TARGET: its y axis seems to point up"), 1) << up.err;
  const ProgramRun alone = run({"project", "a.ply", "-o", "alone"});
  EXPECT_EQ(times_in(alone.err, "is the only scan, so there is nothing to register it to"), 1) << alone.err;
}

TEST_F(NewcomerTest, AdviceNamesOptionsThatTheCommandHas) {
  // Nobody could have stood at 0,0,0 of it, and its numbers seem to be inches.
  write_changed("a.ply", "odd.xyz", [](const Place& x) {
    return Place{39.37 * x[0] + 4000.0, 39.37 * x[1] + 5000.0, 39.37 * x[2] + 900.0};
  });
  const ProgramRun project = run({"project", "odd.xyz", "b.ply", "-o", "project"});
  EXPECT_NE(project.err.find("scanner position is unknown"), std::string::npos) << project.err;
  EXPECT_NE(project.err.find("are its numbers in?"), std::string::npos) << project.err;
  EXPECT_EQ(unknown_options("project", project.out + project.err), std::set<std::string>{});
  const ProgramRun info = run({"info", "odd.xyz"});
  EXPECT_NE(info.out.find("--units in"), std::string::npos) << info.out;
  EXPECT_EQ(unknown_options("info", info.out + info.err), std::set<std::string>{});
  const ProgramRun planes = run({"planes", "odd.xyz", "-o", "planes.json", "--memory", "1G"});
  EXPECT_NE(planes.err.find("--units in"), std::string::npos) << planes.err;
  EXPECT_EQ(unknown_options("planes", planes.err), std::set<std::string>{});
  const ProgramRun registered = run({"register", "b.ply", "odd.xyz", "-o", "out", "--no-report"});
  EXPECT_NE(registered.err.find("--target-units in"), std::string::npos) << registered.err;
  EXPECT_EQ(unknown_options("register", registered.err), std::set<std::string>{});
  write_whole(work() / "track.txt", "1 2 3 4\n2 3 4 5\n");
  for (const std::string option : {"--source-trajectory", "--target-trajectory"}) {
    const ProgramRun refused = run({"register", "a.ply", "b.ply", "-o", "out", option, "track.txt"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find(option + "-columns"), std::string::npos) << refused.err;
    EXPECT_EQ(unknown_options("register", refused.err), std::set<std::string>{});
  }
}

TEST_F(NewcomerTest, InfoTakesManyFilesAndAnswersWithATable) {
  write_two_in_one();
  const ProgramRun one = run({"info", "a.ply"});
  EXPECT_EQ(one.out.rfind("file            a.ply\n", 0), 0U) << one.out;
  const ProgramRun many = run({"info", "a.ply", "all.e57", "b.ply"});
  EXPECT_EQ(many.status, 0) << many.err;
  EXPECT_EQ(std::count(many.out.begin(), many.out.end(), '\n'), 5) << many.out;
  for (const char* words : {"file", "format", "points", "size, m", "scanner", "notes", "a.ply", "all.e57 #0",
                            "all.e57 #1", "E57", in_a_.c_str()})
    EXPECT_NE(many.out.find(words), std::string::npos) << words << "\n" << many.out;
  const Json json = Json::parse(run({"info", "a.ply", "all.e57", "--json"}).out);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[1]["scans"].size(), 2U);
  EXPECT_TRUE(Json::parse(run({"info", "a.ply", "--json"}).out).is_object());
  write_whole(work() / "words.txt", "no scan\n");
  const ProgramRun bad = run({"info", "a.ply", "words.txt", "b.ply"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("words.txt"), std::string::npos) << bad.err;
  EXPECT_NE(bad.out.find("b.ply"), std::string::npos) << "the others are shown: " << bad.out;
}

TEST_F(NewcomerTest, AFileOfSeveralScansIsSplit) {
  write_two_in_one();
  write_whole(work() / "shift.txt", "1 0 0 1000\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const ProgramRun done = run({"transform", "shift.txt", "all.e57", "each", "--split"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json all = Json::parse(run({"info", "all.e57", "--json"}).out);
  for (const std::size_t k : {0U, 1U}) {
    const Json one = Json::parse(run({"info", "each/all_" + std::to_string(k) + ".e57", "--json"}).out);
    ASSERT_EQ(one["scans"].size(), 1U);
    EXPECT_EQ(one["scans"][0]["points"], all["scans"][k]["points"]);
    EXPECT_NEAR(one["scans"][0]["low"][0].get<double>(), all["scans"][k]["low"][0].get<double>() + 1000.0,
                1e-6);
  }
  ASSERT_EQ(run({"transform", "identity", "all.e57", "still", "--split"}).status, 0);
  const Json still = Json::parse(run({"info", "still/all_1.e57", "--json"}).out);
  EXPECT_EQ(still["scans"][0]["low"], all["scans"][1]["low"]);
  // Each has its own pose by a project's result, without a word.
  ASSERT_NE(run({"project", "all.e57", "-o", "again"}).status, 2);
  const ProgramRun placed = run({"transform", "again/project.json", "-o", "placed"});
  EXPECT_EQ(placed.status, 0) << placed.err;
  EXPECT_TRUE(fs::exists(work() / "placed/all_1.e57"));
  EXPECT_NE(run({"transform", "identity", "all.e57", "all2.e57", "--split"}).err.find("name of a folder"),
            std::string::npos);
}

TEST_F(NewcomerTest, OneScanOfAFileIsNamedByItsNumberEverywhere) {
  write_two_in_one();
  const Json one = Json::parse(run({"info", "all.e57 #1", "--json"}).out);
  const Json all = Json::parse(run({"info", "all.e57", "--json"}).out);
  ASSERT_EQ(one["scans"].size(), 1U);
  EXPECT_EQ(one["scans"][0]["low"], all["scans"][1]["low"]);
  EXPECT_NE(one["scans"][0]["low"], all["scans"][0]["low"]);
  EXPECT_EQ(run({"planes", "all.e57 #1", "-o", "planes.json"}).status, 0);
  EXPECT_EQ(run({"openings", "all.e57 #1", "-o", "openings.json"}).status, 0);
  EXPECT_EQ(run({"segments", "all.e57 #1", "-o", "segments.json"}).status, 0);
  EXPECT_EQ(run({"view", "all.e57 #0", "a.ply", "-o", "view.html"}).status, 0);
  const ProgramRun thin = run({"thin", "all.e57 #1", "thin.ply", "--points", "1000000"});
  EXPECT_NE(thin.out.find(in_b_ + " of " + in_b_ + " points"), std::string::npos) << thin.out << thin.err;
  const ProgramRun registered = run({"register", "all.e57 #0", "all.e57 #1", "-o", "out", "--no-report"});
  EXPECT_EQ(registered.status, 0) << registered.err;
  EXPECT_EQ(registered.err.find("hold the same"), std::string::npos) << registered.err;
  for (const std::string output : {"moved.ply", "moved.e57"}) {
    const ProgramRun moved = run({"transform", "out/result.json", "all.e57 #0", output});
    EXPECT_EQ(moved.status, 0) << moved.err;
    EXPECT_NE(moved.out.find(in_a_ + " points moved"), std::string::npos) << moved.out;
  }
  const ProgramRun project = run({"project", "all.e57 #1", "a.ply", "-o", "again"});
  EXPECT_EQ(project.status, 0) << project.err;
  const Json scans = Json::parse(read_whole(work() / "again/project.json"))["scans"];
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[1]["file"], "all.e57 #1");
  EXPECT_EQ(run({"transform", "again/project.json", "-o", "again_moved"}).status, 0);
  const ProgramRun none = run({"info", "all.e57 #2"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("#0 to #1"), std::string::npos) << none.err;
  EXPECT_EQ(run({"thin", "all.e57 #1", "all.e57", "--points", "10"}).status, 2) << "the file itself is kept";
}

TEST_F(NewcomerTest, APlanHasANorthArrowOnAMapAlone) {
  const std::string arrow = "<g class=\"north\"";
  ASSERT_EQ(run({"project", "a.ply", "b.ply", "-o", "out"}).status, 0);
  const std::string own = read_whole(work() / "out/report.html");
  EXPECT_NE(own.find("<svg class=\"plan\""), std::string::npos);
  EXPECT_EQ(own.find(arrow), std::string::npos);
  ASSERT_EQ(run({"project", "a.ply", "b.ply", "-o", "out", "--crs", kSiteGrid}).status, 0);
  EXPECT_NE(read_whole(work() / "out/report.html").find(arrow), std::string::npos);
}

/// Four rows of four numbers.
std::array<long double, 16> matrix_in(const fs::path& path) {
  std::istringstream text(read_whole(path));
  std::array<long double, 16> numbers{};
  for (long double& number : numbers) text >> number;
  return numbers;
}

std::array<long double, 3> moved(const std::array<long double, 16>& matrix,
                                 const std::array<long double, 3>& x) {
  std::array<long double, 3> y{};
  for (std::size_t k = 0; k < 3; ++k)
    y[k] = matrix[4 * k] * x[0] + matrix[4 * k + 1] * x[1] + matrix[4 * k + 2] * x[2] + matrix[4 * k + 3];
  return y;
}

TEST_F(NewcomerTest, AnOffsetThatAFileNamesIsSaidAndTakenOutAgain) {
  const std::string seen = "comment scanner_position 0 0 0\n";  // before the offset is added
  write_ply("a.ply", "plain_a.ply", seen);
  write_ply("b.ply", "plain_b.ply", seen);
  write_ply("a.ply", "grid_a.ply", "comment pivot 1.0512e+06 6.8419e+06 0\n" + seen);
  write_ply("b.ply", "grid_b.ply", "comment offset 1051200 6840000 120.5\n" + seen);
  const ProgramRun done = run({"register", "grid_a.ply", "grid_b.ply", "-o", "grid", "--no-report"});
  EXPECT_EQ(times_in(done.err, "the offset 1051200 6841900 0 m given in a comment of the file"), 1)
      << done.err;
  EXPECT_NE(done.out.find("transform_raw.txt"), std::string::npos) << done.out;
  const Json inputs = result_in("grid")["inputs"];
  EXPECT_EQ(inputs["source"]["offset_applied"], Json({1051200.0, 6841900.0, 0.0}));
  EXPECT_EQ(inputs["target"]["offset_applied"], Json({1051200.0, 6840000.0, 120.5}));
  const auto raw = matrix_in(work() / "grid/transform_raw.txt");
  const auto grid = matrix_in(work() / "grid/transform.txt");
  const std::array<long double, 3> from{1051200.0L, 6841900.0L, 0.0L};
  const std::array<long double, 3> to{1051200.0L, 6840000.0L, 120.5L};
  for (const std::array<long double, 3>& x :
       {std::array<long double, 3>{0, 0, 0}, {3.25L, -2.5L, 1.75L}, {-40, 60, 12}}) {
    const auto by_raw = moved(raw, x);
    const auto by_grid = moved(grid, {x[0] + from[0], x[1] + from[1], x[2] + from[2]});
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(std::abs(static_cast<double>(by_raw[k] + to[k] - by_grid[k])), 1e-6) << k;
  }
  // Of files without the comments the same matrix is transform.txt, and there is no second one.
  ASSERT_EQ(run({"register", "plain_a.ply", "plain_b.ply", "-o", "plain", "--no-report"}).status, 0);
  const auto plain = matrix_in(work() / "plain/transform.txt");
  for (std::size_t k = 0; k < 16; ++k) EXPECT_LT(std::abs(static_cast<double>(raw[k] - plain[k])), 1e-3) << k;
  EXPECT_FALSE(fs::exists(work() / "plain/transform_raw.txt"));
  EXPECT_FALSE(result_in("plain")["inputs"]["source"].contains("offset_applied"));
  // What an earlier run left does not stand beside other numbers.
  ASSERT_EQ(run({"register", "plain_a.ply", "plain_b.ply", "-o", "grid", "--no-report"}).status, 0);
  EXPECT_FALSE(fs::exists(work() / "grid/transform_raw.txt"));
}

/// A LAS file of one room in longitudes and latitudes, 1e-9 degrees per step, and the EPSG number of WGS 84.
std::string las_in_degrees(const std::vector<Place>& points) {
  using namespace testing_las;
  Parts parts;
  parts.minor = 2;
  parts.format = 0;
  const std::size_t bytes = point_bytes(parts);
  for (const Place& x : points) {
    std::string point(bytes, '\0');
    put(point, 0, static_cast<std::int32_t>(std::lround(x[0] / 73000.0 / 1e-9)));
    put(point, 4, static_cast<std::int32_t>(std::lround(x[1] / 111000.0 / 1e-9)));
    put(point, 8, static_cast<std::int32_t>(std::lround(x[2] / 1e-3)));
    parts.points += point;
  }
  std::string keys;
  for (const int word : {1, 1, 0, 1, 2048, 0, 1, 4326}) {
    std::string two(2, '\0');
    put(two, 0, static_cast<std::uint16_t>(word));
    keys += two;
  }
  parts.records.push_back(record("LASF_Projection", 34735, keys));
  std::string bytes_of_file = file(parts);
  for (const std::size_t at : {131U, 139U}) put(bytes_of_file, at, 1e-9);
  put(bytes_of_file, 147, 1e-3);
  put(bytes_of_file, 155, 7.75);
  put(bytes_of_file, 163, 48.58);
  put(bytes_of_file, 171, 140.0);
  return bytes_of_file;
}

TEST_F(NewcomerTest, WhatCannotGoWellIsSaidBeforeTheWork) {
  write_whole(work() / "degrees.las", las_in_degrees(points_of("a.ply")));
  const ProgramRun degrees = run({"register", "degrees.las", "b.ply", "-o", "out"});
  EXPECT_EQ(degrees.status, 2) << degrees.out;
  EXPECT_NE(degrees.err.find("degrees of longitude and latitude"), std::string::npos) << degrees.err;
  EXPECT_NE(run({"info", "degrees.las"}).out.find("degrees of longitude"), std::string::npos);
  const ProgramRun project = run({"project", "degrees.las", "a.ply", "b.ply", "-o", "mixed"});
  EXPECT_NE(project.err.find("degrees of longitude and latitude"), std::string::npos) << project.err;

  std::string ten;
  for (int k = 0; k < 10; ++k) ten += fmt::format("{} {} {}\n", k, k * k % 7, k * k * k % 5);
  write_whole(work() / "ten.xyz", ten);
  const ProgramRun few = run({"register", "ten.xyz", "b.ply", "-o", "out", "--no-report"});
  EXPECT_EQ(times_in(few.err, "holds 10 points, too few"), 1) << few.err;
  EXPECT_NE(run({"info", "ten.xyz"}).out.find("holds 10 points, too few"), std::string::npos);

  const ProgramRun alone = run({"project", "a.ply", "-o", "alone"});
  EXPECT_EQ(times_in(alone.err, "a.ply is the only scan"), 1) << alone.err;

  write_changed("a.ply", "y_up.xyz", [](const Place& x) { return Place{x[0], x[2], -x[1]}; });
  EXPECT_NE(run({"info", "y_up.xyz"}).out.find("its y axis seems to point up"), std::string::npos);
  EXPECT_EQ(run({"info", "a.ply"}).out.find("y axis"), std::string::npos);

  write_changed("a.ply", "mm.xyz", [](const Place& x) { return Place{1e3 * x[0], 1e3 * x[1], 1e3 * x[2]}; });
  const ProgramRun mixed = run({"project", "mm.xyz", "b.ply", "-o", "units"});
  EXPECT_EQ(times_in(mixed.err, "are they millimetres?"), 1) << mixed.err;
}

}  // namespace
}  // namespace limen
