// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/scanner.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

/// A wall 5 m to the east behind a pane of glass 2 m to the east, both very large.
struct PaneBeforeWall {
  Mesh mesh;
  std::vector<TrueOpening> openings;
  int glass = -1;
  int wall = -1;

  PaneBeforeWall() {
    const auto upright = [](double x) {
      return std::vector<Vector3d>{{x, 50.0, -50.0}, {x, -50.0, -50.0}, {x, -50.0, 50.0}, {x, 50.0, 50.0}};
    };
    glass = mesh.add_sheet(upright(2.0), surface_of(Element::glass, 0));
    wall = mesh.add_polygon(upright(5.0), surface_of(Element::wall));
    TrueOpening opening;
    opening.outer = {Vector3d(2.0, 1.0, -1.0), Vector3d(2.0, -1.0, -1.0), Vector3d(2.0, -1.0, 1.0),
                     Vector3d(2.0, 1.0, 1.0)};
    openings.push_back(opening);
  }
};

/// Pulses that fan out to the east from the origin.
ScanPattern fan(std::size_t lines, std::size_t pulses) {
  ScanPattern pattern;
  pattern.lines = lines;
  pattern.pulses_per_line = pulses;
  pattern.pulse = [=](std::size_t line, std::size_t index) {
    const double y = 2.0 * static_cast<double>(line) / static_cast<double>(lines) - 1.0;
    const double z = 2.0 * static_cast<double>(index) / static_cast<double>(pulses) - 1.0;
    return Pulse{Vector3d::Zero(), Vector3d(2.0, y, z).normalized(), 0.0};
  };
  return pattern;
}

std::size_t echoes_on(const Sweep& result, const Mesh& mesh, Element element) {
  return static_cast<std::size_t>(
      std::count_if(result.echoes.begin(), result.echoes.end(), [&](const Echo& echo) {
        return echo.surface >= 0 &&
               mesh.surfaces()[static_cast<std::size_t>(echo.surface)].element == element;
      }));
}

TEST(Scanner, GlassSendsBackTheShareAskedAndLetsTheRestThrough) {
  const PaneBeforeWall world;
  const RayCaster caster(world.mesh);
  ScannerOptions options;
  options.mixed_pixel_share = 0.0;
  options.loss_share = 0.0;
  options.glass_return_share = 0.06;
  options.glass_loss_share = 0.04;
  const Sweep result = sweep(caster, world.openings, fan(200, 500), options, 1);
  const double pulses = 200.0 * 500.0;
  EXPECT_NEAR(static_cast<double>(echoes_on(result, world.mesh, Element::glass)) / pulses, 0.06, 0.004);
  EXPECT_NEAR(static_cast<double>(echoes_on(result, world.mesh, Element::wall)) / pulses, 0.90, 0.006);
  EXPECT_EQ(result.sights[0].through, echoes_on(result, world.mesh, Element::wall));
  EXPECT_EQ(result.sights[0].parts, echoes_on(result, world.mesh, Element::glass));
  EXPECT_EQ(std::popcount(result.sights[0].cells), 64);
}

TEST(Scanner, LosesTheShareAsked) {
  const PaneBeforeWall world;
  const RayCaster caster(world.mesh);
  ScannerOptions options;
  options.glass_return_share = 0.0;
  options.glass_loss_share = 0.0;
  options.loss_share = 0.2;
  const Sweep result = sweep(caster, world.openings, fan(100, 500), options, 1);
  EXPECT_NEAR(static_cast<double>(result.echoes.size()) / 5e4, 0.8, 0.01);
}

TEST(Scanner, SlantingAndFarSurfacesFadeOut) {
  Mesh mesh;
  mesh.add_polygon({{-500.0, -500.0, 0.0}, {500.0, -500.0, 0.0}, {500.0, 500.0, 0.0}, {-500.0, 500.0, 0.0}},
                   surface_of(Element::ground));
  const RayCaster caster(mesh);
  const auto share_at = [&](double distance) {
    ScanPattern pattern;
    pattern.lines = 1;
    pattern.pulses_per_line = 500;
    pattern.pulse = [=](std::size_t, std::size_t) {
      return Pulse{{0.0, 0.0, 2.0}, Vector3d(distance, 0.0, -2.0).normalized(), 0.0};
    };
    return static_cast<double>(sweep(caster, {}, pattern, {}, 1).echoes.size()) / 500.0;
  };
  EXPECT_GT(share_at(8.0), 0.98);
  EXPECT_LT(share_at(80.0), 0.05);
}

