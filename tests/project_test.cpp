// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen project from outside: a small simulated building, run again, shuffled, killed.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "run_program.h"
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/geometry/rigid.h"
#include "limen/io/cloud/read_scan.h"

namespace limen {
namespace {

using nlohmann::json;

Matrix4d matrix_of(const json& rows) {
  Matrix4d matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
  }
  return matrix;
}

class Project : public ProgramTest {
 protected:
  /// Two stations of one room.
  std::vector<std::string> simulate() {
    const ProgramRun made =
        run({"simulate", "room", "--points-indoor", "60000", "--seed", "1", "-o", "case", "--quiet"});
    EXPECT_EQ(made.status, 0) << made.err;
    return {"case/indoor_00.ply", "case/indoor_01.ply"};
  }

  [[nodiscard]] std::vector<std::string> call(const std::vector<std::string>& scans,
                                              const std::string& out) const {
    std::vector<std::string> arguments{"project"};
    arguments.insert(arguments.end(), scans.begin(), scans.end());
    arguments.insert(arguments.end(), {"-o", out, "--quiet"});
    return arguments;
  }

  [[nodiscard]] std::string text_of(const std::string& out) const {
    return read_whole(work() / out / "project.json");
  }

  /// Starts the program and kills it after a while.
  void run_and_kill(const std::vector<std::string>& arguments, int milliseconds) const {
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> words{const_cast<char*>(LIMEN_PROGRAM)};
      for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
      words.push_back(nullptr);
      if (chdir(work().c_str()) == 0) execv(LIMEN_PROGRAM, words.data());
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
};

TEST_F(Project, StationsStandWhereTheTruthHasThemAndBytesNeverDiffer) {
  std::vector<std::string> scans = simulate();
  const ProgramRun done = run(call(scans, "out"));
  EXPECT_EQ(done.status, 0) << done.err;
  const json project = json::parse(text_of("out"));
  ASSERT_EQ(project["scans"].size(), 2U);
  const json truth = json::parse(read_whole(work() / "case" / "truth" / "truth.json"));
  std::vector<Matrix4d> frame_from_world;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(project["scans"][k]["state"], "registered");
    ASSERT_EQ("case/" + truth["scans"][k]["file"].get<std::string>(), project["scans"][k]["file"]);
    frame_from_world.push_back(matrix_of(project["scans"][k]["frame_from_scan"]) *
                               matrix_of(truth["scans"][k]["world_from_scan"]).inverse());
  }
  // In no loop: accepted, but checked by nothing.
  EXPECT_EQ(project["links"][0]["state"], "bridge");
  const Matrix4d difference = frame_from_world[1] * frame_from_world[0].inverse();
  EXPECT_LT(rotation_angle(difference.topLeftCorner<3, 3>()), 0.002);
  EXPECT_LT((difference.topRightCorner<3, 1>()).norm(), 0.02);

  // From the store, in another order, with one thread.
  std::reverse(scans.begin(), scans.end());
  std::vector<std::string> again = call(scans, "out");
  again.insert(again.end(), {"--threads", "1"});
  const std::string before = text_of("out");
  EXPECT_EQ(run(again).status, done.status);
  EXPECT_EQ(text_of("out"), before);

  // From nothing, killed on its way.
  for (const int milliseconds : {300, 1500, 3000}) run_and_kill(call(scans, "killed"), milliseconds);
  EXPECT_EQ(run(call(scans, "killed")).status, done.status);
  EXPECT_EQ(text_of("killed"), before);

  const ProgramRun status = run({"project", "status", "out", "--json"});
  EXPECT_EQ(status.status, 0);
  EXPECT_EQ(json::parse(status.out)["stage"], "done");
  EXPECT_NE(read_whole(work() / "out" / "report.html").find("<svg"), std::string::npos);

