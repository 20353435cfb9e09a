// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/detect_planes.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/planes/automatic_threshold.h"
#include "limen/extract/planes/msac_planes.h"

namespace limen {
namespace {

/// Three faces of a box of 3 m with clutter before them, in lines of 200 points.
Scan three_walls(double noise_m = 0.003) {
  RandomStream random(1);
  Scan scan;
  for (int line = 0; line < 300; ++line) {
    for (int pulse = 0; pulse < 200; ++pulse) {
      Vector3d x(0.01 * line, 0.015 * pulse, noise_m * random.normal());
      if (line < 100) x = {noise_m * random.normal(), 0.015 * pulse, 0.03 * line};
      if (line >= 200) x = {0.03 * (line - 200), noise_m * random.normal(), 0.015 * pulse};
      if (random.below(20) == 0) x = {random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3)};
      scan.points.push_back(x);
      scan.topology.line.push_back(line);
      scan.topology.index.push_back(pulse);
    }
  }
  return scan;
}

/// Whether the three largest planes are the faces, within a millimetre and a hundredth of the points.
void expect_three_faces(const PlaneLabels& planes) {
  ASSERT_GE(planes.fits.size(), 3U);
  bool seen[3] = {false, false, false};
  for (std::size_t k = 0; k < 3; ++k) {
    Eigen::Index axis = 0;
    EXPECT_GT(planes.fits[k].plane.normal.cwiseAbs().maxCoeff(&axis), 0.99999);
    EXPECT_NEAR(planes.fits[k].plane.offset, 0.0, 1e-3);
    seen[axis] = true;
    const auto count = std::count(planes.labels.begin(), planes.labels.end(), static_cast<std::int32_t>(k));
    EXPECT_GT(count, 17500);
    EXPECT_LT(count, 20500);
  }
  EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
}

TEST(DetectPlanes, EveryDetectorFindsThreeWalls) {
  const Scan scan = three_walls();
  for (const PlaneDetector detector :
       {PlaneDetector::automatic, PlaneDetector::grow, PlaneDetector::scan_lines, PlaneDetector::msac}) {
    SCOPED_TRACE(static_cast<int>(detector));
    const DetectedPlanes detected = detect_planes(scan, {.detector = detector});
    expect_three_faces(detected.planes);
    EXPECT_NE(detected.detector, PlaneDetector::automatic);
    if (detector != PlaneDetector::automatic) {
      EXPECT_EQ(detected.detector, detector);
    }
    EXPECT_GE(detected.planes.inlier_threshold_m, 0.008);
    EXPECT_NEAR(detected.noise_m, 0.003, 0.001);
  }
}

TEST(DetectPlanes, ThresholdGivenOrByARule) {
  const Scan scan = three_walls();
  EXPECT_EQ(detect_planes(scan, {}, {.inlier_threshold_m = 0.013}).planes.inlier_threshold_m, 0.013);
  for (const PlaneDetector detector : {PlaneDetector::scan_lines, PlaneDetector::msac}) {
    const DetectedPlanes detected =
        detect_planes(scan, {.detector = detector}, {.inlier_threshold_m = 0.013});
    EXPECT_EQ(detected.planes.inlier_threshold_m, 0.013);
  }
  const double by_noise = detect_planes(scan, {.threshold = ThresholdRule::noise}).planes.inlier_threshold_m;
  EXPECT_NEAR(by_noise, 3.3 * 0.003, 0.002);
  // Noise of 3 mm: 5 mm cuts off a tenth of the points, 20 mm gives slabs four times as thick for nothing.
  const double chosen = a_contrario_threshold(scan, {});
  EXPECT_GE(chosen, 0.005);
  EXPECT_LE(chosen, 0.015);
  EXPECT_GE(a_contrario_threshold(three_walls(0.009), {}), 0.015);
}

TEST(DetectPlanes, ScanLinesMustBeKnown) {
  Scan scan = three_walls();
  scan.topology = {};
  EXPECT_THROW(detect_planes(scan, {.detector = PlaneDetector::scan_lines}), Error);
  expect_three_faces(detect_planes(scan).planes);
  EXPECT_TRUE(detect_planes(Scan{}).planes.fits.empty());
}

TEST(MsacPlanes, DoNotDependOnThreadsButOnTheSeed) {
  const Scan scan = three_walls();
  set_thread_count(1);
  const PlaneLabels one = msac_planes(scan);
  set_thread_count(3);
  const PlaneLabels three = msac_planes(scan);
  set_thread_count(0);
  EXPECT_EQ(one.labels, three.labels);
  expect_three_faces(msac_planes(scan, {.seed = 2}));
}

TEST(MsacPlanes, OfDegenerateCloudsAreNone) {
  Scan scan;
  EXPECT_TRUE(msac_planes(scan).fits.empty());
  scan.points.assign(2, Vector3d(1, 1, 1));
  EXPECT_EQ(msac_planes(scan).labels, (std::vector<std::int32_t>{-1, -1}));
  scan.points.assign(1000, Vector3d(1, 1, 1));
  EXPECT_TRUE(msac_planes(scan).fits.empty());
  for (std::size_t i = 0; i < scan.size(); ++i) scan.points[i] = {0.01 * static_cast<double>(i), 0.0, 0.0};
  EXPECT_TRUE(msac_planes(scan).fits.empty());
}

}  // namespace
}  // namespace limen
