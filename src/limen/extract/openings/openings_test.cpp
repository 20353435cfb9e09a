// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/openings.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kWall_m = 0.3;  // thickness
constexpr double kFar_m = 4.0;   // of what is behind the wall
constexpr double kNoise_m = 0.002;
constexpr double kStep_rad = 0.006;  // between rays

/// Where in the wall (u, v) there is an opening.
using Hole = std::function<bool(double u, double v)>;

Hole wall_rectangle(double u0, double v0, double u1, double v1) {
  return [=](double u, double v) { return u > u0 && u < u1 && v > v0 && v < v1; };
}

/// What is in the way of the ray through (u, v): its distance behind the wall's face (negative: before
/// it), or NaN for nothing.
using Thing = std::function<double(double u, double v)>;

double nothing(double /*u*/, double /*v*/) {
  return std::nan("");
}

/// A scan from (0, -3, 0) of the wall y = 0, x from -3 to 3, z from -1.5 to 2, with openings, a floor at -1.5
/// on both sides, and a wall at y = 4 behind. The sides of openings are `kWall_m` deep.
class WallScene {
 public:
  Hole hole = [](double, double) { return false; };
  Thing in_opening = nothing;  ///< met by rays through the opening
  Thing before = nothing;      ///< met by any ray
  Matrix3d turn = Matrix3d::Identity();
  double line_step_rad = kStep_rad;  ///< between upright scan lines

  [[nodiscard]] Scan scan() const {
    Scan scan;
    scan.name = "wall";
    RandomStream random(7);
    for (double azimuth = -0.9; azimuth < 0.9; azimuth += line_step_rad) {
      for (double elevation = -0.6; elevation < 0.6; elevation += kStep_rad) {
        const Vector3d ray(std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
                           std::sin(elevation));
        const double range_m = range(ray);
        if (std::isfinite(range_m))
          scan.points.push_back(turn * (centre_ + (range_m + kNoise_m * random.normal()) * ray));
      }
    }
    scan.centres = {turn * centre_};
    return scan;
  }

 private:
  [[nodiscard]] double range(const Vector3d& ray) const {
    const double floor = ray.z() < 0.0 ? -1.5 / ray.z() : 1e9;
    const double wall = 3.0 / ray.y();
    const Vector3d x = centre_ + wall * ray;
    const double u = x.x();
    const double v = x.z();
    const double obstacle = before(u, v);
    if (std::isfinite(obstacle) && (3.0 + obstacle) / ray.y() < floor) return (3.0 + obstacle) / ray.y();
    if (floor < wall) return floor;
    if (std::abs(u) > 3.0 || v > 2.0) return std::nan("");
    if (!hole(u, v)) return wall;
    // Through the opening, as deep as its sides let it.
    for (double depth = 0.0005; depth < kWall_m; depth += 0.0005) {
      const Vector3d at = centre_ + (3.0 + depth) / ray.y() * ray;
      const double pane = in_opening(u, v);
      if (std::isfinite(pane) && depth >= pane) return (3.0 + pane) / ray.y();
      if (!hole(at.x(), at.z())) return (3.0 + depth) / ray.y();
    }
    return std::min(floor, (3.0 + kFar_m) / ray.y());
  }

  Vector3d centre_ = Vector3d(0, -3, 0);
};

std::vector<Opening> openings_of(const WallScene& scene, const OpeningOptions& options = {}) {
  const Scan scan = scene.scan();
  return find_openings(scan, extract_features(scan), scene.turn * Vector3d::UnitZ(), options);
}

/// Low and high corner in the wall (x, z) of the scene.
Box2 box_of(const WallScene& scene, const Opening& opening) {
  Box2 box;
  for (const Vector3d& corner : opening.corners) {
    const Vector3d x = scene.turn.transpose() * corner;
    EXPECT_NEAR(x.y(), 0.0, 0.01);
    box.add({x.x(), x.z()});
  }
  return box;
}