  const ProgramRun moved = run({"transform", "out/project.json", "-o", "placed", "--as", "ply", "--quiet"});
  EXPECT_EQ(moved.status, 0) << moved.err;
  EXPECT_FALSE(std::filesystem::is_empty(work() / "placed"));
  const ProgramRun copc = run({"transform", "out/project.json", "-o", "all", "--merge", "--as", "copc"});
  EXPECT_EQ(copc.status, 0) << copc.err;
  EXPECT_TRUE(std::filesystem::exists(work() / "all.copc.laz"));
  const ProgramRun merged = run({"transform", "out/project.json", "-o", "all.las", "--merge", "--quiet"});
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_GT(std::filesystem::file_size(work() / "all.las"), 100000U);

  // In an E57 each station stays a scan of its own, known to the other.
  const ProgramRun e57 = run({"transform", "out/project.json", "-o", "all.e57", "--merge", "--quiet"});
  EXPECT_EQ(e57.status, 0) << e57.err;
  const ProgramRun reread = run(call({"all.e57"}, "reread"));
  EXPECT_EQ(reread.status, 0) << reread.err;
  const json joined = json::parse(text_of("reread"));
  ASSERT_EQ(joined["scans"].size(), 2U);
  EXPECT_EQ(joined["frame"]["kind"], "file");
  const bool given = std::any_of(joined["links"].begin(), joined["links"].end(),
                                 [](const json& link) { return link["pair"] == "given"; });
  EXPECT_TRUE(given);
  for (const json& scan : joined["scans"]) {
    EXPECT_EQ(scan["state"], "registered");
    const Matrix4d pose = matrix_of(scan["frame_from_scan"]);
    EXPECT_LT((pose - Matrix4d::Identity()).cwiseAbs().maxCoeff(), 0.01);
  }

