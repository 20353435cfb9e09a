// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/sample_surface.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

constexpr int kSubtilesPerEdge = 4;  // per tile edge: their occupancy gives the area

/// Sum of the points of one tile or cube.
struct Tile {
  std::int64_t key = 0;
  std::uint32_t occupied = 0;  // bit per sub-tile
  double count = 0;
  Vector3d sum = Vector3d::Zero();
};

/// std::floor is a call where the processor's own is not presumed.
std::int64_t floor_of(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
}

std::int64_t key_of(std::int64_t u, std::int64_t v, std::int64_t w) {
  const auto part = [](std::int64_t x) { return x & 0x1fffff; };
  return (part(w) << 42) | (part(v) << 21) | part(u);
}

/// Sums points by key, each tile's in the order they come.
class Tiles {
 public:
  Tile& at(std::int64_t key) {
    // Neighbours along the curve mostly fall into the same tile.
    if (!tiles_.empty() && tiles_[last_].key == key) return tiles_[last_];
    const auto [found, fresh] = place_.try_emplace(key, static_cast<std::uint32_t>(tiles_.size()));
    if (fresh) tiles_.push_back({key});
    last_ = found->second;
    return tiles_[last_];
  }

  /// By key.
  [[nodiscard]] std::vector<Tile> sorted() && {
    std::sort(tiles_.begin(), tiles_.end(), [](const Tile& a, const Tile& b) { return a.key < b.key; });
    return std::move(tiles_);
  }

 private:
  std::vector<Tile> tiles_;
  std::unordered_map<std::int64_t, std::uint32_t> place_;
  std::size_t last_ = 0;
};

std::vector<SurfaceSample> plane_samples(const Scan& scan, const PlanarPolygon& plane, std::int32_t index,
                                         const std::vector<std::uint32_t>& points, double tile_m) {
  Tiles tiles;
  for (const std::uint32_t i : points) {
    const Vector2d p = plane.frame.to_plane(scan.points[i]) / tile_m;
    const std::int64_t u = floor_of(p.x());
    const std::int64_t v = floor_of(p.y());
    const auto fine = [](double x, std::int64_t whole) {
      return std::min(kSubtilesPerEdge - 1,
                      static_cast<int>((x - static_cast<double>(whole)) * kSubtilesPerEdge));
    };
    Tile& tile = tiles.at(key_of(u, v, 0));
    tile.count += 1;
    tile.sum += scan.points[i];
    tile.occupied |= 1U << static_cast<std::uint32_t>(fine(p.y(), v) * kSubtilesPerEdge + fine(p.x(), u));
  }
  std::vector<SurfaceSample> samples;
  for (const Tile& tile : std::move(tiles).sorted()) {
    const double share =
        std::popcount(tile.occupied) / static_cast<double>(kSubtilesPerEdge * kSubtilesPerEdge);
    samples.push_back({tile.sum / tile.count, plane.plane.normal, index,
                       static_cast<float>(share * tile_m * tile_m), static_cast<float>(tile.count)});
  }
  return samples;
}

std::vector<SurfaceSample> clutter_samples(const Scan& scan, const std::vector<std::int32_t>& labels,
                                           double cube_m) {
  Tiles tiles;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    if (labels[i] >= 0) continue;
    const Vector3d p = scan.points[i] / cube_m;
    Tile& tile = tiles.at(key_of(floor_of(p.x()), floor_of(p.y()), floor_of(p.z())));
    tile.count += 1;
    tile.sum += scan.points[i];
  }
  std::vector<SurfaceSample> samples;
  for (const Tile& tile : std::move(tiles).sorted()) {
    if (tile.count < 3) continue;  // lone points: mixed pixels, dust
    samples.push_back({tile.sum / tile.count, Vector3d::Zero(), -1, static_cast<float>(cube_m * cube_m),
                       static_cast<float>(tile.count)});
  }
  return samples;
}

}  // namespace

void SampleOptions::check() const {
  if (!(tile_m > 0)) throw_bad_option("tile_m", tile_m, "more than 0");
  if (!(clutter_m > 0)) throw_bad_option("clutter_m", clutter_m, "more than 0");
}

std::vector<SurfaceSample> sample_surface(const Scan& scan, const std::vector<std::int32_t>& labels,
                                          const std::vector<PlanarPolygon>& planes,
                                          const SampleOptions& options) {
  options.check();
  const std::vector<std::vector<std::uint32_t>> points = points_of(labels, planes.size());
  std::vector<std::vector<SurfaceSample>> parts(planes.size() + (options.clutter ? 1 : 0));
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      parts[k] = k < planes.size()
                     ? plane_samples(scan, planes[k], static_cast<std::int32_t>(k), points[k], options.tile_m)
                     : clutter_samples(scan, labels, options.clutter_m);
    }
  });
  std::vector<SurfaceSample> samples;
  for (const std::vector<SurfaceSample>& part : parts)
    samples.insert(samples.end(), part.begin(), part.end());
  return samples;
}

}  // namespace limen
