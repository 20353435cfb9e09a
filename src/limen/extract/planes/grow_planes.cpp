// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/grow_planes.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/extract/cells/cell_grid.h"
#include "limen/extract/cells/point_normals.h"
#include "limen/extract/planes/grow_regions.h"
#include "limen/extract/planes/merge_planes.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/extract/planes/settle_planes.h"

namespace limen {
namespace {

constexpr int kSparseLevels = 3;  // coarser than the first cubes, for what lies far from the scanner
constexpr int kSettlings = 2;
constexpr double kSettleCellM = 0.08;  // points choose among the planes of their cube and those around
constexpr double kExplained = 0.65;    // of a plane's points: others would take them

double noise_of(const CellGrid& grid) {
  std::vector<double> thickness;
  for (const Cell& cell : grid.cells()) {
    if (cell.count() < 12) continue;
    const CellShape& shape = grid.shape(cell);
    if (shape.spread_m > 5.0 * shape.thickness_m && shape.spread_m > 0.1 * grid.edge_m())
      thickness.push_back(shape.thickness_m);
  }
  if (thickness.size() < 20) return 0.005;
  return median(thickness);
}

std::vector<std::uint32_t> all_positions(std::size_t size) {
  std::vector<std::uint32_t> positions(size);
  std::iota(positions.begin(), positions.end(), 0U);
  return positions;
}

class PlaneGrower {
 public:
  PlaneGrower(const MortonOrder& sorted, const SettleGrid& grid, const GrowOptions& options)
      : options_(options), sorted_(sorted), settle_grid_(grid), labels_(sorted.size(), -1) {
    threshold_m_ = options_.inlier_threshold_m;
    if (threshold_m_ > 0) return;
    const CellGrid cells(sorted_, all_positions(labels_.size()), level_of(0.16, options_.finest_cell_m));
    noise_m_ = noise_of(cells);
    threshold_m_ = std::clamp(3.3 * noise_m_, 0.008, 0.03);
  }

  GrownPlanes run(Monitor& monitor) {
    // Regions grow one after the other: meanwhile it is seen how the surface faces at each point.
    std::shared_ptr<const PointNormals> normals;
    run_both([&] { grow(monitor); },
             [&] { normals = std::make_shared<const PointNormals>(sorted_, kGateShare * threshold_m_); });
    monitor.throw_if_cancelled();
    const SettleScene scene{sorted_, *normals, settle_grid_};
    merge();
    const SettleOptions settling{.threshold_m = threshold_m_};
    for (int k = 0; k < kSettlings; ++k) {
      monitor.advance(kSteps - kSettlings - 1 + k, kSteps);
      labels_ = settled(scene, labels_, sums_, settling);
      merge();
    }
    monitor.advance(kSteps - 1, kSteps);
    dissolve(explained_shares(scene, labels_, sums_, settling));
    labels_ = settled(scene, labels_, sums_, settling);
    merge();
    GrownPlanes grown = finish();
    grown.normals = std::move(normals);
    return grown;
  }

 private:
  /// Coarse to fine, each level on what the levels before left; then coarser than all, for sparse planes.
  void grow(Monitor& monitor) {
    RegionGrower grower(sorted_, {.threshold_m = threshold_m_,
                                  .min_inliers = options_.min_inliers,
                                  .max_angle_deg = options_.max_angle_deg});
    std::vector<std::uint32_t> active = all_positions(labels_.size());
    const int coarsest = level_of(options_.coarsest_cell_m, options_.finest_cell_m);
    std::vector<int> levels;
    for (int level = coarsest; level >= 0; --level) levels.push_back(level);
    for (int level = coarsest + 1; level <= coarsest + kSparseLevels; ++level) levels.push_back(level);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      monitor.throw_if_cancelled();
      monitor.advance(kGrowSteps * static_cast<double>(k) / static_cast<double>(levels.size()), kSteps);
      grower.grow_level(levels[k], active, labels_);
      std::erase_if(active, [&](std::uint32_t position) { return labels_[position] >= 0; });
    }
    sums_.resize(grower.planes());
  }