void expect_box(const Box2& box, double u0, double v0, double u1, double v1, double within_m) {
  EXPECT_NEAR(box.low.x(), u0, within_m);
  EXPECT_NEAR(box.low.y(), v0, within_m);
  EXPECT_NEAR(box.high.x(), u1, within_m);
  EXPECT_NEAR(box.high.y(), v1, within_m);
}

TEST(Openings, AWindowIsFoundToMillimetresWithTheWallsThickness) {
  WallScene scene;
  scene.hole = wall_rectangle(0.5, -0.6, 1.7, 0.9);
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  const Opening& it = openings[0];
  expect_box(box_of(scene, it), 0.5, -0.6, 1.7, 0.9, 0.008);
  EXPECT_EQ(it.view, OpeningView::through);
  EXPECT_GT(it.evidence, 1000U);
  for (const double sigma : it.edge_sigma_m) EXPECT_LT(sigma, 0.012);
  EXPECT_TRUE(it.reveal_complete);
  EXPECT_NEAR(it.reveal_depth_m, kWall_m, 0.02);
}

/// A window with a frame round its pane 12 cm behind the face.
WallScene framed_window(double right) {
  WallScene scene;
  scene.hole = wall_rectangle(0.4, -0.6, right, 0.9);
  scene.in_opening = [=](double u, double v) {
    const bool pane = u > 0.48 && u < right - 0.08 && v > -0.52 && v < 0.82 && std::abs(u - 1.0) > 0.04;
    return pane ? std::nan("") : 0.12;
  };
  return scene;
}

TEST(Openings, ASideThatOneScanLineMetAtOneDepthIsKnownToMillimetres) {
  // Lines 8 cm apart: one meets the right side 4.5 cm behind the face, the next one the wall.
  WallScene scene = framed_window(1.585);
  scene.line_step_rad = 0.02;
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(box_of(scene, openings[0]).high.x(), 1.585, 0.004);
  EXPECT_LT(openings[0].edge_sigma_m[1], 0.006);
}

TEST(Openings, AFrameAtTheEndOfASideIsNotTheSide) {
  // Of the right side no line sees anything; the last one before it meets the frame.
  WallScene scene = framed_window(1.632);
  scene.line_step_rad = 0.02;
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  const double error = box_of(scene, openings[0]).high.x() - 1.632;
  EXPECT_LT(std::abs(error), 2.0 * openings[0].edge_sigma_m[1]);
  EXPECT_GT(openings[0].edge_sigma_m[1], 0.004);
}

TEST(Openings, CornersRunFromLowerLeftAsTheScannerSeesThem) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.6, -0.6, 0.6, 0.9);
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  const auto& c = openings[0].corners;
  // Seen from (0, -3, 0) along y, x runs to the right.
  EXPECT_LT(c[0].x(), c[1].x());
  EXPECT_LT(c[0].z(), c[3].z());
  EXPECT_NEAR(c[1].z(), c[0].z(), 1e-9);
  EXPECT_NEAR((c[2] - c[3] - c[1] + c[0]).norm(), 0.0, 1e-9);
}

TEST(Openings, AWallWithoutOpeningsHasNone) {
  EXPECT_TRUE(openings_of(WallScene()).empty());
}

TEST(Openings, AMullionBehindTheFaceDoesNotDivide) {
  WallScene scene;
  scene.hole = wall_rectangle(0.0, -0.6, 1.4, 0.9);
  scene.in_opening = [](double u, double v) {
    const bool bar = std::abs(u - 0.7) < 0.04 || u < 0.06 || u > 1.34 || v < -0.54 || v > 0.84;
    return bar ? 0.1 : std::nan("");
  };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), 0.0, -0.6, 1.4, 0.9, 0.015);
  EXPECT_EQ(openings[0].view, OpeningView::through);
}

TEST(Openings, ABarFlushWithTheWallDoesNotDivideButAPierDoes) {
  for (const double bar_m : {0.08, 0.3}) {
    WallScene scene;
    const Hole left = wall_rectangle(-1.0, -0.6, -0.5 * bar_m, 0.9);
    const Hole right = wall_rectangle(0.5 * bar_m, -0.6, 1.0, 0.9);
    scene.hole = [=](double u, double v) { return left(u, v) || right(u, v); };
    EXPECT_EQ(openings_of(scene).size(), bar_m < 0.12 ? 1U : 2U) << bar_m;
  }
}

