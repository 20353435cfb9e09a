// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/voxel_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::int32_t kBlockBits = 3;
constexpr std::size_t kBlockCubes = 512;
constexpr double kMaxCubes = 1U << 28U;   // of the whole extent, one bit each
constexpr double kFreeMarginM = 0.6;      // rays count as free up to this far before their point
constexpr std::size_t kMaxRays = 400000;  // of a scan, evenly chosen, that free space

/// The extent of all but the strays: the lowest and highest thousandth are left out, half a metre is added.
Extent robust_extent(const std::vector<Vector3d>& points) {
  Extent extent;
  std::vector<double> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 20000)
      values.push_back(points[i][axis]);
    std::sort(values.begin(), values.end());
    extent.low[axis] = values[values.size() / 1000] - 0.5;
    extent.high[axis] = values[values.size() - 1 - values.size() / 1000] + 0.5;
  }
  return extent;
}

std::size_t words_for(std::size_t bits) {
  return (bits + 63) / 64;
}

std::size_t place_in_block(const std::array<std::int32_t, 3>& key) {
  return (static_cast<std::size_t>(key[2] & 7) << 6U) | (static_cast<std::size_t>(key[1] & 7) << 3U) |
         static_cast<std::size_t>(key[0] & 7);
}

}  // namespace

VoxelMap::VoxelMap(const Scan& scan, const Features& features) : facets_(facets_of(features)) {
  if (scan.size() == 0) return;
  const Extent extent = robust_extent(scan.points);
  low_ = extent.low;
  const Vector3d sides = extent.high - extent.low;
  const double volume = sides.prod();
  edge_ = std::max(edge_, std::cbrt(volume / kMaxCubes));
  per_m_ = 1.0 / edge_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = 1 + static_cast<std::int32_t>(sides[static_cast<Eigen::Index>(axis)] / edge_);
  }
  make_blocks();
  enter(features);
  if (scan.centre_known()) carve(scan, std::max(kFreeMarginM, 2.0 * edge_));
}

VoxelMap::VoxelMap(const VoxelMapState& state, const Features& features)
    : facets_(facets_of(features)), edge_(state.edge_m), low_(state.low), size_(state.size) {
  constexpr std::int32_t kMostCubes = 1 << 20;
  double stated = 1.0;
  for (const std::int32_t size : size_) stated *= size >= 0 && size <= kMostCubes ? size : 1e300;
  const bool fits =
      edge_ > 0 && stated <= 1e10 &&
      (state.free_bits.empty() || state.free_bits.size() == (static_cast<std::size_t>(stated) + 7) / 8);
  if (!fits) throw Error("the map of cubes does not fit its scan", "kept features", "have them made again");
  if (stated == 0.0) return;
  per_m_ = 1.0 / edge_;
  make_blocks();
  enter(features);
  if (state.free_bits.empty()) return;
  free_.assign(words_for(cubes()), 0);
  for (std::size_t k = 0; k < state.free_bits.size(); ++k)
    free_[k / 8] |= std::uint64_t{state.free_bits[k]} << (8 * (k % 8));
}

VoxelMapState VoxelMap::state() const {
  VoxelMapState state{edge_, low_, size_, {}};
  if (free_.empty()) return state;
  state.free_bits.resize((cubes() + 7) / 8);
  for (std::size_t k = 0; k < state.free_bits.size(); ++k)
    state.free_bits[k] = static_cast<std::uint8_t>(free_[k / 8] >> (8 * (k % 8)));
  return state;
}

void VoxelMap::make_blocks() {
  for (std::size_t axis = 0; axis < 3; ++axis) blocks_[axis] = (size_[axis] >> kBlockBits) + 1;
  block_at_.assign(static_cast<std::size_t>(blocks_[0]) * static_cast<std::size_t>(blocks_[1]) *
                       static_cast<std::size_t>(blocks_[2]),
                   -1);
}

VoxelMap::Key VoxelMap::key_of(const Vector3d& x) const {
  const auto cell = [&](Eigen::Index axis) {
    const double at = std::min(std::max((x[axis] - low_[axis]) * per_m_, -2.0), 1e6);
    const auto towards_zero = static_cast<std::int32_t>(at);
    return at < towards_zero ? towards_zero - 1 : towards_zero;
  };
  return {cell(0), cell(1), cell(2)};
}

std::int64_t VoxelMap::index_of(const Key& key) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (key[axis] < 0 || key[axis] >= size_[axis]) return -1;
  }
  return (static_cast<std::int64_t>(key[2]) * size_[1] + key[1]) * size_[0] + key[0];
}

