// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scanner/station_scan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr double kCell = 0.2;
constexpr int kBits = 20;  // of each coordinate: 100 km
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

Eigen::Index main_axis(const Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// Cells are squares of the plane's projection along its main axis.
std::uint64_t cell_of(std::size_t plane, const Vector3d& normal, const Vector3d& x) {
  const Eigen::Index axis = main_axis(normal);
  const auto cell = [&](Eigen::Index k) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x[k] / kCell)) +
                                      (1 << (kBits - 1))) &
           kMask;
  };
  return (static_cast<std::uint64_t>(plane) << (2U * kBits)) | (cell((axis + 1) % 3) << kBits) |
         cell((axis + 2) % 3);
}

double area_of(std::uint64_t cell, const MergedPlanes& planes) {
  const Vector3d& normal = planes.planes[cell >> (2U * kBits)].plane.normal;
  return kCell * kCell / normal.cwiseAbs().maxCoeff();
}

}  // namespace

double SharedSurfaceCounter::add(const Sweep& sweep) {
  std::vector<std::uint64_t> cells;
  for (const Echo& echo : sweep.echoes) {
    const int plane =
        echo.surface < 0 ? -1 : planes_.plane_of_surface[static_cast<std::size_t>(echo.surface)];
    if (plane < 0) continue;
    const auto slot = static_cast<std::size_t>(plane);
    cells.push_back(cell_of(slot, planes_.planes[slot].plane.normal, echo.point));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  cells.shrink_to_fit();
  double area = 0.0;
  for (const std::uint64_t cell : cells) area += area_of(cell, planes_);
  cells_.push_back(std::move(cells));
  return area;
}

std::vector<SharedSurface> SharedSurfaceCounter::shared() const {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> seen;
  for (std::size_t scan = 0; scan < cells_.size(); ++scan)
    for (const std::uint64_t cell : cells_[scan]) seen.emplace_back(cell, static_cast<std::uint32_t>(scan));
  std::sort(seen.begin(), seen.end());
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> sums;
  for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
    while (end < seen.size() && seen[end].first == seen[begin].first) ++end;
    const double area = area_of(seen[begin].first, planes_);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j) sums[{seen[i].second, seen[j].second}] += area;
  }
  std::vector<SharedSurface> shared;
  for (const auto& [pair, m2] : sums) shared.push_back({pair.first, pair.second, m2});
  return shared;
}

Matrix3d any_heading(RandomStream& random) {
  return rotation_exp({0.0, 0.0, random.uniform(0.0, 2.0 * std::numbers::pi)});
}

Matrix3d station_rotation(bool any_rotation, RandomStream& random) {
  if (!any_rotation) return any_heading(random);
  return uniform_rotation(random);
}

Vector3d rounded(const Vector3d& x) {
  return (x * 65536.0).array().round().matrix() / 65536.0;
}

Sweep sweep_of_points(std::size_t points, const std::function<ScanPattern(std::size_t pulses)>& pattern,
                      const std::function<Sweep(const ScanPattern&)>& fire) {
  const ScanPattern thin = pattern(20000);
  const double share = std::max(0.02, static_cast<double>(fire(thin).echoes.size()) /
                                          static_cast<double>(thin.lines * thin.pulses_per_line));
  return fire(pattern(static_cast<std::size_t>(std::lround(static_cast<double>(points) / share))));
}

Scan station_scan(std::string name, const Sweep& sweep, const Rigid3& scan_from_scene) {
  Scan scan;
  scan.name = std::move(name);
  scan.centres = {Vector3d::Zero()};
  for (const Echo& echo : sweep.echoes) {
    scan.points.push_back(scan_from_scene * echo.point);
    scan.intensities.push_back(echo.intensity);
  }
  return scan;
}

Scan pass_scan(std::string name, const Sweep& sweep, const ScanPattern& pattern, const Drift& drift,
               const Rigid3& scan_from_scene) {
  Scan scan;
  scan.name = std::move(name);
  scan.level = true;
  for (const Echo& echo : sweep.echoes) {
    const Pulse pulse = pattern.pulse(echo.line, echo.index);
    const Vector3d error = drift.at(pulse.time_s);
    scan.points.push_back(scan_from_scene * echo.point + error);
    scan.centres.push_back(scan_from_scene * pulse.origin + error);
    scan.times_s.push_back(pulse.time_s);
    scan.topology.line.push_back(static_cast<std::int32_t>(echo.line));
    scan.topology.index.push_back(static_cast<std::int32_t>(echo.index));
    scan.intensities.push_back(echo.intensity);
  }
  return scan;
}

}  // namespace limen
