// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/interior_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kMostCells = 4.0e6;

}  // namespace

OutlineRaster::OutlineRaster(std::vector<Polygon> polygons, double cell_m)
    : polygons_(std::move(polygons)), box_(box_of(polygons_)), cell_m_(cell_m) {
  if (!(cell_m > 0.0)) throw_bad_option("cell_m", cell_m, "greater than 0");
  if (box_.empty()) return;
  const Vector2d size = box_.high - box_.low;
  cell_m_ = std::max({cell_m, std::sqrt(size.x() * size.y() / kMostCells), size.maxCoeff() / kMostCells});
  columns_ = static_cast<std::size_t>(size.x() / cell_m_) + 1;
  rows_ = static_cast<std::size_t>(size.y() / cell_m_) + 1;
  cells_.assign(columns_ * rows_, Cell::outside);
  for (const Polygon& polygon : polygons_) {
    const Ring& ring = polygon.outer;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) cut_by(ring[j], ring[i]);
  }
  fill_rows();
}

std::size_t OutlineRaster::column(double x) const {
  return static_cast<std::size_t>(
      std::clamp((x - box_.low.x()) / cell_m_, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t OutlineRaster::row(double y) const {
  return static_cast<std::size_t>(
      std::clamp((y - box_.low.y()) / cell_m_, 0.0, static_cast<double>(rows_ - 1)));
}

/// Marks the cells that the edge passes, row by row; a little too many, so that rounding does no harm.
void OutlineRaster::cut_by(const Vector2d& a, const Vector2d& b) {
  const Vector2d& low = a.y() < b.y() ? a : b;
  const Vector2d& high = a.y() < b.y() ? b : a;
  const double slack = 1e-6 * cell_m_;
  for (std::size_t r = row(low.y() - slack); r <= row(high.y() + slack); ++r) {
    const double y0 = box_.low.y() + static_cast<double>(r) * cell_m_ - slack;
    const auto x_at = [&](double y) {
      const double t = high.y() > low.y() ? (y - low.y()) / (high.y() - low.y()) : 0.0;
      return low.x() + std::clamp(t, 0.0, 1.0) * (high.x() - low.x());
    };
    double x0 = x_at(y0);
    double x1 = high.y() > low.y() ? x_at(y0 + cell_m_ + 2.0 * slack) : high.x();
    if (x0 > x1) std::swap(x0, x1);
    for (std::size_t c = column(x0 - slack); c <= column(x1 + slack); ++c)
      cells_[r * columns_ + c] = Cell::cut;
  }
}

/// Between two cut cells of a row nothing changes: one exact test for each such run.
void OutlineRaster::fill_rows() {
  for (std::size_t r = 0; r < rows_; ++r) {
    Cell state = Cell::cut;
    for (std::size_t c = 0; c < columns_; ++c) {
      Cell& cell = cells_[r * columns_ + c];
      if (cell == Cell::cut) {
        state = Cell::cut;
        continue;
      }
      if (state == Cell::cut) {
        const Vector2d middle =
            box_.low + cell_m_ * Vector2d(static_cast<double>(c) + 0.5, static_cast<double>(r) + 0.5);
        state = contains_exactly(middle) ? Cell::inside : Cell::outside;
      }
      cell = state;
    }
  }
}

bool OutlineRaster::contains_exactly(const Vector2d& p) const {
  return std::any_of(polygons_.begin(), polygons_.end(),
                     [&](const Polygon& polygon) { return limen::contains(polygon.outer, p); });
}

bool OutlineRaster::contains(const Vector2d& p) const {
  if (cells_.empty() || !box_.contains(p)) return false;
  const Cell cell = cells_[row(p.y()) * columns_ + column(p.x())];
  return cell == Cell::cut ? contains_exactly(p) : cell == Cell::inside;
}

namespace {

constexpr std::size_t kCrossingRaysPerBlock = 256;  // consecutive rays that are rejected together
constexpr std::size_t kCrossingBlocksPerPiece = 64;
constexpr double kBoxSlack_m = 1e-6;

/// A wall made ready for many rays.
struct OutlineTarget {
  std::int32_t index = -1;
  Plane plane;
  PlaneFrame frame;
  bool one_sided = false;
  OutlineRaster outline;
  Extent box;  ///< of the outline in space
};

Extent box_of(const PlaneFrame& frame, const std::vector<Polygon>& outline) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent box{Vector3d::Constant(kInfinity), Vector3d::Constant(-kInfinity)};
  for (const Polygon& polygon : outline) {
    for (const Vector2d& p : polygon.outer) {
      box.low = box.low.cwiseMin(frame.to_space(p));
      box.high = box.high.cwiseMax(frame.to_space(p));
    }
  }
  box.low.array() -= kBoxSlack_m;
  box.high.array() += kBoxSlack_m;
  return box;
}

std::vector<OutlineTarget> make_targets(const std::vector<PlanarPolygon>& polygons,
                                        const std::vector<int>& walls, const InteriorPointOptions& options) {
  std::vector<std::optional<OutlineRaster>> outlines(walls.size());
  parallel_for(walls.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      outlines[k].emplace(wall_outline(polygons, walls[k], options.outline));
  });
  std::vector<OutlineTarget> targets;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (outlines[k]->box().empty()) continue;
    const PlanarPolygon& polygon = polygons.at(static_cast<std::size_t>(walls[k]));
    const Extent box = box_of(polygon.frame, outlines[k]->polygons());
    targets.push_back(
        {walls[k], polygon.plane, polygon.frame, polygon.oriented, std::move(*outlines[k]), box});
  }
  return targets;
}

/// Bounds of the rays of one block: their scanner positions, their points.
struct Block {
  Extent centres;
  Extent points;
};

Block bounds_of(const Scan& scan, std::size_t begin, std::size_t end) {
  Block block{{scan.centre(begin), scan.centre(begin)}, {scan.points[begin], scan.points[begin]}};
  for (std::size_t i = begin; i < end; ++i) {
    block.centres.low = block.centres.low.cwiseMin(scan.centre(i));
    block.centres.high = block.centres.high.cwiseMax(scan.centre(i));
    block.points.low = block.points.low.cwiseMin(scan.points[i]);
    block.points.high = block.points.high.cwiseMax(scan.points[i]);
  }
  return block;
}

bool may_cross(const Block& block, const OutlineTarget& target, double min_depth_m) {
  const Vector3d low = block.centres.low.cwiseMin(block.points.low);
  const Vector3d high = block.centres.high.cwiseMax(block.points.high);
  if ((low.array() > target.box.high.array()).any() || (high.array() < target.box.low.array()).any())
    return false;
  const auto [centre_low, centre_high] = signed_distances(target.plane, block.centres);
  const auto [point_low, point_high] = signed_distances(target.plane, block.points);
  if (centre_high > 0.0 && point_low <= -min_depth_m) return true;
  return !target.one_sided && centre_low < 0.0 && point_high >= min_depth_m;
}

/// The crossing of one ray with one wall; `wall` stays -1 where there is none. `share` of the ray comes
/// before.
struct Hit {
  Crossing crossing;
  double share = 2.0;
};

Hit cross(const Scan& scan, std::size_t point, const OutlineTarget& target,
          const InteriorPointOptions& options) {
  const Vector3d& centre = scan.centre(point);
  const Vector3d& x = scan.points[point];
  double before = target.plane.signed_distance(centre);
  double behind = -target.plane.signed_distance(x);
  if (!target.one_sided && before < 0.0) {
    before = -before;
    behind = -behind;
  }
  Hit hit;
  if (!(before > 0.0) || !(behind >= options.min_depth_m)) return hit;
  const double share = before / (before + behind);
  const double beyond_m = (1.0 - share) * (x - centre).norm();
  if (!(beyond_m >= options.min_beyond_m)) return hit;
  const Vector2d at = target.frame.to_plane(centre + share * (x - centre));
  if (!target.outline.contains(at)) return hit;
  hit.crossing = {static_cast<std::uint32_t>(point), target.index, at, behind};
  hit.share = share;
  return hit;
}

std::vector<Crossing> trace_block(const Scan& scan, std::size_t begin, std::size_t end,
                                  const std::vector<OutlineTarget>& targets,
                                  const InteriorPointOptions& options) {
  std::vector<const OutlineTarget*> near;
  const Block block = bounds_of(scan, begin, end);
  for (const OutlineTarget& target : targets) {
    if (may_cross(block, target, options.min_depth_m)) near.push_back(&target);
  }
  std::vector<Crossing> found;
  for (std::size_t i = begin; i < end && !near.empty(); ++i) {
    Hit first;
    for (const OutlineTarget* target : near) {
      const Hit hit = cross(scan, i, *target, options);
      if (hit.share < first.share) first = hit;
    }
    if (first.crossing.wall >= 0) found.push_back(first.crossing);
  }
  return found;
}

}  // namespace