std::size_t VoxelMap::block_of(const Key& key) const {
  return (static_cast<std::size_t>(key[2] >> kBlockBits) * static_cast<std::size_t>(blocks_[1]) +
          static_cast<std::size_t>(key[1] >> kBlockBits)) *
             static_cast<std::size_t>(blocks_[0]) +
         static_cast<std::size_t>(key[0] >> kBlockBits);
}

const VoxelMap::Cube* VoxelMap::find(const Key& key) const {
  const std::int32_t block = block_at_[block_of(key)];
  if (block < 0) return nullptr;
  const std::int32_t cube = cube_at_[static_cast<std::size_t>(block) * kBlockCubes + place_in_block(key)];
  return cube < 0 ? nullptr : &cubes_[static_cast<std::size_t>(cube)];
}

VoxelMap::Cube& VoxelMap::obtain(const Key& key) {
  std::int32_t& block = block_at_[block_of(key)];
  if (block < 0) {
    block = static_cast<std::int32_t>(cube_at_.size() / kBlockCubes);
    cube_at_.resize(cube_at_.size() + kBlockCubes, -1);
  }
  std::int32_t& cube = cube_at_[static_cast<std::size_t>(block) * kBlockCubes + place_in_block(key)];
  if (cube < 0) {
    cube = static_cast<std::int32_t>(cubes_.size());
    cubes_.emplace_back();
  }
  return cubes_[static_cast<std::size_t>(cube)];
}

void VoxelMap::enter(const Features& features) {
  const auto add_plane = [](Cube& cube, std::int32_t plane) {
    for (std::int32_t& slot : cube.planes) {
      if (slot == plane) return;
      if (slot < 0) {
        slot = plane;
        return;
      }
    }
  };
  for (const SurfaceSample& sample : features.samples) {
    const Key at = key_of(sample.mean);
    for (std::int32_t step = 0; step < 27; ++step) {
      const Key key{at[0] + step % 3 - 1, at[1] + step / 3 % 3 - 1, at[2] + step / 9 - 1};
      if (index_of(key) < 0) continue;
      Cube& cube = obtain(key);
      if (sample.plane >= 0) {
        add_plane(cube, sample.plane);
      } else if (step == 13) {
        cube.clutter = true;
      }
    }
  }
}

std::size_t VoxelMap::cubes() const {
  return static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
         static_cast<std::size_t>(size_[2]);
}

void VoxelMap::carve(const Scan& scan, double margin_m) {
  constexpr std::size_t kRaysPerPiece = 4096;
  free_.assign(words_for(cubes()), 0);
  const std::size_t step = 1 + scan.size() / kMaxRays;
  parallel_for((scan.size() + step - 1) / step, kRaysPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vector3d& centre = scan.centre(k * step);
      const Vector3d ray = scan.points[k * step] - centre;
      const double range = ray.norm();
      if (range > margin_m) carve_ray(centre, scan.points[k * step] - ray * (margin_m / range));
    }
  });
}

/// Rays of several threads may pass one cube; which of them says so is all one.
void VoxelMap::carve_ray(const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm();
  const auto steps = static_cast<int>(length / (0.5 * edge_));
  const Vector3d start = (from - low_) / edge_;
  const Vector3d stride = (to - from) / (edge_ * std::max(1, steps));
  const Vector3d end(size_[0], size_[1], size_[2]);
  std::int64_t last = -1;
  for (int k = 0; k <= steps; ++k) {
    const Vector3d x = start + static_cast<double>(k) * stride;
    const bool inside =
        x[0] >= 0.0 && x[1] >= 0.0 && x[2] >= 0.0 && x[0] < end[0] && x[1] < end[1] && x[2] < end[2];
    if (!inside) continue;
    const std::int64_t index = index_of(
        {static_cast<std::int32_t>(x[0]), static_cast<std::int32_t>(x[1]), static_cast<std::int32_t>(x[2])});
    if (index == last) continue;
    last = index;
    const std::uint64_t bit = std::uint64_t{1} << (static_cast<std::uint64_t>(index) % 64);
    const std::atomic_ref<std::uint64_t> word(free_[static_cast<std::size_t>(index) / 64]);
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }
}

bool VoxelMap::is_free(const Vector3d& x) const {
  return is_free_at(index_of(key_of(x)));
}

bool VoxelMap::is_free_at(std::int64_t index) const {
  return !free_.empty() && index >= 0 &&
         (free_[static_cast<std::size_t>(index) / 64] >> (index % 64) & 1U) != 0;
}

