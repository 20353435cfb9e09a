// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// The report that `limen register` writes, as a script meets it; tests/browser looks at the page itself.
#include <cstdlib>
#include <iterator>
#include <regex>
#include <utility>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class ReportTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "40000"}).status, 0);
  }
  [[nodiscard]] ProgramRun register_rooms(std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"register", "room/indoor_00.ply", "room/indoor_01.ply", "-o", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  [[nodiscard]] std::string page() const { return read_whole(work() / "out/report.html"); }
};

TEST_F(ReportTest, StandsBesideEveryResult) {
  ASSERT_EQ(register_rooms().status, 0);
  for (const char* name : {"report.html", "section_top.svg", "section_front.svg", "section_side.svg"})
    EXPECT_TRUE(std::filesystem::exists(work() / "out" / name)) << name;
  EXPECT_NE(page().find("Registered: the two scans fit in one way only"), std::string::npos);
  const Json inputs = Json::parse(read_whole(work() / "out/result.json"))["inputs"];
  const std::string hash = inputs["source"]["sha256"];
  EXPECT_TRUE(std::regex_match(hash, std::regex("[0-9a-f]{64}")));
  EXPECT_NE(page().find(hash), std::string::npos);
  EXPECT_NE(hash, inputs["target"]["sha256"]);
}

TEST_F(ReportTest, IsLeftOutAndTakenAwayWhereNotWanted) {
  ASSERT_EQ(register_rooms().status, 0);
  ASSERT_EQ(register_rooms({"--no-report"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(work() / "out/report.html"));
  EXPECT_FALSE(std::filesystem::exists(work() / "out/section_top.svg"));
  EXPECT_TRUE(std::filesystem::exists(work() / "out/result.json"));
}

TEST_F(ReportTest, TellsOfNoMatchAndOfSegments) {
  ASSERT_EQ(run({"segments", "room/indoor_00.ply", "-o", "a.json"}).status, 0);
  ASSERT_EQ(run({"register", "a.json", "a.json", "-o", "out"}).status, 0);
  EXPECT_NE(page().find("the two lists of segments fit in one way only"), std::string::npos);
  write_whole(work() / "few.json", "{\"segments\": [{\"a\": [0, 0, 0], \"b\": [1, 0, 0]}]}");
  const ProgramRun none = run({"register", "few.json", "a.json", "-o", "out"});
  ASSERT_EQ(none.status, 4) << none.err;
  EXPECT_NE(page().find("No match: the two lists of segments"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(work() / "out/transform.txt"));
}

TEST_F(ReportTest, CarriesALogoThatIsAnImage) {
  write_whole(work() / "words.png", "a text");
  const ProgramRun refused = register_rooms({"--logo", "words.png"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("words.png: is no image"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "out"));
  write_whole(work() / "logo.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0h9v9z\"/></svg>");
  ASSERT_EQ(register_rooms({"--logo", "logo.svg"}).status, 0);
  EXPECT_NE(page().find("<img class=\"logo\" alt=\"\" src=\"data:image/svg+xml;base64,PHN2"),
            std::string::npos);
}

/// A program in place of the browser: a shell script that knows as `$pdf` where to print to.
class PrintedReportTest : public ReportTest {
 protected:
  void TearDown() override {
    unsetenv("LIMEN_CHROMIUM");
    ReportTest::TearDown();
  }
  void write_browser(const std::string& script) const {
    const auto path = work() / "browser";
    write_whole(
        path,
        "#!/bin/sh\nfor word; do case $word in --print-to-pdf=*) pdf=${word#*=};; esac; done\n" + script);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    setenv("LIMEN_CHROMIUM", path.c_str(), 1);
  }
  [[nodiscard]] std::size_t files_beside_the_report() const {
    const std::filesystem::directory_iterator all(work() / "out");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
};

TEST_F(PrintedReportTest, StandsBesideThePage) {
  ASSERT_EQ(register_rooms().status, 0);
  const std::size_t without = files_beside_the_report();
  write_browser("printf '%%PDF-1.4 ' > \"$pdf\"; echo \"$word\" >> \"$pdf\"\n");
  const ProgramRun done = register_rooms({"--pdf"});
  ASSERT_EQ(done.status, 0) << done.err;
  const std::string pdf = read_whole(work() / "out/report.pdf");
  EXPECT_EQ(pdf.substr(0, 16), "%PDF-1.4 file://");
  EXPECT_NE(pdf.find("/out/report.html\n"), std::string::npos);
  EXPECT_EQ(files_beside_the_report(), without + 1);  // nothing is left of the browser
  // It never comes with other numbers.
  ASSERT_EQ(register_rooms().status, 0);
  EXPECT_FALSE(std::filesystem::exists(work() / "out/report.pdf"));
}

TEST_F(PrintedReportTest, ABrowserThatFailsCostsThePdfAlone) {
  for (const auto& [script, words] :
       {std::pair{"exit 7\n", "ended with status 7"}, std::pair{"kill -9 $$\n", "was ended by signal 9"},
        std::pair{"exit 0\n", "printed nothing"}}) {
    write_browser(script);
    const ProgramRun done = register_rooms({"--pdf"});
    EXPECT_EQ(done.status, 0);
    EXPECT_NE(done.err.find("report.pdf could not be written"), std::string::npos) << done.err;
    EXPECT_NE(done.err.find(words), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(work() / "out/report.pdf"));
    EXPECT_TRUE(std::filesystem::exists(work() / "out/report.html"));
  }
}

TEST_F(PrintedReportTest, ABrowserThatIsMissingIsStatedBeforeTheWork) {
  setenv("LIMEN_CHROMIUM", "/no/such/browser", 1);
  const ProgramRun done = register_rooms({"--pdf"});
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("LIMEN_CHROMIUM=/no/such/browser"), std::string::npos) << done.err;
  EXPECT_FALSE(std::filesystem::exists(work() / "out"));
  EXPECT_NE(register_rooms({"--pdf", "--no-report"}).err.find("--no-report"), std::string::npos);
}

TEST_F(ReportTest, DiffersBetweenRunsInTheSecondsOnly) {
  const auto without_times = [](const std::string& text) {
    const std::size_t from = text.find("<table id=\"stages\"");
    return text.substr(0, from) + text.substr(text.find("</table>", from));
  };
  ASSERT_EQ(register_rooms({"--threads", "1"}).status, 0);
  const std::string one = without_times(page());
  ASSERT_EQ(register_rooms({"--threads", "3"}).status, 0);
  EXPECT_EQ(one, without_times(page()));
}

}  // namespace
}  // namespace limen
