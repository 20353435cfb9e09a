// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/cells/point_normals.h"

#include <numeric>

#include "limen/extract/cells/cell_grid.h"

namespace limen {
namespace {

constexpr std::uint32_t kEnough = 12;  // points in a cube
constexpr double kFlat = 4.0;          // times its thickness that a cube's points must spread
constexpr double kUneven = 0.4;        // of the thickness allowed
constexpr double kWide = 0.12;         // of the cube's edge that they must spread

}  // namespace

PointNormals::PointNormals(const MortonOrder& sorted, double max_thickness_m, double finest_m,
                           double coarsest_m)
    : of_point_(sorted.points.size(), kSparse) {
  std::vector<std::uint32_t> open(sorted.points.size());
  std::iota(open.begin(), open.end(), 0U);
  const int coarsest = level_of(coarsest_m, sorted.cell_m);
  for (int level = level_of(finest_m, sorted.cell_m); level <= coarsest && !open.empty(); ++level) {
    const CellGrid grid(sorted, open, level);
    std::vector<std::uint32_t> left;
    for (const Cell& cell : grid.cells()) {
      const bool enough = cell.count() >= kEnough;
      const bool flat = enough && cell.thickness_m <= max_thickness_m &&
                        cell.unevenness_m <= kUneven * max_thickness_m &&
                        cell.spread_m >= kFlat * cell.thickness_m && cell.spread_m >= kWide * grid.edge_m();
      for (std::uint32_t k = cell.begin; k < cell.end; ++k) {
        if (flat) of_point_[open[k]] = static_cast<std::int32_t>(normals_.size());
        if (!flat && enough) of_point_[open[k]] = kRough;
      }
      if (flat) {
        normals_.push_back(cell.normal);
      } else {
        left.insert(left.end(), open.begin() + cell.begin, open.begin() + cell.end);
      }
    }
    open = std::move(left);
  }
}

}  // namespace limen
