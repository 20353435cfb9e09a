// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/sample_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

constexpr int kSubtiles = 4;  // per tile edge: their occupancy gives the area

/// Sum of the points of one tile or cube.
struct Tile {
  std::int64_t key = 0;
  std::uint32_t occupied = 0;  // bit per sub-tile
  double count = 0;
  Vector3d sum = Vector3d::Zero();
};

std::int64_t key_of(double u, double v, double w) {
  const auto part = [](double x) { return static_cast<std::int64_t>(std::floor(x)) & 0x1fffff; };
  return (part(w) << 42) | (part(v) << 21) | part(u);
}

/// Means per key; `keyed` is sorted, so the order is that of the keys.
std::vector<Tile> tiles_of(const Scan& scan, std::vector<std::pair<std::int64_t, std::uint32_t>>& keyed,
                           const std::vector<std::uint8_t>& sub) {
  std::vector<std::uint32_t> at(keyed.size());
  for (std::uint32_t k = 0; k < at.size(); ++k) at[k] = k;
  std::sort(at.begin(), at.end(), [&](std::uint32_t a, std::uint32_t b) { return keyed[a] < keyed[b]; });
  std::vector<Tile> tiles;
  for (const std::uint32_t k : at) {
    if (tiles.empty() || tiles.back().key != keyed[k].first) tiles.push_back({keyed[k].first});
    Tile& tile = tiles.back();
    tile.count += 1;
    tile.sum += scan.points[keyed[k].second];
    if (!sub.empty()) tile.occupied |= 1U << sub[k];
  }
  return tiles;
}

std::vector<SurfaceSample> plane_samples(const Scan& scan, const PlanarPolygon& plane, std::int32_t index,
                                         const std::vector<std::uint32_t>& points, double tile_m) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> keyed;
  std::vector<std::uint8_t> sub;
  keyed.reserve(points.size());
  sub.reserve(points.size());
  for (const std::uint32_t i : points) {
    const Vector2d p = plane.frame.to_plane(scan.points[i]) / tile_m;
    keyed.emplace_back(key_of(p.x(), p.y(), 0), i);
    const auto fine = [](double x) {
      return std::min(kSubtiles - 1, static_cast<int>((x - std::floor(x)) * kSubtiles));
    };
    sub.push_back(static_cast<std::uint8_t>(fine(p.y()) * kSubtiles + fine(p.x())));
  }
  std::vector<SurfaceSample> samples;
  for (const Tile& tile : tiles_of(scan, keyed, sub)) {
    const double share = std::popcount(tile.occupied) / static_cast<double>(kSubtiles * kSubtiles);
    samples.push_back({tile.sum / tile.count, plane.plane.normal, index,
                       static_cast<float>(share * tile_m * tile_m), static_cast<float>(tile.count)});
  }
  return samples;
}

std::vector<SurfaceSample> clutter_samples(const Scan& scan, const std::vector<std::int32_t>& labels,
                                           double cube_m) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> keyed;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    if (labels[i] >= 0) continue;
    const Vector3d p = scan.points[i] / cube_m;
    keyed.emplace_back(key_of(p.x(), p.y(), p.z()), i);
  }
  std::vector<SurfaceSample> samples;
  for (const Tile& tile : tiles_of(scan, keyed, {})) {
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
  std::vector<std::vector<SurfaceSample>> parts(planes.size() + 1);
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