  // Scans of one file are listed, and called, by their numbers from 0.
  EXPECT_NE(run({"info", "all.e57"}).out.find("scan 1 of 2 (all.e57 #0)"), std::string::npos);
  const ProgramRun unclear = run({"project", "decide", "reread", "level", "all.e57"});
  EXPECT_EQ(unclear.status, 2);
  EXPECT_NE(unclear.err.find("all.e57 #0, all.e57 #1"), std::string::npos) << unclear.err;
  EXPECT_EQ(run({"project", "decide", "reread", "level", "all.e57 #0"}).status, 0);
  const ProgramRun heeded = run({"project", "all.e57", "-o", "reread"});
  EXPECT_NE(heeded.out.find("all.e57 #0  ("), std::string::npos) << heeded.out;
  const json decided = json::parse(text_of("reread"));
  EXPECT_EQ(decided["decisions"][0]["decision"], "level 'all.e57 #0'");
  EXPECT_EQ(decided["decisions"][0]["state"], "unused");  // no other scan is said to be level
}

/// Cuts the first file of a store's room to so much of it.
void cut_first(const std::filesystem::path& room, double share) {
  ASSERT_FALSE(std::filesystem::is_empty(room)) << room;
  const std::filesystem::path file = std::filesystem::directory_iterator(room)->path();
  const auto bytes = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::resize_file(file, static_cast<std::uintmax_t>(share * bytes));
}

TEST_F(Project, WhatIsDamagedInTheStoreIsMadeAgain) {
  const std::vector<std::string> scans = simulate();
  ASSERT_EQ(run(call(scans, "out")).status, 0);
  const std::string project = text_of("out");
  const std::string page = read_whole(work() / "out" / "report.html");
  for (const double share : {0.0, 0.5}) {
    for (const char* room : {"files", "features", "digests", "pictures", "pairs"}) {
      cut_first(work() / "out" / "store" / room, share);
      const ProgramRun again = run(call(scans, "out"));
      EXPECT_EQ(again.status, 0) << room << again.err;
      EXPECT_EQ(text_of("out"), project) << room;
      EXPECT_EQ(read_whole(work() / "out" / "report.html"), page) << room;
    }
  }
}

TEST_F(Project, AResultThatCannotBeWrittenLeavesTheFormerReport) {
  const std::vector<std::string> scans = simulate();
  std::filesystem::create_directories(work() / "out" / "project.json");
  write_whole(work() / "out" / "report.html", "former");
  const ProgramRun done = run(call(scans, "out"));
  EXPECT_EQ(done.status, 2) << done.err;
  EXPECT_NE(done.err.find("project.json"), std::string::npos) << done.err;
  EXPECT_EQ(read_whole(work() / "out" / "report.html"), "former");
  EXPECT_FALSE(std::filesystem::exists(work() / "out" / "links.csv"));

  std::filesystem::remove(work() / "out" / "project.json");
  for (const char* name : {"report.pdf", "question_7.svg"}) write_whole(work() / "out" / name, "former");
  EXPECT_EQ(run(call(scans, "out")).status, 0);
  EXPECT_TRUE(std::filesystem::exists(work() / "out" / "project.json"));
  EXPECT_FALSE(std::filesystem::exists(work() / "out" / "report.pdf"));
  EXPECT_FALSE(std::filesystem::exists(work() / "out" / "question_7.svg"));
}

TEST_F(Project, WhatTheStoreKeepsOfAFileTellsNoOldNameAndIsOfNoOtherKind) {
  const std::vector<std::string> scans = simulate();
  const auto thinned = [&](const std::string& scan, const std::string& out) {
    EXPECT_EQ(run({"project", scan, "-o", out, "--memory", "1M", "--quiet"}).status, 0);
    return text_of(out);
  };
  EXPECT_NE(thinned(scans[0], "out").find("indoor_00.ply: thinned from"), std::string::npos);
  std::filesystem::copy(work() / scans[0], work() / "renamed.ply");
  const std::string renamed = thinned("renamed.ply", "out");
  EXPECT_EQ(renamed, thinned("renamed.ply", "fresh"));
  EXPECT_EQ(renamed.find("indoor_00"), std::string::npos);

  // A cloud is no model, also where it is kept as a scan.
  EXPECT_EQ(run(call(scans, "out")).status, 0);
  const auto as_model = [&](const std::string& out) {
    return run({"project", scans[1], "--model", scans[0], "-o", out, "--quiet"}).status;
  };
  EXPECT_EQ(as_model("out"), 3);
  EXPECT_EQ(as_model("new"), 3);
  EXPECT_EQ(text_of("out"), text_of("new"));
}

/// Squares of the distances of two passes' points from where they are in truth, once a shift of all is taken
/// out; `folder` holds them as they were written.
double spread_about_truth(const std::filesystem::path& case_folder, const std::filesystem::path& folder) {
  const json truth = json::parse(read_whole(case_folder / "truth" / "project.json"));
  Vector3d sum = Vector3d::Zero();
  double squares = 0.0;
  double count = 0.0;
  for (const json& scan : truth["scans"]) {
    if (scan["kind"] != "mobile") continue;
    const std::string file = scan["file"].get<std::string>();
    const Scan measured = read_scan(case_folder / file);
    const Scan placed = read_scan(folder / file);
    const json& drift = scan["drift"];
    for (std::size_t i = 0; i < measured.size(); i += 101) {
      const double share = (measured.times_s[i] - drift.front()[0].get<double>()) /
                           (drift.back()[0].get<double>() - drift.front()[0].get<double>());
      const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(drift.size() - 1);
      const json& then = drift[static_cast<std::size_t>(at)];
      const Vector3d error(then[1].get<double>(), then[2].get<double>(), then[3].get<double>());
      const Vector3d off =
          (placed.local_origin - measured.local_origin) + placed.points[i] - measured.points[i] + error;
      sum += off;
      squares += off.squaredNorm();
      count += 1.0;
    }
  }
  return squares / count - (sum / count).squaredNorm();
}

TEST_F(Project, PassesThatDriftAreBentBack) {
  const ProgramRun made =
      run({"simulate", "museum", "--project", "--stations", "1", "--passes", "2", "--drift-m", "0.015",
           "--points-indoor", "20000", "--points-outdoor", "150000", "--seed", "1", "-o", "case", "--quiet"});
  ASSERT_EQ(made.status, 0) << made.err;
  std::vector<std::string> passes{"case/pass_1.ply", "case/pass_2.ply"};
  // Two passes alone may leave a direction loose.
  const auto joined = [&](const std::vector<std::string>& arguments) {
    const int status = run(arguments).status;
    return status == 0 || status == 3;
  };
  ASSERT_TRUE(joined(call(passes, "bent")));
  const json bent = json::parse(text_of("bent"));
  for (const json& scan : bent["scans"]) {
    ASSERT_TRUE(scan.contains("correction")) << scan["reason"];
    EXPECT_GT(scan["correction"]["knots"].size(), 5U);
  }
  // The same bytes for one thread and another order.
  std::reverse(passes.begin(), passes.end());
  std::vector<std::string> again = call(passes, "again");
  again.insert(again.end(), {"--threads", "1"});
  ASSERT_TRUE(joined(again));
  EXPECT_EQ(text_of("again"), text_of("bent"));

  std::vector<std::string> rigid = call(passes, "rigid");
  rigid.emplace_back("--rigid-passes");
  ASSERT_TRUE(joined(rigid));
  EXPECT_EQ(json::parse(text_of("rigid"))["scans"][0]["rigid"], "treated as rigid, as you asked");
  for (const char* how : {"bent", "rigid"}) {
    const std::string from = std::string(how) + "/project.json";
    const std::string to = std::string("placed_") + how;
    const ProgramRun moved = run({"transform", from, "-o", to, "--quiet"});
    ASSERT_EQ(moved.status, 0) << moved.err;
  }
  EXPECT_TRUE(std::filesystem::exists(work() / "placed_bent" / "pass_1_trajectory.csv"));
  EXPECT_FALSE(std::filesystem::exists(work() / "placed_rigid" / "pass_1_trajectory.csv"));
  const double before = spread_about_truth(work() / "case", work() / "placed_rigid");
  const double after = spread_about_truth(work() / "case", work() / "placed_bent");
  EXPECT_LT(after, 0.5 * before);
}

TEST_F(Project, ScansThatCannotBeReadAndCopiesAreStatedAndStopNothing) {
  std::vector<std::string> scans = simulate();
  scans.resize(1);
  std::filesystem::copy(work() / scans.front(), work() / "copy.ply");
  write_whole(work() / "broken.ply",
              "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n");
  write_whole(work() / "list.txt", "# scans\ncopy.ply\n\nbroken.ply\n");
  const ProgramRun done = run(
      {"project", scans.front(), scans.front(), "missing.ply", "--scans", "list.txt", "-o", "out", "--json"});
  EXPECT_EQ(done.status, 3) << done.err;
  const json project = json::parse(done.out);
  std::map<std::string, json> by_name;
  for (const json& scan : project["scans"]) by_name[scan["file"]] = scan;
  EXPECT_EQ(by_name.size(), 4U);
  EXPECT_EQ(by_name["broken.ply"]["readable"], false);
  EXPECT_EQ(by_name["missing.ply"]["readable"], false);
  EXPECT_EQ(by_name["missing.ply"]["reason"], "there is no such file");
  const bool copy_stated =
      by_name["copy.ply"].contains("copy_of") || by_name[scans.front()].contains("copy_of");
  EXPECT_TRUE(copy_stated);
  EXPECT_NE(done.out.find("more than once"), std::string::npos);
  const ProgramRun of_copy = run({"project", "decide", "out", "level", "copy.ply"});
  EXPECT_EQ(of_copy.status, 2);
  EXPECT_NE(of_copy.err.find("name the original: case/indoor_00.ply"), std::string::npos) << of_copy.err;
  EXPECT_EQ(run({"project", "status", "out"}).out,
            "stage done: 4 files: 1 ready, 1 copy, 2 unreadable; 0 of 0 pairs tried\n");
  const json status = json::parse(run({"project", "status", "out", "--json"}).out);
  EXPECT_EQ(status["files"], 4);
  EXPECT_EQ(status["files_copies"], 1);
}

TEST_F(Project, APairThatIsTriedAnyWayRoundOnceMoreCountsOnce) {
  for (const char* seed : {"1", "7"})
    ASSERT_EQ(run({"simulate", "room", "--points-indoor", "20000", "--seed", seed, "-o", seed}).status, 0);
  ASSERT_EQ(run(call({"1/indoor_00.ply", "7/indoor_00.ply"}, "out")).status, 4);
  EXPECT_EQ(json::parse(text_of("out"))["pairs_tried"], 1);
  EXPECT_EQ(run({"project", "status", "out"}).out, "stage done: 2 files: 2 ready; 1 of 1 pairs tried\n");
}

TEST_F(Project, AllFilesAreHeldAgainstTheProjectBeforeOneIsMoved) {
  const std::vector<std::string> scans = simulate();
  ASSERT_EQ(run(call(scans, "out")).status, 0);
  const std::string bytes = read_whole(work() / scans[1]);
  const auto refused = [&](const std::vector<std::string>& more, const std::string& must_say) {
    std::vector<std::string> words = {"transform", "out/project.json", "-o"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramRun done = run(words);
    EXPECT_EQ(done.status, 2);
    EXPECT_NE(done.err.find(scans[1] + ": " + must_say), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(work() / "placed"));
    EXPECT_FALSE(std::filesystem::exists(work() / "all.ply"));
  };
  write_whole(work() / scans[1], read_whole(work() / scans[0]));
  refused({"placed"}, "is not the file registered in out/project.json");
  refused({"all.ply", "--merge"}, "is not the file registered in out/project.json");
  const ProgramRun forced = run({"transform", "out/project.json", "-o", "forced", "--force", "--quiet"});
  EXPECT_EQ(forced.status, 0) << forced.err;
  std::filesystem::remove(work() / scans[1]);
  refused({"placed"}, "there is no such file");
  refused({"placed", "--force"}, "there is no such file");
  write_whole(work() / scans[1], bytes);
  const ProgramRun moved = run({"transform", "out/project.json", "-o", "placed", "--quiet"});
  EXPECT_EQ(moved.status, 0) << moved.err;
  // None is written over another.
  EXPECT_EQ(run({"transform", "out/project.json", "-o", "case"}).status, 2);
}

TEST_F(Project, AStartByThreePlacesIsTestedLikeAnObservation) {
  const std::vector<std::string> scans = simulate();
  EXPECT_EQ(run(call(scans, "out")).status, 0);
  const json found = json::parse(text_of("out"));
  const json& link = found["links"][0];
  const auto name = [&](const char* side) {
    return found["scans"][link[side].get<std::size_t>()]["file"].get<std::string>();
  };
  const Rigid3 target_from_source = from_matrix(matrix_of(link["pose"]));
  const auto decide = [&](const Vector3d& miss) {
    std::vector<std::string> words{"project", "decide", "out", "start", name("source"), name("target")};
    for (const Vector3d& x : {Vector3d(-1.5, -1, 0), Vector3d(2, 0.5, 0), Vector3d(0, 2, 0.2)}) {
      const Vector3d y = target_from_source * x + miss;
      words.push_back(fmt::format("{},{},{}={},{},{}", x.x(), x.y(), x.z(), y.x(), y.y(), y.z()));
    }
    return run(words);
  };
  for (const bool right : {true, false}) {
    EXPECT_EQ(decide(right ? Vector3d(0.2, -0.1, 0.1) : Vector3d(6, 0, 0)).status, 0);
    EXPECT_EQ(run(call(scans, "out")).status, 0);
    const json decided = json::parse(text_of("out"))["decisions"];
    ASSERT_EQ(decided.size(), 1U);
    EXPECT_EQ(decided[0]["state"], right ? "kept" : "contradicted") << decided;
  }
  const ProgramRun line = run({"project", "decide", "out", "start", name("source"), name("target"),
                               "0,0,0=0,0,0", "1,0,0=1,0,0", "2,0,0=2,0,0"});
  EXPECT_EQ(line.status, 2);
  EXPECT_NE(line.err.find("lie nearly in a line"), std::string::npos) << line.err;
}

TEST_F(Project, DecisionsAreHeededTestedAndSurviveRuns) {
  const std::vector<std::string> scans = simulate();
  EXPECT_EQ(run(call(scans, "out")).status, 0);
  const std::string before = text_of("out");
  EXPECT_EQ(run({"project", "decide", "nowhere", "reject", "indoor_00.ply", "indoor_01.ply"}).status, 2);
  EXPECT_EQ(run({"project", "decide", "out", "reject", "indoor_00.ply"}).status, 2);
  const ProgramRun no_pose =
      run({"project", "decide", "out", "choose", "indoor_00.ply", "indoor_01.ply", "700"});
  EXPECT_EQ(no_pose.status, 2);
  EXPECT_NE(no_pose.err.find("has no pose 700"), std::string::npos) << no_pose.err;
  EXPECT_EQ(run({"project", "decide", "out", "reject", "indoor_01.ply", "indoor_00.ply"}).status, 0);
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(run(call(scans, "out")).status, 4);
    const json project = json::parse(text_of("out"));
    EXPECT_EQ(project["decisions"][0]["decision"], "reject case/indoor_00.ply case/indoor_01.ply");
    EXPECT_EQ(project["decisions"][0]["state"], "kept");
    EXPECT_EQ(project["links"][0]["state"], "rejected");
    EXPECT_EQ(project["links"][0]["reason"], "rejected by your decision");
  }
  write_whole(work() / "half.json",
              R"({"decisions": [{"choose": ["indoor_00.ply", "indoor_01.ply"], "pose": 0.9}]})");
  std::vector<std::string> with_half = call(scans, "out");
  with_half.insert(with_half.end(), {"--decide", "half.json"});
  EXPECT_EQ(run(with_half).status, 2);
  // With its folder or without, it is the same scan: the later decision replaces the earlier.
  const ProgramRun spelled =
      run({"project", "decide", "out", "reject", "case/indoor_00.ply", "case/indoor_01.ply", "--json"});
  EXPECT_EQ(json::parse(spelled.out)["decisions"].size(), 1U) << spelled.out;
  // From a file, over what was said before; names that nothing has are reported.
  write_whole(
      work() / "words.json",
      R"({"decisions": [{"accept": ["indoor_00.ply", "indoor_01.ply"]}, {"level": ["cellar.ply"]}]})");
  std::vector<std::string> with_file = call(scans, "out");
  with_file.insert(with_file.end(), {"--decide", "words.json"});
  EXPECT_EQ(run(with_file).status, 0);
  const json project = json::parse(text_of("out"));
  ASSERT_EQ(project["decisions"].size(), 2U);
  EXPECT_EQ(project["decisions"][0]["state"], "kept");
  EXPECT_EQ(project["decisions"][1]["state"], "unused");
  EXPECT_NE(read_whole(work() / "out" / "report.html").find("Your decisions"), std::string::npos);
  EXPECT_EQ(run({"project", "decide", "out", "forget", "indoor_00.ply", "indoor_01.ply"}).status, 0);
  EXPECT_EQ(run({"project", "decide", "out", "forget", "cellar.ply"}).status, 0);
  const ProgramRun unsaid = run({"project", "decide", "out", "forget", "cellar.ply"});
  EXPECT_EQ(unsaid.status, 0);
  EXPECT_NE(unsaid.out.find("no such decision was saved"), std::string::npos) << unsaid.out;
  EXPECT_EQ(run(call(scans, "out")).status, 0);
  EXPECT_EQ(text_of("out"), before);
  write_whole(work() / "words.json", R"({"decisions": [{"agree": ["a"]}]})");
  const ProgramRun bad = run(with_file);
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("words.json, decision 1"), std::string::npos) << bad.err;
}

