// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A scan of a building that was not built as planned, measured against its model as a user does it.
#include <algorithm>
#include <cmath>
#include <map>

#include "run_program.h"
#include <nlohmann/json.hpp>

#include "limen/geometry/rigid.h"

namespace limen {
namespace {

using Json = nlohmann::json;

Vector3d vector_of(const Json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

class DeviationProgramTest : public ProgramTest {
 protected:
  [[nodiscard]] Json json_of(const std::string& path) const { return Json::parse(read_whole(work() / path)); }

  /// The true pose of the first scan as a result would tell it.
  void write_true_result(const Json& truth, bool inverted) const {
    Matrix4d matrix;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j)
        matrix(i, j) =
            truth["scans"][0]["world_from_scan"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]
                .get<double>();
    }
    const Matrix4d told = to_matrix(inverted ? inverse(from_matrix(matrix)) : from_matrix(matrix));
    Json result;
    for (int i = 0; i < 4; ++i) {
      result["target_from_source"].push_back({told(i, 0), told(i, 1), told(i, 2), told(i, 3)});
    }
    result["inputs"]["source"]["path"] = inverted ? "model.ifc" : "elsewhere/scan_01.ply";
    result["inputs"]["target"]["path"] = inverted ? "scan_01.ply" : "model.ifc";
    write_whole(work() / "true.json", result.dump());
  }
};

TEST_F(DeviationProgramTest, ShiftsAndMissingElementsOfAnOffice) {
  ASSERT_EQ(run({"simulate", "office", "--as-built", "--seed", "3", "-o", "."}).status, 0);
  const Json truth = json_of("truth/truth.json");
  std::map<int, Json> changes;
  for (const Json& change : truth["model"]["changes"]) changes[change["element"].get<int>()] = change;
  write_true_result(truth, false);
  const ProgramRun done =
      run({"deviation", "scan_01.ply", "model.ifc", "--result", "true.json", "-o", "out"});
  ASSERT_EQ(done.status, 0) << done.out << done.err;
  const Json found = json_of("out/deviation.json");
  EXPECT_EQ(std::count(done.out.begin(), done.out.end(), '\0'), 0);
  int judged = 0;
  for (const Json& element : found["elements"]) {
    const auto change = changes.find(element["element"].get<int>());
    const bool there = change == changes.end() || change->second["state"] == "moved";
    EXPECT_FALSE(there && element["presence"] == "not_found") << element["name"];
    EXPECT_FALSE(!there && element["presence"] == "found") << element["name"];
    if (!there || element["presence"] != "found" || element["points"] < 1000) continue;
    ++judged;
    Vector3d error = vector_of(element["shift"]["shift_m"]);
    if (change != changes.end()) error -= vector_of(change->second["shift_m"]);
    for (const Json& open : element["shift"]["open"]) {
      const Vector3d direction = vector_of(open);
      error -= direction.dot(error) * direction;
    }
    EXPECT_LT(error.norm(), 0.003) << element["name"];
  }
  EXPECT_GE(judged, 5);
  EXPECT_GE(found["unmodelled"].size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(work() / "out" / "deviation.ply"));
  EXPECT_TRUE(std::filesystem::exists(work() / "out" / "deviation.csv"));

  // The other way round, and twice the same bytes.
  write_true_result(truth, true);
  ASSERT_EQ(run({"deviation", "scan_01.ply", "model.ifc", "--result", "true.json", "-o", "back"}).status, 0);
  EXPECT_EQ(json_of("back/deviation.json")["summary"]["points_on_faces"],
            found["summary"]["points_on_faces"]);
  ASSERT_EQ(
      run({"deviation", "scan_01.ply", "model.ifc", "--result", "true.json", "-o", "again", "--threads", "1"})
          .status,
      0);
  for (const char* name : {"deviation.json", "deviation.csv", "deviation.ply"})
    EXPECT_EQ(read_whole(work() / "back" / name), read_whole(work() / "again" / name)) << name;
}

TEST_F(DeviationProgramTest, MistakesAreNamedAndLeaveNothingBehind) {
  write_whole(work() / "cube.obj",
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
              "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  write_whole(work() / "scan.xyz", "0.1 0.1 1\n0.2 0.2 1\n0.3 0.1 1.0\n");
  write_whole(work() / "none.json", R"({"outcome": "no_match", "target_from_source": null})");
  const auto fails = [this](std::vector<std::string> arguments, const std::string& word) {
    arguments.insert(arguments.begin(), "deviation");
    arguments.insert(arguments.end(), {"-o", "out"});
    const ProgramRun done = run(arguments);
    EXPECT_EQ(done.status, 2);
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(work() / "out"));
  };
  fails({"scan.xyz", "cube.obj"}, "--result");
  fails({"scan.xyz", "cube.obj", "--result", "none.json"}, "no pose");
  fails({"scan.xyz", "cube.obj", "--result", "none.json", "--identity"}, "exclude");
  fails({"cube.obj", "cube.obj", "--identity"}, "building model");
  fails({"scan.xyz", "scan.xyz", "--identity"}, "no building model");
  fails({"scan.xyz", "cube.obj", "--identity", "--max-distance-m", "0"}, "max_distance_m");
  const ProgramRun done = run({"deviation", "scan.xyz", "cube.obj", "--identity", "-o", "out"});
  EXPECT_EQ(done.status, 0) << done.err;
}

}  // namespace
}  // namespace limen
