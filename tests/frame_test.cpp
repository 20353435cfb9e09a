// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// The commands that take features, on scans that lie any way round.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "run_program.h"
#include <nlohmann/json.hpp>

#include "limen/geometry/rigid.h"

namespace limen {
namespace {

using Json = nlohmann::json;

class FrameTest : public ProgramTest {
 protected:
  /// A simulated station with windows, and the same turned any way and moved, as a file.
  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "60000"}).status, 0);
    const Rigid3 motion{rotation_exp({0.9, -1.7, 0.6}), {3.0, -2.0, 5.0}};
    std::ofstream file(work() / "pose.txt");
    file.precision(17);
    file << to_matrix(motion) << '\n';
    file.close();
    ASSERT_EQ(run({"transform", "pose.txt", "room/indoor_00.ply", "turned.ply"}).status, 0);
    motion_ = motion;
  }

  [[nodiscard]] Json features(const std::string& command, const std::string& scan) const {
    const ProgramRun it = run({command, scan, "-o", "out.json", "--json"});
    EXPECT_EQ(it.status, 0) << it.err;
    return Json::parse(it.out);
  }

  using Segment = std::pair<Vector3d, Vector3d>;

  [[nodiscard]] std::vector<Segment> segments(const std::string& scan, const Rigid3& motion) const {
    std::vector<Segment> all;
    const Json found = features("segments", scan);
    for (const Json& one : found["segments"])
      all.emplace_back(motion * point(one["a"]), motion * point(one["b"]));
    return all;
  }

  /// Share of the length of segments whose two ends another set has as well, to 5 cm.
  static double share_found(const std::vector<Segment>& asked, const std::vector<Segment>& among) {
    constexpr double kSameM = 0.05;
    const auto near = [](const Vector3d& a, const Vector3d& b) { return (a - b).norm() < kSameM; };
    double found = 0.0;
    double all = 0.0;
    for (const auto& [a, b] : asked) {
      all += (a - b).norm();
      if (std::any_of(among.begin(), among.end(), [&, a = a, b = b](const Segment& one) {
            return (near(a, one.first) && near(b, one.second)) || (near(a, one.second) && near(b, one.first));
          }))
        found += (a - b).norm();
    }
    return found / all;
  }

  static Vector3d point(const Json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
  }

  Rigid3 motion_;
};

TEST_F(FrameTest, PlanesAndOpeningsOfATurnedScanAreThoseOfTheScanTurned) {
  const Json level = features("openings", "room/indoor_00.ply");
  const Json turned = features("openings", "turned.ply");
  ASSERT_EQ(level["planes"].size(), turned["planes"].size());
  ASSERT_FALSE(level["openings"].empty());
  ASSERT_EQ(level["openings"].size(), turned["openings"].size());
  for (std::size_t k = 0; k < level["openings"].size(); ++k) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Vector3d expected = motion_ * point(level["openings"][k]["corners"][c]);
      EXPECT_LT((point(turned["openings"][k]["corners"][c]) - expected).norm(), 0.01);
    }
  }
}

/// Rounding decides where some edges are cut into segments: of the length three quarters are the same to 5
/// cm.
TEST_F(FrameTest, SegmentsOfATurnedScanAreThoseOfTheScanTurned) {
  const std::vector<Segment> level = segments("room/indoor_00.ply", motion_);
  const std::vector<Segment> turned = segments("turned.ply", {});
  ASSERT_FALSE(level.empty());
  EXPECT_GT(share_found(level, turned), 0.75);
  EXPECT_GT(share_found(turned, level), 0.75);
}

TEST_F(FrameTest, InfoTellsWhoSaysWhereTheScannerStood) {
  const ProgramRun it = run({"info", "room/indoor_00.ply", "--json"});
  ASSERT_EQ(it.status, 0) << it.err;
  const Json scanner = Json::parse(it.out)["scans"][0]["scanner"];
  EXPECT_EQ(scanner["source"], "file");
  EXPECT_TRUE(scanner["confirmed"].get<bool>());
}

}  // namespace
}  // namespace limen