bool VoxelMap::passed_freely(const SightQuery& query) const {
  if (!is_free(query.at)) return false;
  // A ray that grazes a surface frees the cube it is in, but not the cubes on both sides of it.
  if (!query.of_clutter()) {
    return is_free(query.at + edge_ * query.normal) && is_free(query.at - edge_ * query.normal);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = edge_ * Vector3d::Unit(axis);
    if (!is_free(query.at + step) || !is_free(query.at - step)) return false;
  }
  return true;
}

Sight VoxelMap::look(const SightQuery& query) const {
  const Key key = key_of(query.at);
  return index_of(key) < 0 ? Sight{} : look_in(find(key), query);
}

void VoxelMap::find_all(std::span<const Key> keys, std::span<const Cube*> cubes) const {
  // One step of the way to a cube at a time, for all places: most of it is waiting for memory.
  constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
  std::array<std::size_t, kLookBatch> at;  // of the block, then of the cube in its block
  for (std::size_t k = 0; k < keys.size(); ++k) {
    at[k] = keys[k][0] >= 0 ? block_of(keys[k]) : kNowhere;
    if (at[k] != kNowhere) __builtin_prefetch(&block_at_[at[k]]);
  }
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::int32_t block = at[k] == kNowhere ? -1 : block_at_[at[k]];
    at[k] = block < 0 ? kNowhere : static_cast<std::size_t>(block) * kBlockCubes + place_in_block(keys[k]);
    if (block >= 0) __builtin_prefetch(&cube_at_[at[k]]);
  }
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::int32_t cube = at[k] == kNowhere ? -1 : cube_at_[at[k]];
    cubes[k] = cube < 0 ? nullptr : &cubes_[static_cast<std::size_t>(cube)];
    if (cube >= 0) __builtin_prefetch(cubes[k]);
  }
}

/// Of the i-th piece; outside the first number is -1. Written out: it is made millions of times.
VoxelMap::Key VoxelMap::key_at(const Rigid3& cubes_from_scan, const SurfaceColumns& asked,
                               std::size_t i) const {
  const double x = static_cast<double>(asked.x[i]);
  const double y = static_cast<double>(asked.y[i]);
  const double z = static_cast<double>(asked.z[i]);
  const Matrix3d& r = cubes_from_scan.rotation;
  const Vector3d& t = cubes_from_scan.translation;
  const std::array<double, 3> at{r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + t[0],
                                 r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + t[1],
                                 r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + t[2]};
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    inside = inside && at[axis] >= 0.0 && at[axis] < static_cast<double>(size_[axis]);
  if (!inside) return {-1, -1, -1};
  return {static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
          static_cast<std::int32_t>(at[2])};
}

void VoxelMap::look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                               const Rigid3& view_from_scan, const LookTolerances& tolerances,
                               Looks& looks) const {
  std::array<Key, kLookBatch> keys;
  std::array<const Cube*, kLookBatch> cubes;
  const Rigid3 cubes_from_scan{per_m_ * view_from_scan.rotation,
                               per_m_ * (view_from_scan.translation - low_)};
  for (std::size_t k = 0; k < size; ++k) keys[k] = key_at(cubes_from_scan, asked, begin + k);
  find_all({keys.data(), size}, {cubes.data(), size});
  std::fill_n(looks.kind.begin(), size, static_cast<std::int32_t>(SightKind::unseen));
  std::fill_n(looks.plane.begin(), size, -1);
  std::fill_n(looks.distance_m.begin(), size, 0.0F);
  for (std::size_t k = 0; k < size; ++k) {
    // Most places lie where nothing was measured.
    if (cubes[k] == nullptr && (keys[k][0] < 0 || !is_free_at(index_of(keys[k])))) continue;
    const Vector3d at = view_from_scan * asked.place(begin + k);
    const Sight sight = look_in(cubes[k], query_of(asked, begin + k, at, view_from_scan, tolerances));
    looks.kind[k] = static_cast<std::int32_t>(sight.kind);
    looks.plane[k] = sight.plane;
    looks.distance_m[k] = static_cast<float>(sight.distance_m);
  }
}

Sight VoxelMap::look_in(const Cube* found, const SightQuery& query) const {
  if (found == nullptr) {
    return {passed_freely(query) ? SightKind::free : SightKind::unseen, -1, 0.0};
  }
  Sight best;
  double nearest = query.surface_m;
  for (const std::int32_t plane : found->planes) {
    if (plane < 0) break;
    const std::optional<double> distance = distance_if_same(query, facets_[static_cast<std::size_t>(plane)]);
    if (!distance || std::abs(*distance) > nearest) continue;
    nearest = std::abs(*distance);
    best = {SightKind::surface, plane, *distance};
  }
  if (best.kind == SightKind::unseen && query.of_clutter() && found->clutter) {
    best = {SightKind::surface, -1, 0.0};
  }
  return best;
}

}  // namespace limen
