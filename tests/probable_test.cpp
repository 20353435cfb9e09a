// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// An answer that is placed, but less surely than `registered` asks for, as a user meets it.
#include <algorithm>

#include "run_program.h"
#include <nlohmann/json.hpp>

namespace limen {
namespace {

using Json = nlohmann::json;

class ProbableTest : public ProgramTest {
 protected:
  /// A room that is registered by the usual risk, and by one that nothing reaches only probable.
  void make_probable() const {
    ASSERT_EQ(run({"simulate", "room", "--points-indoor", "60000", "-o", ".", "--quiet"}).status, 0);
    ASSERT_EQ(run({"register", "indoor_00.ply", "indoor_01.ply", "-o", "sure", "--no-report"}).status, 0);
    const ProgramRun done =
        run({"register", "indoor_00.ply", "indoor_01.ply", "-o", "out", "--risk", "1e-13"});
    EXPECT_EQ(done.status, 3) << done.err;
    EXPECT_NE(done.out.find("probable: probability "), std::string::npos) << done.out;
    EXPECT_NE(done.out.find("to be more certain"), std::string::npos) << done.out;
  }
};

TEST_F(ProbableTest, ThePoseIsWrittenAsForRegisteredAndTheStatusIsThree) {
  make_probable();
  const Json result = Json::parse(read_whole(work() / "out" / "result.json"));
  EXPECT_EQ(result["outcome"], "probable");
  EXPECT_TRUE(result["unobserved"].empty());
  const Json sure = Json::parse(read_whole(work() / "sure" / "result.json"));
  EXPECT_EQ(sure["outcome"], "registered");
  EXPECT_EQ(result["target_from_source"], sure["target_from_source"]);
  EXPECT_EQ(read_whole(work() / "out" / "transform.txt"), read_whole(work() / "sure" / "transform.txt"));
  EXPECT_NE(read_whole(work() / "out" / "report.html").find("Probable: a pose was found"), std::string::npos);
}

TEST_F(ProbableTest, ItIsMovedWithOneWarningThatNamesTheProbability) {
  make_probable();
  const ProgramRun moved = run({"transform", "out/result.json", "indoor_00.ply", "moved.ply", "--quiet"});
  EXPECT_EQ(moved.status, 0) << moved.err;
  EXPECT_NE(moved.err.find("warning: the pose in out/result.json is only probable; the probability that it "
                           "is right is more than 99.99 %"),
            std::string::npos)
      << moved.err;
  EXPECT_EQ(std::count(moved.err.begin(), moved.err.end(), '\n'), 1);
  EXPECT_TRUE(std::filesystem::exists(work() / "moved.ply"));
}

TEST_F(ProbableTest, ABoundThatIsNoneIsRefused) {
  write_whole(work() / "a.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  for (const std::string bound : {"0.0005", "0.5", "likely"}) {
    const ProgramRun done = run({"register", "a.xyz", "a.xyz", "-o", "out", "--probable-risk", bound});
    EXPECT_EQ(done.status, 2) << bound;
    EXPECT_NE(done.err.find("probable"), std::string::npos) << done.err;
  }
}

}  // namespace
}  // namespace limen
