// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/cell_grid.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kMinChildPoints = 4.0;
constexpr int kChildLevels = 2;  // quarters of the edge: halves are met by a tilted plane through any step

double unevenness_of(const CellShape& shape, const MortonOrder& sorted, std::span<const std::uint32_t> points,
                     int level) {
  struct Child {
    double count = 0.0;
    double sum = 0.0;
  };
  // The smaller cubes are runs, too: one sum at a time.
  const Plane plane = shape.plane();
  const int shift = 3 * (level - kChildLevels);
  double worst = 0.0;
  for (std::size_t k = 0; k < points.size();) {
    const std::uint64_t code = sorted.codes[points[k]] >> shift;
    Child child;
    for (; k < points.size() && sorted.codes[points[k]] >> shift == code; ++k) {
      child.count += 1.0;
      child.sum += plane.signed_distance(sorted.point(points[k]));
    }
    if (child.count < kMinChildPoints) continue;
    const double explained = 3.0 * shape.thickness_m / std::sqrt(child.count);
    worst = std::max(worst, std::abs(child.sum / child.count) - explained);
  }
  return worst;
}

PointMoments moments_of(const MortonOrder& sorted, std::span<const std::uint32_t> points) {
  // Written out, each product once: most of the time of finding planes goes here.
  double x = 0, y = 0, z = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (const std::uint32_t k : points) {
    const Vector3d p = sorted.point(k);
    x += p[0];
    y += p[1];
    z += p[2];
    xx += p[0] * p[0];
    xy += p[0] * p[1];
    xz += p[0] * p[2];
    yy += p[1] * p[1];
    yz += p[1] * p[2];
    zz += p[2] * p[2];
  }
  PointMoments moments;
  moments.count = static_cast<double>(points.size());
  moments.sum = {x, y, z};
  moments.outer << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return moments;
}

}  // namespace

CellShape shape_of(const MortonOrder& sorted, std::span<const std::uint32_t> points, int level) {
  CellShape shape;
  shape.moments = moments_of(sorted, points);
  shape.mean = shape.moments.mean();
  Eigen::SelfAdjointEigenSolver<Matrix3d> solver;
  solver.computeDirect(shape.moments.covariance());
  const Vector3d variances = solver.eigenvalues().cwiseMax(0.0);
  const double freedoms = shape.moments.count / (shape.moments.count - 3.0);
  shape.thickness_m = std::sqrt(variances[0] * freedoms);
  shape.spread_m = std::sqrt(variances[1]);
  shape.normal = solver.eigenvectors().col(0);
  if (level >= kChildLevels) shape.unevenness_m = unevenness_of(shape, sorted, points, level);
  return shape;
}

CellGrid::CellGrid(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level)
    : runs_(sorted, active, level), cells_(runs_.size()), edge_m_(sorted.cell_m * std::exp2(level)) {
  std::vector<std::uint32_t> shaped;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    cell.begin = runs_.begin(i);
    cell.end = runs_.end(i);
    if (cell.count() < kLeastOfShape) continue;
    cell.shape = static_cast<std::int32_t>(shaped.size());
    shaped.push_back(static_cast<std::uint32_t>(i));
  }
  shapes_.resize(shaped.size());
  const std::span<const std::uint32_t> points(active);
  parallel_for(shaped.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Cell& cell = cells_[shaped[k]];
      shapes_[k] = shape_of(sorted, points.subspan(cell.begin, cell.count()), level);
    }
  });
}

}  // namespace limen
