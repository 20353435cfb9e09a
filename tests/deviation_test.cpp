// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// A scan of a building that was not built as planned, measured against its model as a user does it.
#include <algorithm>
#include <cmath>
#include <map>

#include "run_program.h"
#include "support/bcf_check.h"
#include "support/json_schema.h"
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
    const Matrix4d stated = to_matrix(inverted ? inverse(from_matrix(matrix)) : from_matrix(matrix));
    Json result;
    for (int i = 0; i < 4; ++i) {
      result["target_from_source"].push_back({stated(i, 0), stated(i, 1), stated(i, 2), stated(i, 3)});
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

/// What limen project would have written, were its poses true: all scans of a simulated case, and its model.
Json true_project(const Json& truth) {
  Json project = {{"links", Json::array()}, {"scans", Json::array()}};
  for (const Json& scan : truth["scans"])
    project["scans"].push_back({{"file", scan["file"]},
                                {"index", 0},
                                {"kind", "scan"},
                                {"state", "registered"},
                                {"frame_from_scan", scan["world_from_scan"]},
                                {"sigma", {{"translation_m", {0.001, 0.001, 0.001}}}}});
  const Json identity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  project["scans"].push_back({{"file", "model.ifc"},
                              {"index", 0},
                              {"kind", "model"},
                              {"state", "registered"},
                              {"frame_from_scan", identity},
                              {"sigma", nullptr}});
  return project;
}

std::string in_lines(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) text += fault + "\n";
  return text;
}