void InteriorPointOptions::check() const {
  if (!(min_beyond_m >= 0.0)) throw_bad_option("min_beyond_m", min_beyond_m, "at least 0");
  if (!(min_depth_m > 0.0)) throw_bad_option("min_depth_m", min_depth_m, "greater than 0");
  outline.check();
}

std::vector<Crossing> find_interior_points(const Scan& scan, const std::vector<PlanarPolygon>& polygons,
                                           const std::vector<int>& walls, const InteriorPointOptions& options,
                                           Monitor& monitor) {
  options.check();
  if (scan.size() == 0) return {};
  if (!scan.centre_known()) {
    throw Error("the scanner position is unknown", scan.name,
                "give the scanner position, or a file that contains it");
  }
  const std::vector<OutlineTarget> targets = make_targets(polygons, walls, options);
  using Crossings = std::vector<Crossing>;
  return parallel_reduce(
      scan.size(), kCrossingRaysPerBlock * kCrossingBlocksPerPiece, Crossings{},
      [&](std::size_t begin, std::size_t end) {
        monitor.throw_if_cancelled();
        Crossings found;
        for (std::size_t at = begin; at < end; at += kCrossingRaysPerBlock) {
          const Crossings part =
              trace_block(scan, at, std::min(at + kCrossingRaysPerBlock, end), targets, options);
          found.insert(found.end(), part.begin(), part.end());
        }
        return found;
      },
      [](Crossings a, const Crossings& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

std::vector<std::uint32_t> point_indices(const std::vector<Crossing>& crossings) {
  std::vector<std::uint32_t> indices;
  indices.reserve(crossings.size());
  std::transform(crossings.begin(), crossings.end(), std::back_inserter(indices),
                 [](const Crossing& crossing) { return crossing.point; });
  return indices;
}

}  // namespace limen
