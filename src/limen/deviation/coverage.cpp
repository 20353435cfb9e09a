// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/coverage.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr std::uint8_t kCovered = 1;
constexpr std::uint8_t kPassed = 2;
constexpr double kMostTiles = 4e6;  // of one face
constexpr double kBeginM = 0.2;     // of a ray: nothing so near to the scanner is measured
constexpr std::size_t kSamplesPerPiece = 4096;
constexpr double kSamePlaceM = 1e-4;

}  // namespace

FaceTiles::FaceTiles(const FaceIndex& index, double tile_m) : index_(index), grids_(index.size()) {
  std::size_t total = 0;
  for (std::size_t k = 0; k < grids_.size(); ++k) {
    Grid& grid = grids_[k];
    const auto [low, high] = box_of(index.face(static_cast<int>(k)).outline.outer);
    if (low.x() > high.x()) continue;
    const Vector2d size = high - low;
    grid.low = low;
    const double about_m = std::max(tile_m, std::sqrt(size.x() * size.y() / kMostTiles));
    // They divide the face: a part of one counts no more than it has of it.
    const auto tiles_along = [about_m](double length) {
      return static_cast<std::size_t>(std::max(1.0, std::round(length / about_m)));
    };
    grid.columns = tiles_along(size.x());
    grid.rows = tiles_along(size.y());
    grid.tile_m = {size.x() / static_cast<double>(grid.columns), size.y() / static_cast<double>(grid.rows)};
    grid.begin = total;
    total += grid.columns * grid.rows;
  }
  marks_.assign(total, 0);
}

void FaceTiles::mark(int face, const Vector3d& x, std::uint8_t what) {
  const Grid& grid = grids_[static_cast<std::size_t>(face)];
  const Vector2d p = index_.face(face).frame.to_plane(x) - grid.low;
  const Vector2d place = p.cwiseQuotient(grid.tile_m);
  if (!(place.x() >= 0.0 && place.y() >= 0.0)) return;
  const auto column = static_cast<std::size_t>(place.x());
  const auto row = static_cast<std::size_t>(place.y());
  if (column >= grid.columns || row >= grid.rows) return;
  // Marks only ever add up: the order of threads does not matter.
  std::atomic_ref<std::uint8_t>(marks_[grid.begin + row * grid.columns + column])
      .fetch_or(what, std::memory_order_relaxed);
}

FaceCoverage FaceTiles::count(std::size_t face) const {
  const Grid& grid = grids_[face];
  std::size_t covered = 0;
  std::size_t passed = 0;
  for (std::size_t k = grid.begin; k < grid.begin + grid.columns * grid.rows; ++k) {
    covered += (marks_[k] & kCovered) != 0 ? 1 : 0;
    passed += marks_[k] == kPassed ? 1 : 0;
  }
  // Tiles at an outline that is no rectangle count whole.
  const double area_m2 = area(index_.face(static_cast<int>(face)).outline);
  const double covered_m2 = std::min(area_m2, static_cast<double>(covered) * grid.tile_m.prod());
  return {covered_m2, std::min(area_m2 - covered_m2, static_cast<double>(passed) * grid.tile_m.prod())};
}

void FaceTiles::add(const ScanInModel& scan, const PointFaces& laid, const DeviationOptions& options) {
  const double share = static_cast<double>(options.rays) / static_cast<double>(scan.points.size() + 1);
  const auto follow = [&](std::size_t i) {
    const Vector3d& point = scan.points[i];
    if (laid.face[i] >= 0) mark(laid.face[i], point, kCovered);
    if (!scan.centre_known() || unit_lot(mix_place(point, kSamePlaceM)) >= share) return;
    const Vector3d& centre = scan.centre(i);
    const double range = (point - centre).norm();
    if (range <= kBeginM) return;
    const Vector3d begin = centre + kBeginM / range * (point - centre);
    for (const FaceCrossing& crossing : index_.crossings(begin, point)) {
      const Plane& plane = index_.face(crossing.face).plane;
      if (plane.signed_distance(begin) > 0.0 && plane.signed_distance(point) < -options.max_distance_m)
        mark(crossing.face, crossing.at, kPassed);
    }
  };
  parallel_for(scan.points.size(), kSamplesPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) follow(i);
  });
}

std::vector<FaceCoverage> FaceTiles::coverage() const {
  std::vector<FaceCoverage> all(index_.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = count(k);
  return all;
}

}  // namespace limen
