// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/seen_space.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace limen {
namespace {

constexpr double kCellM = 0.25;
constexpr double kSampleM = 0.7 * kCellM;  // of a plane: no cell on its diagonal is missed
constexpr double kNearM = 0.12;            // less than a wall is thick
constexpr double kSameWay = 0.97;          // cosine between normals
constexpr double kClearM = 0.5;            // from its ends a line of sight is not sure to be clear
constexpr double kMostOfPointsM2 = 5.0;
constexpr std::size_t kMostSurfaces = 6;  // in a cell
constexpr std::int32_t kLevels = 4096;    // cells above one another: 1 km

std::pair<std::int32_t, std::int32_t> key_of(const Vector3d& x) {
  const Vector3d whole = (x / kCellM).array().floor();
  return {static_cast<std::int32_t>(whole.x()),
          static_cast<std::int32_t>(whole.y()) * kLevels + static_cast<std::int32_t>(whole.z())};
}

}  // namespace

void add_surface_points(const PlacedPlane& plane, std::vector<SurfacePoint>& points) {
  constexpr double kThird = 2.0 / 3.0;  // the middles of the thirds of either direction
  for (const double u : {-kThird, 0.0, kThird}) {
    for (const double v : {-kThird, 0.0, kThird})
      points.push_back({plane.middle + u * plane.along + v * plane.across, plane.normal,
                        std::min(kMostOfPointsM2, plane.area_m2) / 9.0, plane.oriented});
  }
}

void SeenSpace::add(const PlacedPlane& plane) {
  const Surface surface{plane.normal, plane.normal.dot(plane.middle), plane.oriented};
  const auto steps = [](const Vector3d& half) { return static_cast<int>(std::ceil(half.norm() / kSampleM)); };
  const int along = std::max(1, steps(plane.along));
  const int across = std::max(1, steps(plane.across));
  for (int a = -along; a <= along; ++a) {
    for (int b = -across; b <= across; ++b)
      cover(surface, plane.middle + plane.along * a / along + plane.across * b / across);
  }
  if (!plane.scanner) return;
  std::vector<SurfacePoint> points;
  add_surface_points(plane, points);
  for (const SurfacePoint& point : points) {
    const Vector3d way = point.x - *plane.scanner;
    const double length = way.norm();
    for (double t = kClearM; t < length - kClearM; t += kCellM)
      cell_at(*plane.scanner + t / length * way).clear = true;
  }
}

SeenSpace::Finding SeenSpace::at(const SurfacePoint& point) const {
  bool clear = false;
  bool near = false;
  for (const double off : {0.0, kNearM, -kNearM}) {
    const Cell* cell = find(point.x + off * point.normal);
    if (cell == nullptr) continue;
    for (const Surface& surface : cell->surfaces) {
      near = true;
      const double cosine = surface.normal.dot(point.normal);
      if ((point.oriented && surface.oriented ? cosine : std::abs(cosine)) < kSameWay) continue;
      if (std::abs(surface.normal.dot(point.x) - surface.offset_m) < kNearM) return Finding::surface;
    }
    if (off == 0.0) clear = cell->clear;
  }
  return clear && !near ? Finding::looked_through : Finding::unknown;
}

std::optional<double> SeenSpace::way_to_surface(const SurfacePoint& point) const {
  constexpr double kReachM = 0.4;
  std::optional<double> nearest;
  for (const double step : {0.0, 0.2, -0.2, kReachM, -kReachM}) {
    const Cell* cell = find(point.x + step * point.normal);
    if (cell == nullptr) continue;
    for (const Surface& surface : cell->surfaces) {
      const double cosine = surface.normal.dot(point.normal);
      if ((point.oriented && surface.oriented ? cosine : std::abs(cosine)) < kSameWay) continue;
      const double way = (surface.offset_m - surface.normal.dot(point.x)) / cosine;
      if (std::abs(way) <= kReachM && (!nearest || std::abs(way) < std::abs(*nearest))) nearest = way;
    }
  }
  return nearest;
}

SeenSpace::Cell& SeenSpace::cell_at(const Vector3d& x) {
  const auto [a, b] = key_of(x);
  const std::uint32_t number = numbers_.insert(a, b);
  if (number >= cells_.size()) cells_.resize(number + 1U);
  return cells_[number];
}

const SeenSpace::Cell* SeenSpace::find(const Vector3d& x) const {
  const auto [a, b] = key_of(x);
  const std::uint32_t number = numbers_.find(a, b);
  return number == CellNumbers::kNone ? nullptr : &cells_[number];
}

void SeenSpace::cover(const Surface& surface, const Vector3d& x) {
  constexpr double kSameM = 0.02;
  Cell& cell = cell_at(x);
  const bool known = std::any_of(cell.surfaces.begin(), cell.surfaces.end(), [&](const Surface& other) {
    return other.normal.dot(surface.normal) > kSameWay &&
           std::abs(other.normal.dot(x) - other.offset_m) < kSameM;
  });
  if (!known && cell.surfaces.size() < kMostSurfaces) cell.surfaces.push_back(surface);
}

}  // namespace limen