  /// Sums per plane; pieces of one plane that were found one by one become one.
  void merge() {
    sum_up();
    MergedPieces merged = merge_planes(sums_, radians(kJoinAngleDeg), kGateShare * threshold_m_);
    sums_ = std::move(merged.planes);
    for (std::int32_t& label : labels_) {
      if (label >= 0) label = merged.target[static_cast<std::size_t>(label)];
    }
  }

  /// Planes that cut through the edges of others give their points back.
  void dissolve(const std::vector<double>& explained) {
    for (std::int32_t& label : labels_) {
      if (label >= 0 && explained[static_cast<std::size_t>(label)] > kExplained) label = -1;
    }
  }

  void sum_up() { sums_ = label_sums(sorted_, labels_, sums_.size()); }

  [[nodiscard]] GrownPlanes finish() const {
    GrownPlanes grown;
    grown.noise_m = noise_m_;
    grown.inlier_threshold_m = threshold_m_;
    grown.planes = planes_by_scan(sorted_, labels_, sums_, options_.min_inliers);
    grown.planes.inlier_threshold_m = threshold_m_;
    return grown;
  }

  // Of progress: growing, then the settlings and the last look.
  static constexpr double kGrowSteps = 4.0;
  static constexpr double kSteps = kGrowSteps + kSettlings + 1.0;

  GrowOptions options_;
  const MortonOrder& sorted_;
  const SettleGrid& settle_grid_;
  std::vector<std::int32_t> labels_;  ///< by position along the curve
  std::vector<PointMoments> sums_;    ///< by label, about the curve's anchor
  double threshold_m_ = 0.01;
  double noise_m_ = 0.0;
};

}  // namespace

void GrowOptions::check() const {
  if (!(inlier_threshold_m >= 0)) throw_bad_option("inlier_threshold_m", inlier_threshold_m, "0 or more");
  if (min_inliers < 3) throw_bad_option("min_inliers", min_inliers, "3 or more");
  if (!(finest_cell_m > 0)) throw_bad_option("finest_cell_m", finest_cell_m, "more than 0");
  if (!(coarsest_cell_m >= finest_cell_m)) {
    throw_bad_option("coarsest_cell_m", coarsest_cell_m, "at least finest_cell_m");
  }
  if (!(max_angle_deg > 0 && max_angle_deg < 45))
    throw_bad_option("max_angle_deg", max_angle_deg, "within (0, 45)");
}

struct PlaneGround::Ordered {
  MortonOrder points;
  SettleGrid grid;

  Ordered(const Scan& scan, double finest_cell_m)
      : points(morton_order(scan.points, finest_cell_m)), grid(points, kSettleCellM) {}
};

PlaneGround::PlaneGround(const Scan& scan, const GrowOptions& options) : options_(options) {
  options.check();
  if (scan.size() > 0) ordered_ = std::make_unique<const Ordered>(scan, options.finest_cell_m);
}

PlaneGround::~PlaneGround() = default;

const MortonOrder& PlaneGround::order() const {
  static const MortonOrder kNone;
  return ordered_ == nullptr ? kNone : ordered_->points;
}

GrownPlanes PlaneGround::grow(double inlier_threshold_m, Monitor& monitor) const {
  GrowOptions options = options_;
  options.inlier_threshold_m = inlier_threshold_m;
  options.check();
  if (ordered_ == nullptr) return {};
  return PlaneGrower(ordered_->points, ordered_->grid, options).run(monitor);
}

GrownPlanes grow_planes(const Scan& scan, const GrowOptions& options, Monitor& monitor) {
  return PlaneGround(scan, options).grow(options.inlier_threshold_m, monitor);
}

}  // namespace limen
