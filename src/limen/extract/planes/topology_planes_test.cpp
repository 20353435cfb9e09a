// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/topology_planes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/cells/scan_grid.h"

namespace limen {
namespace {

enum StreetPart : int { ground, facade, recess, room, far_wall, foliage };

struct StreetEcho {
  double range = 0.0;
  int surface = -1;
};

/// What a beam from (x, 0, 2) upwards by `angle` in the y-z plane meets: the ground, a façade at y = 8 with a
/// recess 10 cm deep and windows into a room 3 m deep, a bush before it, another façade on its line from x
/// = 14.
StreetEcho meet(double x, double angle, RandomStream& random) {
  const double dy = std::cos(angle);
  const double dz = std::sin(angle);
  if (dz < 0.0 && dy * 2.0 / -dz < 8.0) return {2.0 / -dz, ground};
  const double z = 2.0 + dz / dy * 8.0;
  if (x > 3.0 && x < 4.5 && z < 3.0) return {random.uniform(5.0, 7.0) / dy, foliage};
  if (x > 11.5 && x < 14.0) return {};  // a gap between two houses
  if (x > 14.0) return {8.0 / dy, far_wall};
  const bool window = std::fmod(x, 3.0) > 1.8 && z > 3.0 && std::fmod(z, 2.5) > 1.2;
  if (window) return {11.0 / dy, room};
  return {x > 6.0 && x < 9.0 ? 8.1 / dy : 8.0 / dy, x > 6.0 && x < 9.0 ? recess : facade};
}

struct Street {
  Scan scan;
  std::vector<int> truth;
};

/// Profiles every 6 cm along x, 1 000 pulses each, range noise of 3 mm.
Street drive(std::uint64_t seed) {
  Street street;
  RandomStream random(seed);
  for (int line = 0; line < 300; ++line) {
    for (int pulse = 0; pulse < 1000; ++pulse) {
      const double x = 0.06 * line;
      const double angle = -1.2 + 2.1 * pulse / 1000.0;
      StreetEcho echo = meet(x, angle, random);
      if (echo.surface < 0 || echo.range > 40.0) continue;
      echo.range += 0.003 * random.normal();
      const Vector3d centre(x, 0.0, 2.0);
      street.scan.points.push_back(centre + echo.range * Vector3d(0.0, std::cos(angle), std::sin(angle)));
      street.scan.centres.push_back(centre);
      street.scan.topology.line.push_back(line);
      street.scan.topology.index.push_back(pulse);
      street.truth.push_back(echo.surface);
    }
  }
  return street;
}

/// The label that most points of a surface carry, and the share of them that do.
std::pair<int, double> main_label(const Street& street, const PlaneLabels& found, int surface) {
  std::map<int, double> counts;
  double total = 0.0;
  for (std::size_t i = 0; i < street.truth.size(); ++i) {
    if (street.truth[i] != surface) continue;
    ++counts[found.labels[i]];
    ++total;
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return {most->first, most->second / total};
}

double share_with_label(const Street& street, const PlaneLabels& found, int label,
                        const std::vector<int>& surfaces) {
  double right = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < street.truth.size(); ++i) {
    if (found.labels[i] != label) continue;
    ++all;
    if (std::count(surfaces.begin(), surfaces.end(), street.truth[i]) > 0) ++right;
  }
  return right / all;
}

TEST(TopologyPlanes, FindEachSurfaceOfAStreetOnce) {
  const Street street = drive(1);
  const PlaneLabels found = extract_topology_planes(street.scan);
  ASSERT_EQ(found.labels.size(), street.scan.size());
  for (const int surface : {ground, facade, recess, room, far_wall}) {
    const auto [label, share] = main_label(street, found, surface);
    ASSERT_GE(label, 0) << "surface " << surface;
    EXPECT_GT(share, 0.97) << "surface " << surface;
    const std::vector<int> same = surface == facade || surface == far_wall
                                      ? std::vector<int>{facade, far_wall}
                                      : std::vector<int>{surface};
    EXPECT_GT(share_with_label(street, found, label, same), 0.97) << "surface " << surface;
  }
  // The two houses stand on one line: one plane. The recess is 10 cm behind and must not be part of it.
  EXPECT_EQ(main_label(street, found, facade).first, main_label(street, found, far_wall).first);
  EXPECT_NE(main_label(street, found, facade).first, main_label(street, found, recess).first);
  EXPECT_EQ(main_label(street, found, foliage).first, -1);
  EXPECT_EQ(found.fits.size(), 4U);

  const PlaneFit& wall = found.fits[static_cast<std::size_t>(main_label(street, found, facade).first)];
  EXPECT_NEAR(std::abs(wall.plane.normal.y()), 1.0, 1e-6);
  EXPECT_NEAR(std::abs(wall.plane.offset), 8.0, 1e-3);
  EXPECT_GT(wall.rms_m, 0.001);
  EXPECT_LT(wall.rms_m, 0.004);
}

TEST(TopologyPlanes, DoNotDependOnThreadsOrTheOrderOfPoints) {
  const Street street = drive(2);
  const int before = thread_count();
  set_thread_count(1);
  const PlaneLabels serial = extract_topology_planes(street.scan);
  set_thread_count(4);
  const PlaneLabels parallel = extract_topology_planes(street.scan);
  set_thread_count(before);
  EXPECT_EQ(serial.labels, parallel.labels);
  ASSERT_EQ(serial.fits.size(), parallel.fits.size());
  for (std::size_t k = 0; k < serial.fits.size(); ++k) {
    EXPECT_EQ(serial.fits[k].plane.normal, parallel.fits[k].plane.normal);
    EXPECT_EQ(serial.fits[k].plane.offset, parallel.fits[k].plane.offset);
  }

  RandomStream random(5);
  std::vector<std::uint32_t> shuffled(street.scan.size());
  for (std::uint32_t i = 0; i < shuffled.size(); ++i) shuffled[i] = i;
  for (std::uint32_t i = static_cast<std::uint32_t>(shuffled.size()); i > 1; --i) {
    std::swap(shuffled[i - 1], shuffled[random.below(i)]);
  }
  const PlaneLabels mixed = extract_topology_planes(subset(street.scan, shuffled));
  for (std::size_t i = 0; i < shuffled.size(); ++i) ASSERT_EQ(mixed.labels[i], serial.labels[shuffled[i]]);
}

TEST(TopologyPlanes, TheFanOfTheBeamIsNoPlane) {
  // A vehicle that does not move: every profile lies in one vertical plane, and what it meets is rubble.
  Street street;
  RandomStream random(3);
  for (int line = 0; line < 100; ++line) {
    for (int pulse = 0; pulse < 500; ++pulse) {
      const double angle = -1.0 + 2.0 * pulse / 500.0;
      const double range = random.uniform(5.0, 5.6);
      const Vector3d centre(1e-4 * line, 0.0, 2.0);
      street.scan.points.push_back(centre + range * Vector3d(0.0, std::cos(angle), std::sin(angle)));
      street.scan.centres.push_back(centre);
      street.scan.topology.line.push_back(line);
      street.scan.topology.index.push_back(pulse);
    }
  }
  EXPECT_TRUE(extract_topology_planes(street.scan).fits.empty());
}

TEST(TopologyPlanes, OfFewOrDegeneratePointsAreNone) {
  Scan scan;
  scan.name = "empty";
  EXPECT_THROW(extract_topology_planes(scan), Error);
  for (int i = 0; i < 2000; ++i) {
    scan.points.emplace_back(i < 1000 ? 0.01 * i : 1.0, 0.0, 0.0);
    scan.topology.line.push_back(i / 40);
    scan.topology.index.push_back(i % 40);
  }
  EXPECT_TRUE(extract_topology_planes(scan).fits.empty());
  for (Vector3d& p : scan.points) p = Vector3d(1.0, 2.0, 3.0);
  EXPECT_TRUE(extract_topology_planes(scan).fits.empty());
}

TEST(ScanGrid, LinksTrueNeighboursOnly) {
  // Two lines over a step of 1 m, the second one without its pulses 10 to 14, and shuffled.
  Scan scan;
  for (const int line : {1, 0}) {
    for (int pulse = 39; pulse >= 0; --pulse) {
      if (line == 1 && pulse >= 10 && pulse < 15) continue;
      scan.points.emplace_back(0.1 * line, 0.05 * pulse, pulse < 20 ? 0.0 : 1.0);
      scan.topology.line.push_back(line);
      scan.topology.index.push_back(pulse);
    }
  }
  const ScanGrid grid(scan, 4.0);
  ASSERT_EQ(grid.size(), 75U);
  for (std::size_t at = 0; at < grid.size(); ++at) {
    EXPECT_EQ(grid.point(at), scan.points[grid.scan_index(at)]);
    const int pulse = scan.topology.index[grid.scan_index(at)];
    const std::int32_t next = grid.links(at)[ScanGrid::next];
    const bool last = pulse == 39 || pulse == 19 || (grid.line(at) == 1 && pulse == 9);
    EXPECT_EQ(next == ScanGrid::kNone, last) << "line " << grid.line(at) << " pulse " << pulse;
    if (next != ScanGrid::kNone) {
      EXPECT_EQ(scan.topology.index[grid.scan_index(static_cast<std::size_t>(next))], pulse + 1);
    }
    const std::int32_t across =
        grid.links(at)[grid.line(at) == 0 ? ScanGrid::line_after : ScanGrid::line_before];
    if (pulse < 10 || pulse >= 15) {
      ASSERT_NE(across, ScanGrid::kNone);
      EXPECT_EQ(scan.topology.index[grid.scan_index(static_cast<std::size_t>(across))], pulse);
    }
  }
}

TEST(ScanGrid, EstimatesTheNoise) {
  RandomStream random(4);
  Scan scan;
  for (int line = 0; line < 20; ++line) {
    for (int pulse = 0; pulse < 500; ++pulse) {
      scan.points.emplace_back(0.05 * line, 0.05 * pulse, 0.004 * random.normal());
      scan.topology.line.push_back(line);
      scan.topology.index.push_back(pulse);
    }
  }
  EXPECT_NEAR(surface_noise(ScanGrid(scan, 4.0)), 0.004, 0.0003);
}

}  // namespace
}  // namespace limen
