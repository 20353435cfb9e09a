// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/grow_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/cell_grid.h"

namespace limen {
namespace {

constexpr double kGateShare = 0.6;     // of the inlier threshold: root mean square of a cube about its plane
constexpr int kMsacTrials = 24;        // per region, besides its least-squares plane
constexpr double kJoinAngleDeg = 3.0;  // normals of two pieces of one plane

/// A plane under construction, about the curve's anchor.
struct Region {
  PointMoments moments;
  Plane plane;
  std::vector<std::int32_t> cells;
};

/// Root mean square distance of the points behind `moments` to `plane`.
double rms_about(const PointMoments& moments, const Plane& plane) {
  const double distance = plane.signed_distance(moments.mean());
  const double variance = plane.normal.dot(moments.covariance() * plane.normal);
  return std::sqrt(std::max(0.0, variance) + distance * distance);
}

double noise_of(const CellGrid& grid) {
  std::vector<double> thickness;
  for (const Cell& cell : grid.cells()) {
    if (cell.count() >= 12 && cell.spread_m > 5.0 * cell.thickness_m && cell.spread_m > 0.1 * grid.edge_m()) {
      thickness.push_back(cell.thickness_m);
    }
  }
  if (thickness.size() < 20) return 0.005;
  const auto middle = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 2);
  std::nth_element(thickness.begin(), middle, thickness.end());
  return *middle;
}

int level_of(double cell_m, double finest_m) {
  return std::max(0, static_cast<int>(std::lround(std::log2(cell_m / finest_m))));
}

class PlaneGrower {
 public:
  PlaneGrower(const Scan& scan, const GrowOptions& options)
      : options_(options), sorted_(morton_order(scan.points, options.finest_cell_m)) {
    active_.resize(scan.size());
    std::iota(active_.begin(), active_.end(), 0U);
    labels_.assign(scan.size(), -1);
  }

  GrownPlanes run(Monitor& monitor) {
    choose_threshold();
    const int coarsest = level_of(options_.coarsest_cell_m, options_.finest_cell_m);
    for (int level = coarsest; level >= 0; --level) {
      monitor.throw_if_cancelled();
      monitor.advance(coarsest - level, coarsest + 1);
      grow_level(level);
    }
    return finish();
  }

 private:
  void choose_threshold() {
    const CellGrid grid(sorted_, active_, level_of(0.16, options_.finest_cell_m));
    noise_m_ = noise_of(grid);
    threshold_m_ = options_.inlier_threshold_m > 0 ? options_.inlier_threshold_m
                                                   : std::clamp(3.3 * noise_m_, 0.008, 0.03);
  }

  void grow_level(int level) {
    CellGrid grid(sorted_, active_, level);
    mark_planar(grid);
    std::vector<std::int32_t> seeds = seeds_of(grid);
    for (const std::int32_t seed : seeds) {
      const Cell& cell = grid.cells()[static_cast<std::size_t>(seed)];
      if (cell.region == -1) grow_region(grid, seed);
    }
    assign_points(grid);
    std::erase_if(active_, [&](std::uint32_t position) { return labels_[position] >= 0; });
  }

  void mark_planar(CellGrid& grid) const {
    for (Cell& cell : grid.cells()) {
      cell.planar = cell.count() >= 6 && cell.thickness_m < kGateShare * threshold_m_ &&
                    cell.spread_m > 3.0 * cell.thickness_m && cell.spread_m > 0.08 * grid.edge_m();
    }
  }

