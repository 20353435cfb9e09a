// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen project --control from outside: a small simulated building in a national grid.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "run_program.h"
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/rigid.h"

namespace limen {
namespace {

using nlohmann::json;

Matrix4d pose_matrix_of(const json& rows) {
  Matrix4d matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>();
  }
  return matrix;
}

Vector3d vector_of(const json& numbers) {
  return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

/// Three numbers with `point` for the decimal point, `comma` before each.
std::string line_of(const Vector3d& x, char point, const char* comma) {
  std::string line;
  for (const double value : {x.x(), x.y(), x.z()}) {
    std::string text = std::to_string(value);
    for (char& c : text) c = c == '.' ? point : c;
    line.append(comma).append(text);
  }
  return line;
}

class ProjectSurvey : public ProgramTest {
 protected:
  static constexpr double kSigmaM = 0.002;

  /// Two stations of a room, its control and check points with their errors, and the truth.
  void simulate(const Vector3d& blunder_of_c) {
    const ProgramRun made =
        run({"simulate", "room", "--points-indoor", "60000", "--seed", "1", "-o", "case", "--quiet"});
    ASSERT_EQ(made.status, 0) << made.err;
    const json truth = json::parse(read_whole(work() / "case" / "truth" / "truth.json"));
    for (const json& scan : truth["scans"]) {
      files_.push_back("case/" + scan["file"].get<std::string>());
      const Matrix4d pose = pose_matrix_of(scan["world_from_scan"]);
      world_from_scan_.push_back({pose.topLeftCorner<3, 3>(), pose.topRightCorner<3, 1>()});
    }
    grid_from_world_.rotation = rotation_exp(Vector3d(0, 0, 0.7));
    grid_from_world_.translation = {652345.678, 6862123.456, 35.25};
    const std::map<std::string, Vector3d> places = {
        {"A", {0.5, 0.5, 0.3}}, {"B", {4.5, 0.5, 2.2}}, {"C", {4.5, 3.5, 0.4}}, {"D", {0.5, 3.5, 2.4}},
        {"E", {2.5, 2.0, 0.1}}, {"F", {2.5, 0.2, 1.4}}, {"K1", {2, 1.5, 1.2}},  {"K2", {3.2, 2.4, 1.9}}};
    RandomStream random(1, 21);
    const auto noise = [&]() -> Vector3d { return kSigmaM * normal_vector(random); };
    std::string control = "# of the total station\nname,x,y,z,sigma\n";
    std::string check = "name;x;y;z;sigma_x;sigma_y;sigma_z\n";
    std::string targets = "name,scan,x,y,z,sigma\n";
    for (const auto& [name, place] : places) {
      const Vector3d x =
          grid_from_world_ * place + noise() + (name == "C" ? blunder_of_c : Vector3d(0, 0, 0));
      if (name.front() == 'K') {
        check.append(name).append(line_of(x, ',', ";")).append(";0,002;0,002;0,002\n");
      } else {
        control.append(name).append(line_of(x, '.', ",")).append(",0.002\n");
      }
      for (std::size_t k = 0; k < files_.size(); ++k) {
        const Vector3d seen = inverse(world_from_scan_[k]) * place + noise();
        const std::string file = files_[k].substr(files_[k].rfind('/') + 1);
        targets.append(name).append(",").append(file).append(line_of(seen, '.', ",")).append(",0.002\n");
      }
    }
    write_whole(work() / "control.csv", control);
    write_whole(work() / "check.csv", check);
    write_whole(work() / "targets.csv", targets);
  }

  [[nodiscard]] json survey(const std::string& out) const {
    const ProgramRun done = run({"project", files_[0], files_[1], "-o", out, "--control", "control.csv",
                                 "--check", "check.csv", "--targets", "targets.csv"});
    EXPECT_EQ(done.status, 0) << done.err << done.out;
    said_ = done.out;
    return json::parse(read_whole(work() / out / "project.json"));
  }

  std::vector<std::string> files_;
  std::vector<Rigid3> world_from_scan_;
  Rigid3 grid_from_world_;
  mutable std::string said_;
};

TEST_F(ProjectSurvey, ScansStandInTheFrameOfTheControlPointsAndABlunderIsNamed) {
  simulate(Vector3d(0.04, 0.03, 0));
  const json project = survey("out");
  EXPECT_EQ(project["frame"]["kind"], "control");
  EXPECT_EQ(project["frame"]["file"], "control.csv");
  for (std::size_t k = 0; k < 2; ++k) {
    const Matrix4d pose = pose_matrix_of(project["scans"][k]["frame_from_scan"]);
    const Rigid3 truth = grid_from_world_ * world_from_scan_[k];
    const Vector3d middle = inverse(world_from_scan_[k]) * Vector3d(2.5, 2, 1.2);
    const Vector3d there = pose.topLeftCorner<3, 3>() * middle + pose.topRightCorner<3, 1>();
    EXPECT_LT((there - truth * middle).norm(), 0.004) << k;
    EXPECT_LT(rotation_angle(pose.topLeftCorner<3, 3>().transpose() * truth.rotation), 0.0015) << k;
  }
  std::map<std::string, json> points;
  for (const json& point : project["points"]) points[point["name"]] = point;
  ASSERT_EQ(points.size(), 8U);
  for (const auto& [name, point] : points) {
    EXPECT_EQ(point["state"], name == "C" ? "left_out" : name.front() == 'K' ? "compared" : "used") << name;
    EXPECT_EQ(point["seen_by"].size(), 2U);
    if (name == "C") continue;
    for (Eigen::Index k = 0; k < 3; ++k)
      EXPECT_LT(std::abs(vector_of(point["missed_m"])[k]), 3.5 * vector_of(point["missed_sigma_m"])[k])
          << name;
  }
  EXPECT_NEAR(vector_of(points["C"]["missed_m"]).norm(), 0.05, 0.01);
  EXPECT_GT(points["A"]["detectable_m"][0].get<double>(), 0.005);
  EXPECT_NE(said_.find("C            left_out"), std::string::npos) << said_;
  const std::string page = read_whole(work() / "out" / "report.html");
  EXPECT_NE(page.find("Control and check points"), std::string::npos);
}

TEST_F(ProjectSurvey, TooFewPointsLeaveTheFrameAsItWasAndSaySo) {
  simulate(Vector3d::Zero());
  std::string control = read_whole(work() / "control.csv");
  control.resize(control.find("C,"));
  write_whole(work() / "control.csv", control);
  const json project = survey("out");
  EXPECT_NE(project["frame"]["kind"], "control");
  EXPECT_NE(project["control"]["reason"].get<std::string>().find("2 control points are seen"),
            std::string::npos)
      << project["control"];
  EXPECT_EQ(project["points"][0]["state"], "not_placed");
}

TEST_F(ProjectSurvey, FilesThatAreNoGoodAreStatedBeforeAnythingIsDone) {
  write_whole(work() / "a.ply", "ply\n");
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"", "holds no line"},
      {"x,y,z\n1,2,3\n", "no column is called name"},
      {"name,x,y,z\nA,1,2,3\n", "no column sigma"},
      {"name,x,y,z,sigma\nA,1,two,3,0.002\n", "line 2"},
      {"name,x,y,z,sigma\nA,1,2,3,0\n", "not above 0"},
      {"name,x,y,z,sigma\nA,1,5,2,5,3,5,0,002\n", "line 2: 9 fields, 5 columns (write decimal points"},
      {"name,x,y,z,sigma\nA,1,2,3,0.1\nA,1,2,3,0.1\n", "given twice"},
      {"name,x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz\nA,1,2,3,1,2,0,1,0,1\n", "positive definite"}};
  for (const auto& [text, words] : faults) {
    write_whole(work() / "control.csv", text);
    const ProgramRun bad = run({"project", "a.ply", "-o", "out", "--control", "control.csv"});
    EXPECT_EQ(bad.status, 2) << text;
    EXPECT_NE(bad.err.find(words), std::string::npos) << bad.err;
    EXPECT_NE(bad.err.find("control.csv"), std::string::npos) << bad.err;
  }
}

}  // namespace
}  // namespace limen