TEST(Scanner, MixedPixelsLieBetweenTheTwoSidesOfAnEdge) {
  Mesh mesh;
  const auto upright = [](double x, double y0, double y1) {
    return std::vector<Vector3d>{{x, y1, -9.0}, {x, y0, -9.0}, {x, y0, 9.0}, {x, y1, 9.0}};
  };
  mesh.add_polygon(upright(3.0, -9.0, 0.0), surface_of(Element::wall));
  mesh.add_polygon(upright(4.0, -9.0, 9.0), surface_of(Element::wall));
  const RayCaster caster(mesh);
  ScanPattern pattern;  // Each line sweeps over the edge once.
  pattern.lines = 400;
  pattern.pulses_per_line = 20;
  pattern.pulse = [](std::size_t, std::size_t index) {
    return Pulse{Vector3d::Zero(), Vector3d(3.0, 0.02 * (static_cast<double>(index) - 9.5), 0.0).normalized(),
                 0.0};
  };
  ScannerOptions options;
  options.noise_m = 0.0;
  options.mixed_pixel_share = 0.5;
  const Sweep result = sweep(caster, {}, pattern, options, 1);
  std::size_t mixed = 0;
  for (const Echo& echo : result.echoes) {
    if (echo.surface >= 0) continue;
    ++mixed;
    EXPECT_GT(echo.point.x(), 3.01);
    EXPECT_LT(echo.point.x(), 3.99);
  }
  EXPECT_NEAR(static_cast<double>(mixed) / 400.0, 0.5, 0.1);
}

TEST(Scanner, JitterTurnsTheBeamByTheAngleAsked) {
  Mesh mesh;
  mesh.add_polygon({{10.0, 5.0, -5.0}, {10.0, -5.0, -5.0}, {10.0, -5.0, 5.0}, {10.0, 5.0, 5.0}},
                   surface_of(Element::wall));
  const RayCaster caster(mesh);
  ScanPattern pattern;
  pattern.lines = 20;
  pattern.pulses_per_line = 500;
  const double slant = radians(20.0);
  pattern.pulse = [=](std::size_t, std::size_t) {
    return Pulse{Vector3d::Zero(), Vector3d(std::cos(slant), std::sin(slant), 0.0), 0.0};
  };
  ScannerOptions options;
  options.noise_m = 0.0;
  options.angle_jitter_rad = 1e-3;
  double squares = 0.0;
  const Sweep result = sweep(caster, {}, pattern, options, 1);
  const double range = 10.0 / std::cos(slant);
  for (const Echo& echo : result.echoes) squares += std::pow(echo.point.norm() - range, 2);
  const double expected = range * 1e-3 * std::tan(slant);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(result.echoes.size())), expected, 0.05 * expected);
}

TEST(Scanner, AStationCoversItsRasterOnce) {
  const ScanPattern pattern = station_pattern({}, 10000);
  EXPECT_NEAR(static_cast<double>(pattern.lines * pattern.pulses_per_line), 10000.0, 200.0);
  for (std::size_t i = 0; i < pattern.pulses_per_line; ++i) {
    const double elevation = degrees(std::asin(pattern.pulse(3, i).direction.z()));
    EXPECT_GT(elevation, -60.0);
    EXPECT_LT(elevation, 90.0);
  }
}

TEST(Scanner, AProfilerDrivesItsPathAndTurnsInItsPlane) {
  const VehiclePath path{{{0.0, 0.0, 2.0}, {30.0, 0.0, 2.0}}};
  EXPECT_DOUBLE_EQ(path.length(), 30.0);
  for (const double turn : {0.0, radians(45.0)}) {
    const ScanPattern pattern = profiler_pattern(path, {turn}, 50000);
    EXPECT_NEAR(static_cast<double>(pattern.lines * pattern.pulses_per_line), 50000.0, 1000.0);
    EXPECT_EQ(pattern.pulse(0, 0).origin, path.points[0]);
    EXPECT_LT((pattern.pulse(pattern.lines - 1, 0).origin - path.points[1]).norm(), 1e-9);
    for (std::size_t i = 0; i < pattern.pulses_per_line; i += 7) {
      const Vector3d direction = pattern.pulse(5, i).direction;
      EXPECT_NEAR(direction.norm(), 1.0, 1e-12);
      EXPECT_NEAR(direction.x() * std::cos(turn) + direction.y() * std::sin(turn), 0.0, 1e-12);
    }
  }
}

TEST(Scanner, TwoHeadsDriveTheSamePathAtTheSameTime) {
  const VehiclePath path{{{0.0, 0.0, 2.0}, {30.0, 0.0, 2.0}}};
  const ScanPattern pattern = profiler_pattern(path, {radians(45.0), radians(-45.0)}, 50000);
  ASSERT_EQ(pattern.lines % 2, 0U);
  const std::size_t second = pattern.lines / 2;
  EXPECT_EQ(pattern.pulse(5, 9).origin, pattern.pulse(second + 5, 9).origin);
  EXPECT_EQ(pattern.pulse(5, 9).time_s, pattern.pulse(second + 5, 9).time_s);
  EXPECT_LT(pattern.pulse(5, 40).direction.x() * pattern.pulse(second + 5, 40).direction.x(), 0.0);
}

}  // namespace
}  // namespace limen