TEST_F(DeviationProgramTest, AWholeProjectAgainstItsModel) {
  ASSERT_EQ(run({"simulate", "office", "--as-built", "--seed", "5", "--stations", "3", "--points-indoor",
                 "80000", "-o", "."})
                .status,
            0);
  const Json truth = json_of("truth/truth.json");
  Json project = true_project(truth);
  ASSERT_EQ(project["scans"].size(), 4U);
  write_whole(work() / "project.json", project.dump());
  const ProgramRun done = run({"deviation", "project.json", "-o", "out", "--bcf", "issues.bcf", "--moved-m",
                               "0.005", "--title", "Storey <1>", "--operator", "A. Surveyor"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json found = json_of("out/deviation.json");
  const ProgramRun schema = run({"schema", "project-deviation"});
  EXPECT_EQ(testing_schema::Validator(testing_schema::json::parse(schema.out))
                .fault(testing_schema::json::parse(read_whole(work() / "out/deviation.json"))),
            "");
  std::map<int, Json> changes;
  for (const Json& change : truth["model"]["changes"]) changes[change["element"].get<int>()] = change;
  std::size_t expected = 0;  // issues of elements
  double worst = 1e9;        // what is off most comes first
  for (const Json& element : found["elements"]) {
    const auto change = changes.find(element["element"].get<int>());
    const bool there = change == changes.end() || change->second["state"] == "moved";
    EXPECT_FALSE(there && element["presence"] == "not_found") << element["name"];
    EXPECT_FALSE(!there && element["presence"] == "found") << element["name"];
    expected += element["presence"] == "not_found" || element["moved"].get<bool>() ? 1 : 0;
    if (element["presence"] != "found") continue;
    Vector3d shift = vector_of(element["shift"]["shift_m"]);
    const double off =
        element["shift"]["held"].get<int>() > 0 ? shift.norm() : std::abs(element["median_m"].get<double>());
    EXPECT_LE(off, worst);
    worst = off;
    if (element["points"] < 1000) continue;
    Vector3d error = shift;
    if (change != changes.end()) error -= vector_of(change->second["shift_m"]);
    for (const Json& open : element["shift"]["open"]) error -= vector_of(open).dot(error) * vector_of(open);
    EXPECT_LT(error.norm(), 0.003) << element["name"];
  }
  // The issues: a file as the standard wants it, with each element by its GUID.
  const std::string bcf = read_whole(work() / "issues.bcf");
  EXPECT_EQ(in_lines(bcf_faults(bcf)), "");
  std::size_t of_elements = 0;
  for (const auto& [name, text] : bcf_members(bcf))
    of_elements += text.find("<Selection>") != std::string::npos ? 1 : 0;
  EXPECT_GE(expected, 3U);  // two are missing, one was moved
  EXPECT_EQ(of_elements, expected);
  const std::string page = read_whole(work() / "out/report.html");
  EXPECT_NE(page.find("Storey &lt;1&gt;"), std::string::npos);
  EXPECT_NE(page.find("<dt>Signature</dt>"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(work() / "out/deviation.xlsx"), 1000U);
  EXPECT_NE(page.find("<h2>Elements"), std::string::npos);
  EXPECT_LT(page.find("\"Content-Security-Policy\" content=\"default-src 'none'"), page.find("</head>"));

  // Other threads, the same bytes; a scan in doubt is left out and noted.
  ASSERT_EQ(run({"deviation", "project.json", "-o", "again", "--threads", "1", "--bcf", "again.bcf",
                 "--moved-m", "0.005", "--title", "Storey <1>", "--operator", "A. Surveyor"})
                .status,
            0);
  EXPECT_EQ(read_whole(work() / "again.bcf"), bcf);
  for (const char* name :
       {"deviation.json", "deviation.csv", "deviation.xlsx", "deviation.ply", "report.html"})
    EXPECT_EQ(read_whole(work() / "out" / name), read_whole(work() / "again" / name)) << name;
  project["scans"][1]["state"] = "ambiguous";
  write_whole(work() / "project.json", project.dump());
  const ProgramRun fewer = run({"deviation", "project.json", "-o", "fewer", "--cloud-points", "20000"});
  ASSERT_EQ(fewer.status, 0) << fewer.err;
  EXPECT_NE(fewer.err.find("ambiguous"), std::string::npos);
  const Json left = json_of("fewer/deviation.json");
  EXPECT_EQ(left["scans"].size(), 2U);
  ASSERT_EQ(left["left_out"].size(), 1U);
  EXPECT_LE(left["summary"]["cloud_points"].get<int>(), 20000);
}

TEST_F(DeviationProgramTest, ModelsOfAProjectAndMistakes) {
  ASSERT_EQ(
      run({"simulate", "office", "--as-built", "--seed", "3", "--points-indoor", "40000", "-o", "."}).status,
      0);
  Json project = true_project(json_of("truth/truth.json"));
  // A model that the project could not place lies in one frame with one that it could.
  std::filesystem::copy_file(work() / "model.ifc", work() / "second.ifc");
  Json second = project["scans"].back();
  second["file"] = "second.ifc";
  second["state"] = "floating";
  second["frame_from_scan"] = nullptr;
  project["scans"].push_back(second);
  write_whole(work() / "project.json", project.dump());
  ProgramRun done =
      run({"deviation", "project.json", "--model", "model.ifc", "--model", "second.ifc", "-o", "two"});
  ASSERT_EQ(done.status, 0) << done.err;
  const Json two = json_of("two/deviation.json");
  ASSERT_EQ(two["models"].size(), 2U);
  EXPECT_EQ(two["models"][1]["place"], "with the first");
  EXPECT_GT(two["summary"]["elements_in_several_models"].get<int>(), 5);
  ASSERT_EQ(run({"deviation", "project.json", "-o", "one", "--bcf", "one/issues.bcf"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(work() / "one/issues.bcf"));
  EXPECT_EQ(json_of("one/deviation.json")["elements"].size(), two["elements"].size());
  EXPECT_EQ(json_of("one/deviation.json")["summary"]["points_on_faces"], two["summary"]["points_on_faces"]);

  const auto fails = [this](std::vector<std::string> arguments, const std::string& stated) {
    arguments.insert(arguments.begin(), "deviation");
    arguments.insert(arguments.end(), {"-o", "none"});
    const ProgramRun failed = run(arguments);
    EXPECT_EQ(failed.status, 2);
    EXPECT_NE(failed.err.find(stated), std::string::npos) << failed.err;
    EXPECT_FALSE(std::filesystem::exists(work() / "none"));
  };
  fails({"project.json", "--identity"}, "--identity");
  fails({"project.json", "--moved-m", "0"}, "moved_m");
  fails({"project.json", "--units", "mm"}, "leave out --units");
  fails({"project.json", "--lever-arm", "1,2,3"}, "--trajectory FILE");
  fails({"project.json", "--bcf", "none"}, "is the output folder");
  fails({"scan_01.ply", "--identity"}, "no model");
  project["scans"][0]["sha256"] = std::string(64, '0');
  write_whole(work() / "project.json", project.dump());
  fails({"project.json"}, "SHA-256");
  ASSERT_EQ(run({"deviation", "project.json", "-o", "forced", "--force"}).status, 0);
  for (Json& scan : project["scans"]) scan["state"] = "floating";
  write_whole(work() / "project.json", project.dump());
  fails({"project.json"}, "no scan is registered");

  // One scan has issues too.
  write_true_result(json_of("truth/truth.json"), false);
  done = run({"deviation", "scan_01.ply", "model.ifc", "--result", "true.json", "-o", "single", "--bcf",
              "single.bcf"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(in_lines(bcf_faults(read_whole(work() / "single.bcf"))), "");
  const std::string model = read_whole(work() / "model.ifc");
  for (const std::string file :
       {"model.ifc", "true.json", "scan_01.ply", "single/deviation.json", "single", "nowhere/issues.bcf"})
    EXPECT_EQ(
        run({"deviation", "scan_01.ply", "model.ifc", "--result", "true.json", "-o", "single", "--bcf", file})
            .status,
        2)
        << file;
  EXPECT_EQ(read_whole(work() / "model.ifc"), model);
}

TEST_F(DeviationProgramTest, TheResultSaysTheUnitsOfBothFiles) {
  // A floor of 10 ft x 10 ft, and points 0.1 ft above it; the scan's numbers are moved by 50 ft.
  write_whole(work() / "floor.obj", "o floor\nv 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n");
  std::string points;
  for (int i = 5; i < 95; ++i) {
    for (int j = 5; j < 95; ++j)
      points += std::to_string(0.1 * i - 50.0) + " " + std::to_string(0.1 * j) + " 0.1\n";
  }
  write_whole(work() / "scan.xyz", points);
  const auto matrix = [](double x) { return Json{{1, 0, 0, x}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}; };
  Json result = {{"target_from_source", matrix(15.24)}};
  result["inputs"]["source"] = {{"path", "scan.xyz"}, {"metres_per_unit", 0.3048}};
  result["inputs"]["target"] = {{"path", "floor.obj"}, {"metres_per_unit", 0.3048}};
  write_whole(work() / "result.json", result.dump());
  // A text says it in the unit of the files.
  write_whole(work() / "transform.txt", "1 0 0 50\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const std::vector<std::string> in_feet = {"--units", "ft", "--model-units", "ft"};
  for (const std::string pose : {"result.json", "transform.txt"}) {
    std::vector<std::string> words = {"deviation", "scan.xyz", "floor.obj", "--result", pose, "-o", "out"};
    if (pose == "transform.txt") words.insert(words.end(), in_feet.begin(), in_feet.end());
    const ProgramRun done = run(words);
    ASSERT_EQ(done.status, 0) << done.err;
    const Json element = json_of("out/deviation.json")["elements"][0];
    EXPECT_EQ(element["points"], 8100);
    EXPECT_NEAR(element["median_m"].get<double>(), 0.03048, 1e-4);
    std::filesystem::remove_all(work() / "out");
  }
  const ProgramRun mixed =
      run({"deviation", "scan.xyz", "floor.obj", "--result", "transform.txt", "--units", "ft", "-o", "out"});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_NE(mixed.err.find("the scan is in ft, but the model in m"), std::string::npos) << mixed.err;
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
  fails({"scan.xyz", "scan.xyz", "--identity"}, "not a building model");
  fails({"scan.xyz", "cube.obj", "--identity", "--max-distance-m", "0"}, "max_distance_m");
  const ProgramRun done = run({"deviation", "scan.xyz", "cube.obj", "--identity", "-o", "out"});
  EXPECT_EQ(done.status, 0) << done.err;
}

}  // namespace
}  // namespace limen