TEST(Openings, AnArchKeepsItsOutline) {
  WallScene scene;
  const Hole jambs = wall_rectangle(-0.6, -0.6, 0.6, 0.5);
  scene.hole = [=](double u, double v) { return jambs(u, v) || (v >= 0.5 && std::hypot(u, v - 0.5) < 0.6); };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), -0.6, -0.6, 0.6, 1.1, 0.02);
  ASSERT_GE(openings[0].outline.size(), 8U);
  Ring ring;
  for (const Vector3d& x : openings[0].outline) {
    ring.emplace_back(x.x(), x.z());
    if (x.z() > 0.55) {
      EXPECT_NEAR(std::hypot(x.x(), x.z() - 0.5), 0.6, 0.025);
    }
  }
  EXPECT_NEAR(std::abs(signed_area(ring)), 1.2 * 1.1 + 0.5 * 3.14159 * 0.36, 0.06);
}

TEST(Openings, ARoundWindowKeepsItsOutlineAndARectangleHasNone) {
  WallScene scene;
  scene.hole = [](double u, double v) { return std::hypot(u - 0.3, v - 0.2) < 0.5; };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), -0.2, -0.3, 0.8, 0.7, 0.025);
  ASSERT_GE(openings[0].outline.size(), 8U);
  for (const Vector3d& x : openings[0].outline) EXPECT_NEAR(std::hypot(x.x() - 0.3, x.z() - 0.2), 0.5, 0.025);
  scene.hole = wall_rectangle(-0.2, -0.3, 0.8, 0.7);
  const std::vector<Opening> square = openings_of(scene);
  ASSERT_EQ(square.size(), 1U);
  EXPECT_TRUE(square[0].outline.empty());
}

TEST(Openings, ABlindBehindTheFaceIsARecess) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.6, -0.6, 0.6, 0.9);
  scene.in_opening = [](double, double) { return 0.12; };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), -0.6, -0.6, 0.6, 0.9, 0.012);
  EXPECT_EQ(openings[0].view, OpeningView::recess);
  EXPECT_FALSE(openings[0].reveal_complete);
}

TEST(Openings, AFlatShallowRecessSeenFromTheStreetIsANicheAWindowHasFrames) {
  for (const bool framed : {false, true}) {
    WallScene scene;
    scene.hole = wall_rectangle(-0.6, -0.6, 0.6, 0.9);
    scene.in_opening = [=](double u, double) { return framed && std::abs(u) < 0.08 ? 0.06 : 0.12; };
    Scan scan = scene.scan();
    scan.centres.assign(scan.size(), Vector3d(scan.centres[0]));  // a vehicle that does not move
    const ExtractedFeatures extracted = extract_features(scan);
    EXPECT_EQ(find_openings(scan, extracted, Vector3d::UnitZ()).size(), framed ? 1U : 0U);
  }
}

TEST(Openings, ACurtainBeforeTheWallIsAHoleWithWideSides) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.6, -0.5, 0.6, 0.9);
  scene.before = [](double u, double v) {
    return std::abs(u) < 0.8 && v > -0.7 && v < 1.05 ? -0.13 + 0.02 * std::sin(35.0 * u) : std::nan("");
  };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), -0.6, -0.5, 0.6, 0.9, 0.15);
  EXPECT_EQ(openings[0].view, OpeningView::hole);
  for (const double sigma : openings[0].edge_sigma_m) EXPECT_GE(sigma, 0.05);
}

TEST(Openings, ABoardBeforeTheWallIsNoCurtain) {
  WallScene scene;
  scene.before = [](double u, double v) {
    return std::abs(u) < 0.8 && v > -0.7 && v < 1.0 ? -0.1 : std::nan("");
  };
  EXPECT_TRUE(openings_of(scene).empty());
}

TEST(Openings, ADoorEndsAtTheFloor) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.5, -1.6, 0.45, 0.55);
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), -0.5, -1.5, 0.45, 0.55, 0.012);
}