TEST_F(Project, NoInputIsReplaced) {
  const std::vector<std::string> scans = simulate();
  const std::string survey = "file,x,y,z\nindoor_00.ply,1,2,3\n";
  write_whole(work() / "stations.csv", survey);
  std::vector<std::string> words = call(scans, ".");
  words.insert(words.end(), {"--poses", "stations.csv"});
  const ProgramRun refused = run(words);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("would overwrite the input"), std::string::npos) << refused.err;
  EXPECT_EQ(read_whole(work() / "stations.csv"), survey);
}

TEST_F(Project, AScanWithoutAPlaceIsNotReplacedEither) {
  std::vector<std::string> scans = simulate();
  std::string stray;
  for (int k = 0; k < 400; ++k)
    stray += std::to_string(0.1 * (k % 20)) + " " + std::to_string(0.1 * (k / 20)) + " 5\n";
  write_whole(work() / "stray.xyz", stray);
  scans.emplace_back("stray.xyz");
  EXPECT_EQ(run(call(scans, "out")).status, 3);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"transform", "out/project.json", "--merge", "-o", "stray.xyz"},
        {"view", "out/project.json", "-o", "stray.xyz"}}) {
    const ProgramRun refused = run(words);
    EXPECT_EQ(refused.status, 2) << words[0];
    EXPECT_NE(refused.err.find("would overwrite the input"), std::string::npos) << refused.err;
    EXPECT_EQ(read_whole(work() / "stray.xyz"), stray) << words[0];
  }
  const ProgramRun own = run({"deviation", "out/project.json", "-o", "out"});
  EXPECT_EQ(own.status, 2);
  EXPECT_NE(own.err.find("is the folder of the project"), std::string::npos) << own.err;
}

