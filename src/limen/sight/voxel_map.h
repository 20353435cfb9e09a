// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limen/sight/space_view.h"

namespace limen {

/// What a map of cubes knows beside the features, to be kept and taken back.
struct VoxelMapState {
  double edge_m = 0.25;  ///< of the cubes; grows where the scene is too large for the memory
  Vector3d low = Vector3d::Zero();
  std::array<std::int32_t, 3> size{0, 0, 0};  ///< cubes along each axis
  std::vector<std::uint8_t> free_bits;        ///< one bit per cube, empty where no ray freed any
};

/// Space in cubes, for scans that see from many places (mobile, several stations) or from an unknown one:
/// which surfaces were measured near a cube, and which cubes rays passed through. Coarser than a panorama,
/// and silent where it does not know: no ray of an unknown scanner position frees a cube.
class VoxelMap : public SpaceView {
 public:
  VoxelMap(const Scan& scan, const Features& features);
  /// The same map again; `features` are those it was made with. Throws Error where the sizes do not fit.
  VoxelMap(const VoxelMapState& state, const Features& features);

  [[nodiscard]] VoxelMapState state() const;
  [[nodiscard]] Sight look(const SightQuery& query) const override;
  void look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                       const Rigid3& view_from_scan, const LookTolerances& tolerances,
                       Looks& looks) const override;

 private:
  static constexpr std::size_t kPlanes = 4;
  /// What was measured in a cube or next to it.
  struct Cube {
    std::array<std::int32_t, kPlanes> planes{-1, -1, -1, -1};
    bool clutter = false;
  };

  using Key = std::array<std::int32_t, 3>;
  [[nodiscard]] Key key_of(const Vector3d& x) const;
  [[nodiscard]] std::int64_t index_of(const Key& key) const;  ///< -1 outside
  [[nodiscard]] std::size_t cubes() const;                    ///< of the whole extent
  [[nodiscard]] bool is_free(const Vector3d& x) const;
  [[nodiscard]] bool is_free_at(std::int64_t index) const;  ///< as index_of() says
  [[nodiscard]] bool passed_freely(const SightQuery& query) const;
  [[nodiscard]] std::size_t block_of(const Key& key) const;
  [[nodiscard]] const Cube* find(const Key& key) const;
  [[nodiscard]] Key key_at(const Rigid3& cubes_from_scan, const SurfaceColumns& asked, std::size_t i) const;
  /// The cubes of a batch of places; none where nothing was measured, or outside, where a key's first is -1.
  void find_all(std::span<const Key> keys, std::span<const Cube*> cubes) const;
  [[nodiscard]] Sight look_in(const Cube* found, const SightQuery& query) const;
  Cube& obtain(const Key& key);  ///< `key` lies inside
  void make_blocks();
  void enter(const Features& features);
  void carve(const Scan& scan, double margin_m);
  void carve_ray(const Vector3d& from, const Vector3d& to);

  std::vector<Facet> facets_;
  double edge_ = 0.25;
  double per_m_ = 4.0;  ///< cubes
  Vector3d low_ = Vector3d::Zero();
  Key size_{0, 0, 0};
  // Cubes with surface, found by blocks of 8 x 8 x 8: few of them hold any.
  Key blocks_{0, 0, 0};
  std::vector<std::int32_t> block_at_;  ///< number of the block in `cube_at_`, or -1
  std::vector<std::int32_t> cube_at_;   ///< 512 per block: index into `cubes_`, or -1
  std::vector<Cube> cubes_;
  std::vector<std::uint64_t> free_;  ///< one bit per cube; empty: no ray frees any
};

}  // namespace limen
