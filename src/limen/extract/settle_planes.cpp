// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/settle_planes.h"

#include <algorithm>
#include <cmath>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/extract/cell_grid.h"

namespace limen {
namespace {

/// A plane with some points in a cube.
struct Support {
  std::int32_t plane = -1;
  std::uint32_t count = 0;
};

/// Planes by cube, those with most points first; cubes are runs of the curve.
class SupportGrid {
 public:
  SupportGrid(const MortonOrder& sorted, const std::vector<std::int32_t>& labels, int level,
              std::uint32_t min_support)
      : runs_(sorted, level), planes_(runs_.size()) {
    parallel_for(runs_.size(), 256, [&](std::size_t begin, std::size_t end) {
      std::vector<Support> support;
      for (std::size_t i = begin; i < end; ++i) {
        support.clear();
        for (std::uint32_t k = runs_.begin(i); k < runs_.end(i); ++k) count(labels[k], support);
        for (const Support& s : support) {
          if (s.count >= min_support) planes_[i].push_back(s.plane);
        }
      }
    });
  }

  [[nodiscard]] const CellRuns& runs() const { return runs_; }

  /// Planes in a cube and those around it, each once.
  void near(std::size_t cube, std::vector<std::int32_t>& planes) const {
    planes.clear();
    const auto add = [&](std::size_t i) {
      for (const std::int32_t plane : planes_[i]) {
        if (std::find(planes.begin(), planes.end(), plane) == planes.end()) planes.push_back(plane);
      }
    };
    add(cube);
    for (const std::int32_t i : runs_.neighbours(cube)) add(static_cast<std::size_t>(i));
  }

 private:
  static void count(std::int32_t label, std::vector<Support>& support) {
    if (label < 0) return;
    for (Support& s : support) {
      if (s.plane != label) continue;
      ++s.count;
      return;
    }
    support.push_back({label, 1});
  }

  CellRuns runs_;
  std::vector<std::vector<std::int32_t>> planes_;
};

}  // namespace

std::vector<std::int32_t> settled(const MortonOrder& sorted, const PointNormals& normals,
                                  const std::vector<std::int32_t>& labels, const std::vector<Plane>& planes,
                                  const SettleOptions& options) {
  const SupportGrid grid(sorted, labels, level_of(options.cell_m, sorted.cell_m), options.min_support);
  const double min_cosine = std::cos(radians(options.max_angle_deg));
  std::vector<std::int32_t> result = labels;
  const auto nearest = [&](std::uint32_t k, const std::vector<std::int32_t>& near) {
    const Vector3d* const normal = normals.at(k);
    const auto fits = [&](std::int32_t i) {
      return normal == nullptr ||
             std::abs(normal->dot(planes[static_cast<std::size_t>(i)].normal)) >= min_cosine;
    };
    // Far from the others of its plane a point keeps it, unless the surface there faces another way.
    std::int32_t best = labels[k] >= 0 && fits(labels[k]) ? labels[k] : -1;
    double smallest = options.threshold_m;
    for (const std::int32_t i : near) {
      const double d = std::abs(planes[static_cast<std::size_t>(i)].signed_distance(sorted.points[k]));
      if (d >= smallest || !fits(i)) continue;
      smallest = d;
      best = i;
    }
    return best;
  };
  parallel_for(grid.runs().size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      grid.near(i, near);
      if (near.empty()) continue;
      for (std::uint32_t k = grid.runs().begin(i); k < grid.runs().end(i); ++k) result[k] = nearest(k, near);
    }
  });
  return result;
}

}  // namespace limen
