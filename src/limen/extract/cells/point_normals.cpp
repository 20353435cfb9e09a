// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/point_normals.h"

#include <cmath>
#include <numeric>
#include <span>

#include "limen/base/parallel.h"
#include "limen/extract/cells/cell_grid.h"
#include "limen/extract/cells/cell_runs.h"

namespace limen {
namespace {

constexpr std::uint32_t kEnoughPoints = 12;  // points in a cube
constexpr double kFlat = 4.0;                // times its thickness that a cube's points must spread
constexpr double kUneven = 0.4;              // of the thickness allowed
constexpr double kWide = 0.12;               // of the cube's edge that they must spread

/// A cube with enough points, and whether they make a plane.
struct LookedAt {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  bool flat = false;
  Vector3d normal = Vector3d::Zero();
};

std::vector<LookedAt> cubes_with_enough(const MortonOrder& sorted, std::span<const std::uint32_t> open,
                                        int level) {
  std::vector<LookedAt> cubes;
  for_each_cell(sorted, open, level, [&](std::uint32_t begin, std::uint32_t end) {
    if (end - begin >= kEnoughPoints) cubes.push_back({begin, end});
  });
  return cubes;
}

}  // namespace

PointNormals::PointNormals(const MortonOrder& sorted, double max_thickness_m, double finest_m,
                           double coarsest_m)
    : of_point_(sorted.size(), kSparse) {
  std::vector<std::uint32_t> open(sorted.size());
  std::iota(open.begin(), open.end(), 0U);
  const int coarsest = level_of(coarsest_m, sorted.cell_m);
  for (int level = level_of(finest_m, sorted.cell_m); level <= coarsest && !open.empty(); ++level) {
    const double edge_m = sorted.cell_m * std::exp2(level);
    std::vector<LookedAt> cubes = cubes_with_enough(sorted, open, level);
    parallel_for(cubes.size(), 256, [&](std::size_t first, std::size_t last) {
      for (LookedAt& cube : std::span(cubes).subspan(first, last - first)) {
        const CellShape shape =
            shape_of(sorted, std::span(open).subspan(cube.begin, cube.end - cube.begin), level);
        cube.normal = shape.normal;
        cube.flat = shape.thickness_m <= max_thickness_m && shape.unevenness_m <= kUneven * max_thickness_m &&
                    shape.spread_m >= kFlat * shape.thickness_m && shape.spread_m >= kWide * edge_m;
      }
    });
    std::size_t left = 0;
    std::uint32_t done = 0;
    const auto leave_open_until = [&](std::uint32_t end) {
      for (; done < end; ++done) open[left++] = open[done];
    };
    for (const LookedAt& cube : cubes) {
      leave_open_until(cube.begin);
      const std::int32_t found = cube.flat ? static_cast<std::int32_t>(normals_.size()) : kRough;
      for (std::uint32_t k = cube.begin; k < cube.end; ++k) of_point_[open[k]] = found;
      if (cube.flat) {
        normals_.push_back(cube.normal);
        done = cube.end;
      }
    }
    leave_open_until(static_cast<std::uint32_t>(open.size()));
    open.resize(left);
  }
}

}  // namespace limen
