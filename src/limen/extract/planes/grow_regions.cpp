// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/grow_regions.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/consensus/msac.h"
#include "limen/extract/planes/merge_planes.h"

namespace limen {
namespace {

constexpr std::size_t kMsacTrials = 24;  // per region, besides its least-squares plane
constexpr double kUnevenShare = 0.25;    // of the threshold: unevenness of a cube
constexpr double kMinPiece = 15.0;       // points that may join a plane
constexpr std::int32_t kNoRegion = -1;
constexpr std::int32_t kRejected = -2;
constexpr std::int32_t kOpen = -3;

const Cell& cell_of(const CellGrid& grid, std::int32_t i) {
  return grid.cells()[static_cast<std::size_t>(i)];
}
Cell& cell_of(CellGrid& grid, std::int32_t i) {
  return grid.cells()[static_cast<std::size_t>(i)];
}

/// Planes through three cubes of a region; a cube weighs as much as it has points.
struct CubeEstimator {
  using Model = Plane;
  static constexpr std::size_t kSampleSize = 3;
  const CellGrid& grid;
  const std::vector<std::int32_t>& cells;

  [[nodiscard]] const Cell& cell(std::uint32_t item) const { return cell_of(grid, cells[item]); }
  [[nodiscard]] const PointMoments& moments(std::uint32_t item) const {
    return grid.shape(cell(item)).moments;
  }
  [[nodiscard]] std::size_t size() const { return cells.size(); }
  [[nodiscard]] double weight(std::uint32_t item) const { return moments(item).count; }
  [[nodiscard]] std::optional<Plane> estimate(const std::array<std::uint32_t, 3>& sample) const {
    PointMoments sums;
    for (const std::uint32_t item : sample) sums += moments(item);
    return fit_plane(sums).plane;
  }
  [[nodiscard]] double residual(const Plane& plane, std::uint32_t item) const {
    return rms_about(moments(item), plane);
  }
};

/// Planar cubes, those that hold most points first.
std::vector<std::int32_t> seeds_of(const CellGrid& grid) {
  std::vector<std::int32_t> seeds;
  for (std::size_t i = 0; i < grid.cells().size(); ++i) {
    if (grid.cells()[i].planar) seeds.push_back(static_cast<std::int32_t>(i));
  }
  std::stable_sort(seeds.begin(), seeds.end(), [&](std::int32_t a, std::int32_t b) {
    return cell_of(grid, a).count() > cell_of(grid, b).count();
  });
  return seeds;
}

}  // namespace

RegionGrower::RegionGrower(const MortonOrder& sorted, const RegionOptions& options)
    : sorted_(&sorted), options_(options), gate_m_(kGateShare * options.threshold_m) {}

void RegionGrower::grow_level(int level, const std::vector<std::uint32_t>& active,
                              std::vector<std::int32_t>& labels) {
  CellGrid grid(*sorted_, active, level);
  mark_planar(grid);
  for (const std::int32_t seed : seeds_of(grid)) {
    if (cell_of(grid, seed).region == kNoRegion) grow_region(grid, seed);
  }
  label_points(grid, active, labels);
}

void RegionGrower::mark_planar(CellGrid& grid) const {
  for (Cell& cell : grid.cells()) {
    if (cell.shape < 0) continue;
    const CellShape& shape = grid.shape(cell);
    cell.planar = shape.thickness_m < gate_m_ && shape.unevenness_m < kUnevenShare * options_.threshold_m &&
                  shape.spread_m > 3.0 * shape.thickness_m && shape.spread_m > 0.08 * grid.edge_m();
  }
}

bool RegionGrower::fits(const CellShape& shape, const Plane& plane) const {
  const double slack = 3.0 * shape.thickness_m / (shape.spread_m * std::sqrt(shape.moments.count));
  const double angle = std::min(radians(options_.max_angle_deg) + slack, radians(40.0));
  return std::abs(shape.normal.dot(plane.normal)) >= std::cos(angle) &&
         rms_about(shape.moments, plane) <= gate_m_;
}

/// Breadth first from `start` cells over free planar neighbours that fit; the plane follows the points.
RegionGrower::Region RegionGrower::flood(CellGrid& grid, const std::vector<std::int32_t>& start,
                                         const Plane& plane, bool refit) const {
  Region region;
  region.plane = plane;
  region.cells = start;
  for (const std::int32_t i : start) {
    cell_of(grid, i).region = kOpen;
    region.moments += grid.shape(cell_of(grid, i)).moments;
  }
  double fitted_count = region.moments.count;
  for (std::size_t head = 0; head < region.cells.size(); ++head) {
    for (const std::int32_t i : grid.neighbours(static_cast<std::size_t>(region.cells[head]))) {
      Cell& cell = cell_of(grid, i);
      if (!cell.planar || cell.region >= 0 || cell.region == kOpen || !fits(grid.shape(cell), region.plane))
        continue;
      cell.region = kOpen;
      region.cells.push_back(i);
      region.moments += grid.shape(cell).moments;
    }
    if (refit && region.moments.count > 1.3 * fitted_count) {
      region.plane = fit_plane(region.moments).plane;
      fitted_count = region.moments.count;
    }
  }
  return region;
}

/// Best plane of a region: its least-squares plane, or a better one by MSAC over its cubes (2022, eq. 2).
Plane RegionGrower::consensus(const CellGrid& grid, const Region& region) const {
  const CubeEstimator cubes{grid, region.cells};
  const Plane whole = fit_plane(region.moments).plane;
  const double score = score_of(cubes, whole, MsacScore{gate_m_}, region.moments.count);
  if (score > 0.9 * region.moments.count || region.cells.size() < 4) return whole;
  const std::uint64_t seed = mix64(static_cast<std::uint64_t>(cubes.cell(0).begin) + 17);
  const auto found = msac(cubes, UniformSampler(cubes.size(), seed),
                          {.threshold = gate_m_, .confidence = 0.999, .most_trials = kMsacTrials});
  return found.model && found.score > score ? *found.model : whole;
}

/// Keeps the cubes of a region that fit `plane`; the others are free again.
void RegionGrower::trim(CellGrid& grid, Region& region, const Plane& plane) const {
  std::vector<std::int32_t> kept;
  PointMoments moments;
  for (const std::int32_t i : region.cells) {
    Cell& cell = cell_of(grid, i);
    if (fits(grid.shape(cell), plane)) {
      kept.push_back(i);
      moments += grid.shape(cell).moments;
    } else {
      cell.region = kNoRegion;
    }
  }
  region.cells = std::move(kept);
  region.moments = moments;
  region.plane = plane;
}

void RegionGrower::grow_region(CellGrid& grid, std::int32_t seed) {
  Region region = flood(grid, {seed}, grid.shape(cell_of(grid, seed)).plane(), true);
  trim(grid, region, consensus(grid, region));
  if (region.cells.size() > 1) {
    region = flood(grid, region.cells, fit_plane(region.moments).plane, false);
    trim(grid, region, fit_plane(region.moments).plane);
  }
  settle(grid, region);
}

/// A region becomes a plane, part of a plane, or nothing.
void RegionGrower::settle(CellGrid& grid, const Region& region) {
  std::int32_t label = kRejected;
  if (region.moments.count >= kMinPiece) {
    // What can stand alone does: whether it continues another plane is seen better in the end.
    if (region.moments.count < 0.5 * options_.min_inliers) {
      label = plane_joined_by(region.moments, fit_plane(region.moments).plane);
    } else {
      label = static_cast<std::int32_t>(planes_.size());
      planes_.emplace_back();
    }
    if (label >= 0) {
      Region& plane = planes_[static_cast<std::size_t>(label)];
      plane.moments += region.moments;
      plane.plane = fit_plane(plane.moments).plane;
    }
  }
  for (const std::int32_t i : region.cells) cell_of(grid, i).region = std::max(label, kRejected);
}

/// The plane that these points continue, or -1.
std::int32_t RegionGrower::plane_joined_by(const PointMoments& moments, const Plane& plane) const {
  std::int32_t best = -1;
  double best_rms = gate_m_;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (std::abs(planes_[i].plane.normal.dot(plane.normal)) < std::cos(radians(kJoinAngleDeg))) continue;
    const double rms = rms_about(moments, planes_[i].plane);
    if (rms < best_rms) {
      best_rms = rms;
      best = static_cast<std::int32_t>(i);
    }
  }
  return best;
}

