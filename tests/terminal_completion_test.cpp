// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// Completion scripts, manual page, --json of every command: what the program tells about itself.
#include <algorithm>
#include <sstream>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

class SelfDescription : public ProgramTest {
 protected:
  /// Runs a script in work().
  [[nodiscard]] ProgramRun run_shell(const std::string& shell, const std::string& script) const {
    write_whole(work() / "script", script);
    const std::string command =
        "cd '" + work().string() + "' && " + shell + " ./script > out 2> err < /dev/null";
    const int status = std::system(command.c_str());
    ProgramRun done;
    done.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    done.out = read_whole(work() / "out");
    done.err = read_whole(work() / "err");
    return done;
  }

  [[nodiscard]] static bool installed(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
  }

  /// What bash offers for a line whose last word is being typed, one word per line, sorted.
  [[nodiscard]] std::string completed(const std::vector<std::string>& words) const {
    write_whole(work() / "completion.bash", run({"completion", "bash"}).out);
    std::string script = "source ./completion.bash\nCOMP_WORDS=(";
    for (const std::string& word : words) script += "'" + word + "' ";
    script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
              "\n_limen\nprintf '%s\\n' \"${COMPREPLY[@]}\" | LC_ALL=C sort\n";
    const ProgramRun done = run_shell("bash", script);
    EXPECT_EQ(done.err, "");
    return done.out;
  }
};

TEST_F(SelfDescription, BashCompletesCommands) {
  EXPECT_EQ(completed({"limen", "re"}), "register\n");
  EXPECT_NE(completed({"limen", ""}).find("deviation\n"), std::string::npos);
  EXPECT_EQ(completed({"limen", "--ver"}), "--version\n");
}

TEST_F(SelfDescription, BashCompletesOptionsAndTheirChoices) {
  EXPECT_EQ(completed({"limen", "register", "--method", ""}), "auto\nhybrid\nopenings\npolygons\nsegments\n");
  EXPECT_EQ(completed({"limen", "register", "a.ply", "--method", "=", "p"}), "polygons\n");
  EXPECT_EQ(completed({"limen", "register", "--source-o"}), "--source-origin\n");
  EXPECT_EQ(completed({"limen", "register", "--threads", ""}), "\n");
}

TEST_F(SelfDescription, BashCompletesFilesAndFolders) {
  std::filesystem::create_directory(work() / "a room");
  write_whole(work() / "a room.ply", "");
  EXPECT_EQ(completed({"limen", "register", "a r"}), "a room\na room.ply\n");
  EXPECT_EQ(completed({"limen", "register", "x.ply", "-o", "a r"}), "a room\n");
  EXPECT_EQ(completed({"limen", "simulate", "mus"}), "museum\n");
}

TEST_F(SelfDescription, OtherShellsReadTheirScripts) {
  for (const std::string shell : {"zsh", "fish"}) {
    if (!installed(shell)) continue;
    EXPECT_EQ(run_shell(shell + " -n", run({"completion", shell}).out).err, "") << shell;
  }
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  write_whole(work() / "limen.fish", run({"completion", "fish"}).out);
  const ProgramRun fish = run_shell("fish", "source ./limen.fish\ncomplete -C'limen register --method '\n");
  EXPECT_NE(fish.out.find("hybrid"), std::string::npos) << fish.err;
}

TEST_F(SelfDescription, TheManualPageIsCleanAndTellsEveryOption) {
  const std::string page = run({"man"}).out;
  EXPECT_EQ(page.rfind(".\\\" SPDX", 0), 0U);
  const ProgramRun help = run({"register", "--help"});
  std::istringstream words(help.out);
  for (std::string word; words >> word;) {
    if (word.rfind("--", 0) != 0 || word.back() == ',') continue;
    std::string roff;
    for (const char c : word) roff += c == '-' ? std::string("\\-") : std::string(1, c);
    EXPECT_NE(page.find(roff), std::string::npos) << word;
  }
  write_whole(work() / "limen.1", page);
  if (installed("mandoc")) {
    EXPECT_EQ(run_shell("sh", "mandoc -Tlint -Wwarning limen.1").out, "");
  }
  if (installed("groff")) {
    EXPECT_EQ(run_shell("sh", "groff -man -ww -Tascii limen.1 > /dev/null").err, "");
  }
}

TEST_F(SelfDescription, HelpFitsEightyColumnsAndEndsWithExamples) {
  for (const std::string command :
       {"info", "planes", "openings", "segments", "register", "transform", "evaluate", "deviation",
        "simulate", "thin", "view", "schema", "completion"}) {
    const std::string help = run({command, "--help"}).out;
    EXPECT_NE(help.find("\nExamples:\n"), std::string::npos) << command;
    EXPECT_EQ(help.find("TEXT"), std::string::npos) << command;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << command << ": " << line;
  }
}

TEST_F(SelfDescription, EveryCommandAnswersInJsonAndNothingElse) {
  const std::vector<std::vector<std::string>> calls = {
      {"simulate", "room", "-o", "case", "--points-indoor", "30000", "--stations", "2"},
      {"simulate", "office", "-o", "office", "--points-indoor", "30000"},
      {"info", "case/indoor_00.ply"},
      {"info", "office/model.ifc"},
      {"planes", "case/indoor_00.ply", "-o", "planes.json"},
      {"openings", "case/indoor_00.ply", "-o", "openings.json"},
      {"segments", "case/indoor_00.ply", "-o", "segments.json"},
      {"register", "case/indoor_00.ply", "case/indoor_01.ply", "-o", "result"},
      {"evaluate", "result/result.json", "case/truth/truth.json"},
      {"transform", "result/result.json", "case/indoor_00.ply", "moved.ply"},
      {"deviation", "office/scan_01.ply", "office/model.ifc", "--identity", "-o", "deviation"},
      {"thin", "case/indoor_00.ply", "thin.ply", "--points", "1000"},
      {"view", "case/indoor_00.ply", "-o", "view.html"},
      {"completion", "bash"},
      {"man"}};
  for (std::vector<std::string> call : calls) {
    call.push_back("--json");
    const ProgramRun done = run(call);
    EXPECT_EQ(done.status, 0) << call[0] << ": " << done.err;
    EXPECT_TRUE(nlohmann::json::accept(done.out)) << call[0] << ": " << done.out.substr(0, 200);
  }
}

}  // namespace
}  // namespace limen