TEST(Openings, AGapBetweenTwoWallsIsNoDoor) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.5, -1.6, 0.45, 3.0);
  EXPECT_TRUE(openings_of(scene).empty());
}

TEST(Openings, ASideHiddenByATreeIsNotKnown) {
  WallScene scene;
  scene.hole = wall_rectangle(-0.6, -0.6, 0.6, 0.9);
  // A trunk 1 m before the wall hides the left side.
  scene.before = [](double u, double) { return u > -0.9 && u < -0.4 ? -1.0 : std::nan(""); };
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  const Box2 box = box_of(scene, openings[0]);
  EXPECT_NEAR(box.high.x(), 0.6, 0.012);
  EXPECT_GE(openings[0].edge_sigma_m[3], 0.1);
  EXPECT_LT(openings[0].edge_sigma_m[1], 0.02);
  // Left of what was seen, right of the wall beyond the trunk.
  EXPECT_LT(box.low.x(), -0.39);
  EXPECT_GT(box.low.x(), -0.95);
}

TEST(Openings, TheVerticalMayPointAnywhere) {
  WallScene scene;
  scene.hole = wall_rectangle(0.5, -0.6, 1.7, 0.9);
  scene.turn = rotation_exp(Vector3d(0.7, -1.1, 0.4));
  const std::vector<Opening> openings = openings_of(scene);
  ASSERT_EQ(openings.size(), 1U);
  expect_box(box_of(scene, openings[0]), 0.5, -0.6, 1.7, 0.9, 0.008);
  const Vector3d up = (openings[0].corners[3] - openings[0].corners[0]).normalized();
  EXPECT_NEAR(up.dot(scene.turn * Vector3d::UnitZ()), 1.0, 1e-4);
}

TEST(Openings, ANarrowOrLowOneIsLeftOut) {
  WallScene scene;
  scene.hole = wall_rectangle(0.5, -0.6, 0.75, 0.9);
  EXPECT_TRUE(openings_of(scene).empty());
  OpeningOptions options;
  options.min_width_m = 0.2;
  EXPECT_EQ(openings_of(scene, options).size(), 1U);
}

TEST(Openings, SameForAnyNumberOfThreads) {
  WallScene scene;
  const Hole left = wall_rectangle(-1.5, -0.6, -0.4, 0.9);
  const Hole right = wall_rectangle(0.4, -1.6, 1.3, 0.6);
  scene.hole = [=](double u, double v) { return left(u, v) || right(u, v); };
  const Scan scan = scene.scan();
  const ExtractedFeatures extracted = extract_features(scan);
  std::vector<std::vector<Opening>> runs;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    runs.push_back(find_openings(scan, extracted, Vector3d::UnitZ()));
  }
  set_thread_count(0);
  ASSERT_EQ(runs[0].size(), 2U);
  ASSERT_EQ(runs[1].size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(runs[0][i].corners[k], runs[1][i].corners[k]);
      EXPECT_EQ(runs[0][i].edge_sigma_m[k], runs[1][i].edge_sigma_m[k]);
    }
  }
}

TEST(Openings, AnUnknownCentreIsAnErrorUnlessStated) {
  WallScene scene;
  scene.hole = wall_rectangle(0.5, -0.6, 1.7, 0.9);
  Scan scan = scene.scan();
  const Vector3d centre = scan.centres[0];
  const ExtractedFeatures extracted = extract_features(scan);
  scan.centres.clear();
  EXPECT_THROW(find_openings(scan, extracted, Vector3d::UnitZ()), Error);
  OpeningOptions options;
  options.centre = centre;
  EXPECT_EQ(find_openings(scan, extracted, Vector3d::UnitZ(), options).size(), 1U);
}

TEST(Openings, BadOptionsAreNamed) {
  OpeningOptions options;
  options.max_width_m = 0.1;
  EXPECT_THROW(options.check(), Error);
  EXPECT_TRUE(find_openings({}, {}, Vector3d::UnitZ()).empty());
}

}  // namespace
}  // namespace limen