/// Points of a cube and of its neighbours join the nearest plane found there.
void RegionGrower::label_points(const CellGrid& grid, const std::vector<std::uint32_t>& active,
                                std::vector<std::int32_t>& labels) const {
  // Most cubes of the fine levels are far from any plane.
  std::vector<std::uint8_t> touched(grid.cells().size(), 0);
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (grid.cells()[i].region < 0) continue;
    touched[i] = 1;
    for (const std::int32_t j : grid.neighbours(i)) touched[static_cast<std::size_t>(j)] = 1;
  }
  parallel_for(grid.cells().size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      if (touched[i] == 0) continue;
      const Cell& cell = grid.cells()[i];
      near.clear();
      if (cell.region >= 0) near.push_back(cell.region);
      for (const std::int32_t j : grid.neighbours(i)) {
        const std::int32_t region = cell_of(grid, j).region;
        if (region >= 0 && std::find(near.begin(), near.end(), region) == near.end()) near.push_back(region);
      }
      if (near.empty()) continue;
      for (std::uint32_t k = cell.begin; k < cell.end; ++k)
        labels[active[k]] = nearest(sorted_->point(active[k]), near);
    }
  });
}

std::int32_t RegionGrower::nearest(const Vector3d& point, const std::vector<std::int32_t>& near) const {
  std::int32_t best = -1;
  double smallest = options_.threshold_m;
  for (const std::int32_t i : near) {
    const double d = std::abs(planes_[static_cast<std::size_t>(i)].plane.signed_distance(point));
    if (d >= smallest) continue;
    smallest = d;
    best = i;
  }
  return best;
}

}  // namespace limen