TEST_F(Project, OptionsBeforeTheScansTakeNoScan) {
  const std::vector<std::string> scans = simulate();
  EXPECT_EQ(run({"simulate", "office", "--points-indoor", "2000", "-o", "office", "--quiet"}).status, 0);
  const ProgramRun done =
      run({"project", "--model", "office/model.ifc", scans[0], scans[1], "-o", "out", "--quiet"});
  EXPECT_NE(done.status, 2) << done.err;
  EXPECT_EQ(json::parse(text_of("out"))["scans"].size(), 3U);
}

TEST_F(Project, ATargetThatNoScanShowsEndsNothing) {
  std::vector<std::string> words = call(simulate(), "out");
  words.insert(words.end(), {"--sphere-radius", "72.5mm"});
  const ProgramRun done = run(words);
  EXPECT_EQ(done.status, 0) << done.err;
}

TEST_F(Project, ATrajectoryThatNoScanWasMeasuredAlongIsNoted) {
  const std::vector<std::string> scans = simulate();
  write_whole(work() / "way.csv", "time,x,y,z\n1,0,0,0\n2,1,0,0\n3,2,0,0\n");
  const ProgramRun done = run({"project", scans[0], "--trajectory", "way.csv", "-o", "along"});
  EXPECT_NE(done.err.find("way.csv: no scan was measured along this trajectory"), std::string::npos)
      << done.err;
}

TEST_F(Project, WhatIsMissingIsStated) {
  const ProgramRun nowhere = run({"project", "a.ply"});
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_NE(nowhere.err.find("-o DIR"), std::string::npos);
  EXPECT_EQ(run({"project", "-o", "out"}).status, 2);
  EXPECT_FALSE(std::filesystem::exists(work() / "out"));
  EXPECT_EQ(run({"project", "status", "nothing"}).status, 2);
  write_whole(work() / "list.txt", "# scans\nbroken.ply\n");
  write_whole(work() / "broken.ply", "ply\n");
  const ProgramRun listed = run({"project", "list.txt", "-o", "out"});
  EXPECT_NE(listed.err.find("--scans list.txt"), std::string::npos) << listed.err;
  const ProgramRun broken = run({"project", "broken.ply", "-o", "out"});
  EXPECT_EQ(broken.status, 2);
  EXPECT_NE(broken.err.find("broken.ply"), std::string::npos);
}

}  // namespace
}  // namespace limen