  /// Planar cubes, those that hold most points first.
  static std::vector<std::int32_t> seeds_of(const CellGrid& grid) {
    std::vector<std::int32_t> seeds;
    for (std::size_t i = 0; i < grid.cells().size(); ++i) {
      if (grid.cells()[i].planar) seeds.push_back(static_cast<std::int32_t>(i));
    }
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::int32_t a, std::int32_t b) {
      return grid.cells()[static_cast<std::size_t>(a)].count() >
             grid.cells()[static_cast<std::size_t>(b)].count();
    });
    return seeds;
  }

  [[nodiscard]] bool fits(const Cell& cell, const Plane& plane) const {
    const double slack = 3.0 * cell.thickness_m / (cell.spread_m * std::sqrt(cell.moments.count));
    const double angle = std::min(radians(options_.max_angle_deg) + slack, radians(40.0));
    return std::abs(cell.normal.dot(plane.normal)) >= std::cos(angle) &&
           rms_about(cell.moments, plane) <= kGateShare * threshold_m_;
  }

  /// Breadth first from `start` cells over free planar neighbours that fit; the plane follows the points.
  Region flood(CellGrid& grid, const std::vector<std::int32_t>& start, Plane plane, bool refit) {
    Region region;
    region.plane = plane;
    region.cells = start;
    for (const std::int32_t i : start) {
      Cell& cell = grid.cells()[static_cast<std::size_t>(i)];
      cell.region = kOpen;
      region.moments += cell.moments;
    }
    double fitted_count = region.moments.count;
    for (std::size_t head = 0; head < region.cells.size(); ++head) {
      const Cell& from = grid.cells()[static_cast<std::size_t>(region.cells[head])];
      for (const std::int32_t i : grid.neighbours(from)) {
        Cell& cell = grid.cells()[static_cast<std::size_t>(i)];
        if (!cell.planar || cell.region >= 0 || cell.region == kOpen || !fits(cell, region.plane)) continue;
        cell.region = kOpen;
        region.cells.push_back(i);
        region.moments += cell.moments;
      }
      if (refit && region.moments.count > 1.3 * fitted_count) {
        region.plane = fit_plane(region.moments).plane;
        fitted_count = region.moments.count;
      }
    }
    return region;
  }

  /// Best plane of a region by MSAC over its cubes, samples of three cubes (2022, eq. 2 as a score).
  [[nodiscard]] Plane consensus(const CellGrid& grid, const Region& region) const {
    const auto cell_at = [&](std::size_t i) -> const Cell& {
      return grid.cells()[static_cast<std::size_t>(region.cells[i])];
    };
    const auto score = [&](const Plane& plane) {
      double sum = 0.0;
      const double t = kGateShare * threshold_m_;
      for (std::size_t i = 0; i < region.cells.size(); ++i) {
        const double residual = rms_about(cell_at(i).moments, plane) / t;
        sum += cell_at(i).moments.count * std::max(0.0, 1.0 - residual * residual);
      }
      return sum;
    };
    Plane best = fit_plane(region.moments).plane;
    double best_score = score(best);
    if (best_score > 0.9 * region.moments.count || region.cells.size() < 4) return best;
    RandomStream stream(17, cell_at(0).code);
    for (int trial = 0; trial < kMsacTrials; ++trial) {
      PointMoments sample;
      const auto n = static_cast<std::uint32_t>(region.cells.size());
      for (int k = 0; k < 3; ++k) sample += cell_at(stream.below(n)).moments;
      const Plane plane = fit_plane(sample).plane;
      const double plane_score = score(plane);
      if (plane_score > best_score) {
        best = plane;
        best_score = plane_score;
      }
    }
    return best;
  }

  /// Keeps the cubes of a region that fit `plane`; the others are free again.
  void trim(CellGrid& grid, Region& region, const Plane& plane) const {
    std::vector<std::int32_t> kept;
    PointMoments moments;
    for (const std::int32_t i : region.cells) {
      Cell& cell = grid.cells()[static_cast<std::size_t>(i)];
      if (fits(cell, plane)) {
        kept.push_back(i);
        moments += cell.moments;
      } else {
        cell.region = -1;
      }
    }
    region.cells = std::move(kept);
    region.moments = moments;
    region.plane = plane;
  }

  void grow_region(CellGrid& grid, std::int32_t seed) {
    const Cell& first = grid.cells()[static_cast<std::size_t>(seed)];
    Region region = flood(grid, {seed}, {first.normal, first.normal.dot(first.mean)}, true);
    trim(grid, region, consensus(grid, region));
    if (region.cells.size() > 1) {
      region.plane = fit_plane(region.moments).plane;
      region = flood(grid, region.cells, region.plane, false);
      trim(grid, region, fit_plane(region.moments).plane);
    }
    settle(grid, region);
  }

  /// A region becomes a plane, part of a plane, or nothing.
  void settle(CellGrid& grid, const Region& region) {
    std::int32_t label = kRejected;
    if (region.moments.count >= 15) {
      const PlaneFit fit = fit_plane(region.moments);
      label = plane_joined_by(region.moments, fit.plane);
      if (label < 0 && region.moments.count >= 0.5 * options_.min_inliers) {
        label = static_cast<std::int32_t>(regions_.size());
        regions_.emplace_back();
      }
      if (label >= 0) {
        Region& plane = regions_[static_cast<std::size_t>(label)];
        plane.moments += region.moments;
        plane.plane = fit_plane(plane.moments).plane;
      }
    }
    for (const std::int32_t i : region.cells)
      grid.cells()[static_cast<std::size_t>(i)].region = std::max(label, kRejected);
  }

  /// The plane that these points continue, or -1.
  [[nodiscard]] std::int32_t plane_joined_by(const PointMoments& moments, const Plane& plane) const {
    std::int32_t best = -1;
    double best_rms = kGateShare * threshold_m_;
    for (std::size_t i = 0; i < regions_.size(); ++i) {
      if (std::abs(regions_[i].plane.normal.dot(plane.normal)) < std::cos(radians(kJoinAngleDeg))) continue;
      const double rms = rms_about(moments, regions_[i].plane);
      if (rms < best_rms) {
        best_rms = rms;
        best = static_cast<std::int32_t>(i);
      }
    }
    return best;
  }

  /// Points of a cube and of its neighbours join the nearest plane found there.
  void assign_points(CellGrid& grid) {
    parallel_for(grid.cells().size(), 256, [&](std::size_t begin, std::size_t end) {
      std::vector<std::int32_t> near;
      for (std::size_t i = begin; i < end; ++i) {
        const Cell& cell = grid.cells()[i];
        near.clear();
        if (cell.region >= 0) near.push_back(cell.region);
        for (const std::int32_t j : grid.neighbours(cell)) {
          const std::int32_t region = grid.cells()[static_cast<std::size_t>(j)].region;
          if (region >= 0 && std::find(near.begin(), near.end(), region) == near.end())
            near.push_back(region);
        }
        if (near.empty()) continue;
        for (std::uint32_t k = cell.begin; k < cell.end; ++k) label_point(active_[k], near);
      }
    });
  }

  void label_point(std::uint32_t position, const std::vector<std::int32_t>& near) {
    double best = threshold_m_;
    for (const std::int32_t i : near) {
      const double d =
          std::abs(regions_[static_cast<std::size_t>(i)].plane.signed_distance(sorted_.points[position]));
      if (d < best) {
        best = d;
        labels_[position] = i;
      }
    }
  }

  [[nodiscard]] std::vector<PointMoments> moments_by_label() const {
    using Sums = std::vector<PointMoments>;
    return parallel_reduce(
        labels_.size(), 131072, Sums(regions_.size()),
        [&](std::size_t begin, std::size_t end) {
          Sums sums(regions_.size());
          for (std::size_t k = begin; k < end; ++k) {
            if (labels_[k] >= 0) sums[static_cast<std::size_t>(labels_[k])].add(sorted_.points[k]);
          }
          return sums;
        },
        [](Sums a, const Sums& b) {
          for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
          return a;
        });
  }

  /// Pieces of one plane that were found apart become one: largest first.
  [[nodiscard]] std::vector<std::int32_t> merge(std::vector<PointMoments>& sums) const {
    std::vector<std::int32_t> by_size(sums.size());
    std::iota(by_size.begin(), by_size.end(), 0);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::int32_t a, std::int32_t b) {
      return sums[static_cast<std::size_t>(a)].count > sums[static_cast<std::size_t>(b)].count;
    });
    std::vector<std::int32_t> target(sums.size(), -1);
    std::vector<std::int32_t> kept;
    for (const std::int32_t i : by_size) {
      PointMoments& own = sums[static_cast<std::size_t>(i)];
      if (own.count < 3) continue;
      const Plane plane = fit_plane(own).plane;
      for (const std::int32_t j : kept) {
        PointMoments both = sums[static_cast<std::size_t>(j)];
        const Plane other = fit_plane(both).plane;
        if (std::abs(other.normal.dot(plane.normal)) < std::cos(radians(kJoinAngleDeg))) continue;
        both += own;
        const Plane common = fit_plane(both).plane;
        const double gate = kGateShare * threshold_m_;
        if (rms_about(own, common) < gate && rms_about(sums[static_cast<std::size_t>(j)], common) < gate) {
          sums[static_cast<std::size_t>(j)] = both;
          target[static_cast<std::size_t>(i)] = j;
          break;
        }
      }
      if (target[static_cast<std::size_t>(i)] < 0) {
        target[static_cast<std::size_t>(i)] = i;
        kept.push_back(i);
      }
    }
    return target;
  }

  GrownPlanes finish() {
    GrownPlanes grown;
    grown.noise_m = noise_m_;
    grown.inlier_threshold_m = threshold_m_;
    grown.planes.inlier_threshold_m = threshold_m_;
    std::vector<PointMoments> sums = moments_by_label();
    const std::vector<std::int32_t> target = merge(sums);
    std::vector<std::int32_t> final_label(sums.size(), -1);
    std::vector<std::int32_t> kept;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (target[i] == static_cast<std::int32_t>(i) && sums[i].count >= options_.min_inliers) {
        kept.push_back(static_cast<std::int32_t>(i));
      }
    }
    std::stable_sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
      return sums[static_cast<std::size_t>(a)].count > sums[static_cast<std::size_t>(b)].count;
    });
    for (std::size_t k = 0; k < kept.size(); ++k) {
      final_label[static_cast<std::size_t>(kept[k])] = static_cast<std::int32_t>(k);
      PlaneFit fit = fit_plane(sums[static_cast<std::size_t>(kept[k])]);
      fit.plane = shifted(fit.plane, -sorted_.anchor);
      fit.centroid += sorted_.anchor;
      grown.planes.fits.push_back(fit);
    }
    grown.planes.labels.assign(labels_.size(), -1);
    parallel_for(labels_.size(), 65536, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (labels_[k] < 0) continue;
        const std::int32_t merged = target[static_cast<std::size_t>(labels_[k])];
        if (merged >= 0)
          grown.planes.labels[sorted_.order[k]] = final_label[static_cast<std::size_t>(merged)];
      }
    });
    return grown;
  }

  static constexpr std::int32_t kRejected = -2;
  static constexpr std::int32_t kOpen = -3;

  GrowOptions options_;
  MortonOrder sorted_;
  std::vector<std::uint32_t> active_;
  std::vector<std::int32_t> labels_;
  std::vector<Region> regions_;
  double threshold_m_ = 0.01;
  double noise_m_ = 0.0;
};

}  // namespace

void GrowOptions::check() const {
  if (inlier_threshold_m < 0) throw_bad_option("inlier_threshold_m", inlier_threshold_m, "0 or more");
  if (min_inliers < 3) throw_bad_option("min_inliers", min_inliers, "3 or more");
  if (!(finest_cell_m > 0)) throw_bad_option("finest_cell_m", finest_cell_m, "more than 0");
  if (!(coarsest_cell_m >= finest_cell_m)) {
    throw_bad_option("coarsest_cell_m", coarsest_cell_m, "at least finest_cell_m");
  }
  if (!(max_angle_deg > 0 && max_angle_deg < 45))
    throw_bad_option("max_angle_deg", max_angle_deg, "within (0, 45)");
}

GrownPlanes grow_planes(const Scan& scan, const GrowOptions& options, Monitor& monitor) {
  options.check();
  if (scan.size() == 0) return {};
  return PlaneGrower(scan, options).run(monitor);
}

}  // namespace limen
