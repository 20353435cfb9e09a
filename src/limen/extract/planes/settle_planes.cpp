// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/settle_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/extract/cells/cell_grid.h"

namespace limen {

CubeCounts::CubeCounts(const CellRuns& runs, const std::vector<std::int32_t>& labels, double least)
    : begins_(runs.size() + 1, 0) {
  constexpr std::size_t kCubes = 1024;
  std::vector<std::vector<PlaneCount>> pieces((runs.size() + kCubes - 1) / kCubes);
  parallel_for(runs.size(), kCubes, [&](std::size_t begin, std::size_t end) {
    std::vector<PlaneCount>& piece = pieces[begin / kCubes];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = piece.size();
      for (std::uint32_t k = runs.begin(i); k < runs.end(i); ++k) {
        if (labels[k] >= 0) add_count(piece, before, {labels[k], 1.0});
      }
      piece.erase(std::remove_if(piece.begin() + static_cast<std::ptrdiff_t>(before), piece.end(),
                                 [&](const PlaneCount& it) { return it.count < least; }),
                  piece.end());
      begins_[i + 1] = piece.size() - before;
    }
  });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  counts_.reserve(begins_.back());
  for (const auto& piece : pieces) counts_.insert(counts_.end(), piece.begin(), piece.end());
}

namespace {

constexpr double kSettledDeg = 20.0;        // between a plane and the surface at a point
constexpr std::uint32_t kLeastSupport = 4;  // points of a plane in a cube that make it a candidate there

/// Planes by cube.
class SupportGrid {
 public:
  SupportGrid(const SettleGrid& grid, const std::vector<std::int32_t>& labels)
      : grid_(grid), counts_(grid.runs(), labels, kLeastSupport) {}

  [[nodiscard]] const CellRuns& runs() const { return grid_.runs(); }

  /// Planes in a cube and those around it, each once.
  void near(std::size_t cube, std::vector<std::int32_t>& planes) const {
    planes.clear();
    const auto add = [&](std::size_t i) {
      for (const PlaneCount& it : counts_.of(i)) {
        if (std::find(planes.begin(), planes.end(), it.plane) == planes.end()) planes.push_back(it.plane);
      }
    };
    add(cube);
    for (const std::int32_t i : grid_.around(cube)) add(static_cast<std::size_t>(i));
  }

 private:
  const SettleGrid& grid_;
  CubeCounts counts_;
};

/// Which planes a point may belong to.
class Candidates {
 public:
  Candidates(const SettleScene& scene, const std::vector<std::int32_t>& labels, std::vector<Plane> planes,
             const SettleOptions& options)
      : sorted_(scene.sorted),
        normals_(scene.normals),
        labels_(labels),
        planes_(std::move(planes)),
        grid_(scene.grid, labels),
        threshold_m_(options.threshold_m) {}

  [[nodiscard]] const SupportGrid& grid() const { return grid_; }
  [[nodiscard]] double distance(std::uint32_t k, std::int32_t plane) const {
    return std::abs(planes_[static_cast<std::size_t>(plane)].signed_distance(sorted_.point(k)));
  }
  /// The surface at point k faces along with the plane, as far as is known.
  [[nodiscard]] bool fits(std::uint32_t k, std::int32_t plane) const {
    const Vector3d* const normal = normals_.at(k);
    return normal == nullptr ||
           std::abs(normal->dot(planes_[static_cast<std::size_t>(plane)].normal)) >= min_cosine_;
  }
  [[nodiscard]] std::int32_t nearest(std::uint32_t k, const std::vector<std::int32_t>& near) const {
    // Far from the others of its plane a point keeps it, unless the surface there faces another way.
    const std::int32_t own = labels_[k];
    const bool own_fits = own >= 0 && fits(k, own);
    std::int32_t best = own_fits ? own : -1;
    if (near.size() == 1 && near.front() == own) return best;
    double smallest = threshold_m_;
    for (const std::int32_t i : near) {
      const double d = distance(k, i);
      if (d >= smallest || !(i == own ? own_fits : fits(k, i))) continue;
      smallest = d;
      best = i;
    }
    return best;
  }

 private:
  const MortonOrder& sorted_;
  const PointNormals& normals_;
  const std::vector<std::int32_t>& labels_;
  std::vector<Plane> planes_;
  SupportGrid grid_;
  double threshold_m_;
  double min_cosine_ = std::cos(radians(kSettledDeg));
};

std::vector<Plane> planes_of(const std::vector<PointMoments>& sums) {
  std::vector<Plane> planes;
  for (const PointMoments& sum : sums) planes.push_back(sum.count >= 3.0 ? fit_plane(sum).plane : Plane{});
  return planes;
}

}  // namespace

SettleGrid::SettleGrid(const MortonOrder& sorted, double cell_m)
    : runs_(sorted, level_of(cell_m, sorted.cell_m)), begins_(runs_.size() + 1, 0) {
  constexpr std::size_t kCubes = 4096;
  std::vector<std::vector<std::int32_t>> pieces((runs_.size() + kCubes - 1) / kCubes);
  parallel_for(runs_.size(), kCubes, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t>& piece = pieces[begin / kCubes];
    for (std::size_t i = begin; i < end; ++i) {
      const CellNeighbours near = runs_.neighbours(i);
      piece.insert(piece.end(), near.begin(), near.end());
      begins_[i + 1] = static_cast<std::size_t>(near.end() - near.begin());
    }
  });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  neighbours_.reserve(begins_.back());
  for (const auto& piece : pieces) neighbours_.insert(neighbours_.end(), piece.begin(), piece.end());
}

std::vector<double> explained_shares(const SettleScene& scene, const std::vector<std::int32_t>& labels,
                                     const std::vector<PointMoments>& sums, const SettleOptions& options) {
  const Candidates candidates(scene, labels, planes_of(sums), options);
  using Counts = std::vector<double>;
  Counts shares = parallel_reduce(
      candidates.grid().runs().size(), 8192, Counts(sums.size(), 0.0),
      [&](std::size_t begin, std::size_t end) {
        Counts counts(sums.size(), 0.0);
        std::vector<std::int32_t> near;
        for (std::size_t i = begin; i < end; ++i) {
          candidates.grid().near(i, near);
          for (std::uint32_t k = candidates.grid().runs().begin(i); k < candidates.grid().runs().end(i);
               ++k) {
            if (labels[k] < 0) continue;
            const auto own = static_cast<std::size_t>(labels[k]);
            counts[own] += std::any_of(near.begin(), near.end(), [&](std::int32_t other) {
              return sums[static_cast<std::size_t>(other)].count > sums[own].count &&
                     candidates.distance(k, other) < options.threshold_m && candidates.fits(k, other);
            });
          }
        }
        return counts;
      },
      [](Counts a, const Counts& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
        return a;
      });
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] /= std::max(1.0, sums[i].count);
  return shares;
}

std::vector<std::int32_t> settled(const SettleScene& scene, const std::vector<std::int32_t>& labels,
                                  const std::vector<PointMoments>& sums, const SettleOptions& options) {
  const Candidates candidates(scene, labels, planes_of(sums), options);
  const CellRuns& runs = candidates.grid().runs();
  std::vector<std::int32_t> result = labels;
  parallel_for(runs.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      candidates.grid().near(i, near);
      if (near.empty()) continue;
      for (std::uint32_t k = runs.begin(i); k < runs.end(i); ++k) result[k] = candidates.nearest(k, near);
    }
  });
  return result;
}

}  // namespace limen
