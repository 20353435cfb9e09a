// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/pose_file.h"

#include <fstream>
#include <utility>

#include <gtest/gtest.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/report/evaluation.h"
#include "limen/report/json/json_values.h"
#include "limen/report/json/result_json.h"

namespace limen {
namespace {

namespace fs = std::filesystem;

const Rigid3 kPose{rotation_exp(Vector3d(0.1, 0.2, -2.5)), Vector3d(1050012.5, 6840987.25, 151.125)};

class PoseFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("limen-" + std::string(info->name()) + "-" + std::to_string(static_cast<long>(getpid())));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

RegistrationReport report_of(const Rigid3& pose) {
  RegistrationReport report;
  report.result.outcome = Outcome::registered;
  report.result.best.target_from_source = pose;
  report.result.sigma = {Vector3d::Constant(1e-4), Vector3d::Constant(1e-3), pose * Vector3d(5, 0, 0)};
  report.source.path = "somewhere/room.ply";
  report.source.middle = Vector3d(4, 5, 6);
  report.target.path = "elsewhere/street.ply";
  return report;
}

bool same(const Rigid3& a, const Rigid3& b) {
  return (a.rotation - b.rotation).norm() < 1e-14 && (a.translation - b.translation).norm() < 1e-8;
}

TEST_F(PoseFileTest, ReadsWhatWeWrite) {
  const PoseFile pose = read_pose_file(file("result.json", result_json(report_of(kPose))));
  ASSERT_TRUE(pose.target_from_source);
  EXPECT_TRUE(same(*pose.target_from_source, kPose));
  EXPECT_EQ(pose.outcome, Outcome::registered);
  EXPECT_EQ(pose.source_middle, Vector3d(4, 5, 6));
  EXPECT_EQ(pose.target_path, "elsewhere/street.ply");
  ASSERT_TRUE(pose.sigma);
  EXPECT_EQ(pose.sigma->translation_m, Vector3d::Constant(1e-3));
  const PoseFile text = read_pose_file(file("transform.txt", transform_text(kPose)));
  EXPECT_TRUE(same(*text.target_from_source, kPose));
  const PoseFile marked = read_pose_file(file("marked.txt", "\xEF\xBB\xBF" + transform_text(kPose)));
  EXPECT_TRUE(same(*marked.target_from_source, kPose));
}

TEST_F(PoseFileTest, AProbablePoseIsReadWithItsProbability) {
  RegistrationReport report = report_of(kPose);
  report.result.outcome = Outcome::probable;
  report.result.best.probability = 0.986;
  const PoseFile pose = read_pose_file(file("result.json", result_json(report)));
  EXPECT_EQ(pose.outcome, Outcome::probable);
  EXPECT_EQ(pose.probability, 0.986);
  EXPECT_TRUE(pose.target_from_source);
}

TEST_F(PoseFileTest, NoMatchIsReadWithoutAPose) {
  RegistrationReport report = report_of(kPose);
  report.result.outcome = Outcome::no_match;
  const PoseFile pose = read_pose_file(file("result.json", result_json(report)));
  EXPECT_FALSE(pose.target_from_source);
  EXPECT_EQ(pose.outcome, Outcome::no_match);
}

TEST_F(PoseFileTest, RefusesWhatIsNoPose) {
  const std::vector<std::string> texts = {
      "",
      " \n",
      "\xEF\xBB\xBF",
      "1 2 3",
      "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1  7",
      "1 0 0 0  0 1 0 0  0 0 1 x  0 0 0 1",
      "2 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1",
      "1 0 0 0  0 1 0 0  0 0 -1 0  0 0 0 1",
      "1 0 0 nan  0 1 0 0  0 0 1 0  0 0 0 1",
      "1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1",
      "{",
      "{}",
      R"({"target_from_source": null})",
      R"({"target_from_source": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})",
      R"({"target_from_source": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,"1"]]})",
      R"({"transform": 5})",
  };
  for (const std::string& text : texts) EXPECT_THROW((void)read_pose_file(file("bad", text)), Error) << text;
  EXPECT_THROW((void)read_pose_file(folder_), Error);
  EXPECT_THROW((void)read_pose_file(folder_ / "missing"), Error);
}

TEST_F(PoseFileTest, FindsTheTruthOfTwoScansOfACase) {
  const Rigid3 world_from_room{rotation_exp(Vector3d(0, 0, 1)), Vector3d(1050000, 6840000, 150)};
  Json street = {{"file", "street.ply"}, {"world_from_scan", json_of(to_matrix(Rigid3{}))}};
  Json room = {{"name", "room"}, {"world_from_scan", json_of(to_matrix(world_from_room))}};
  const Json truth = {{"scans", Json::array({street, room})}};
  const PoseFile result = read_pose_file(file("result.json", result_json(report_of(kPose))));
  const fs::path path = file("truth.json", to_text(truth));
  EXPECT_TRUE(same(read_true_pose(path, result), world_from_room));

  PoseFile other = result;
  other.source_path = "cellar.ply";
  EXPECT_THROW((void)read_true_pose(path, other), Error);
  EXPECT_THROW((void)read_true_pose(path, PoseFile{}), Error);
}

TEST_F(PoseFileTest, ATextOfTheTruthIsInTheUnitOfTheFiles) {
  const fs::path path = file("truth.txt", "1 0 0 2000\n0 1 0 0\n0 0 1 500\n0 0 0 1\n");
  PoseFile result;
  EXPECT_EQ(read_true_pose(path, result).translation, Vector3d(2000.0, 0.0, 500.0));
  result.source_metres_per_unit = result.target_metres_per_unit = 0.001;
  EXPECT_LT((read_true_pose(path, result).translation - Vector3d(2.0, 0.0, 0.5)).norm(), 1e-12);
}

TEST_F(PoseFileTest, FindsTheTruthOfAScanInItsModel) {
  Json truth;
  truth["model"]["file"] = "house.ifc";
  truth["scans"] = {{{"file", "room.ply"}, {"world_from_scan", json_of(to_matrix(kPose))}}};
  const fs::path path = file("truth.json", to_text(truth));
  PoseFile result;
  result.source_path = "somewhere/room.ply";
  result.target_path = "elsewhere/house.ifc";
  EXPECT_TRUE(same(read_true_pose(path, result), kPose));
  std::swap(result.source_path, result.target_path);
  EXPECT_TRUE(same(read_true_pose(path, result), inverse(kPose)));
  result.source_path = "elsewhere/barn.ifc";
  EXPECT_THROW((void)read_true_pose(path, result), Error);
}

TEST_F(PoseFileTest, MeasuresAKnownError) {
  // Off by 0.001 rad about the target's z axis through the image of the middle, and by 3 mm along x.
  const Vector3d middle(4, 5, 6);
  const Vector3d landing = kPose * middle;
  const Matrix3d turn = rotation_exp(Vector3d(0, 0, 0.001));
  const Rigid3 found{turn * kPose.rotation,
                     turn * (kPose.translation - landing) + landing + Vector3d(0.003, 0, 0)};
  const PoseFile result = read_pose_file(file("result.json", result_json(report_of(found))));
  const PoseError error = compare_poses(result, kPose);
  EXPECT_NEAR(error.rotation_rad, 0.001, 1e-12);
  EXPECT_NEAR(error.translation_m, 0.003, 1e-8);
  EXPECT_NEAR(error.rotation_vector_rad.z(), 0.001, 1e-12);
  ASSERT_TRUE(error.largest_sigmas);
  // 0.001 rad against a sigma of 1e-4; the shift at the centre, some 8 m off, adds 8 mm against 1 mm.
  EXPECT_NEAR(*error.largest_sigmas, 10.0, 1.0);
}

TEST_F(PoseFileTest, WithoutSigmaNothingIsSaidOfSigma) {
  PoseFile result;
  result.target_from_source = kPose;
  const PoseError error = compare_poses(result, kPose);
  EXPECT_FALSE(error.largest_sigmas);
  EXPECT_EQ(error.translation_m, 0.0);
  EXPECT_NEAR(error.rotation_rad, 0.0, 1e-15);
}

}  // namespace
}  // namespace limen
