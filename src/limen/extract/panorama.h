// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/model/features.h"

namespace limen {

/// What a scanner knows of a place in space.
enum class SightKind : std::uint8_t {
  unseen,   ///< no ray came near
  free,     ///< rays passed through: nothing solid stood there
  surface,  ///< a surface was measured there
  hidden    ///< behind a measured surface
};

struct Sight {
  SightKind kind = SightKind::unseen;
  std::int32_t plane = -1;  ///< for surface: index of the plane it lies on, or -1 for clutter
  double distance_m = 0.0;  ///< for surface on a plane: signed distance to that plane
};

/// What is asked of a place: its surface, and the tolerances.
struct SightQuery {
  Vector3d at = Vector3d::Zero();      ///< about the scan's local origin
  Vector3d normal = Vector3d::Zero();  ///< of the surface asked for; zero: clutter, any surface will do
  bool oriented = false;               ///< the normal's sign counts
  double surface_m = 0.05;             ///< a surface nearer than this is the same surface
  double free_m = 0.10;                ///< solid matter is contradicted where rays passed this much beyond
};

/// The depth image of a static station on the six faces of a cube: answers in constant time what the scanner
/// saw at a place. Built from the points, their planes and the optical centre.
class Panorama {
 public:
  /// `labels[i]` is the plane of point i in `features.planes`.
  Panorama(const Scan& scan, const std::vector<std::int32_t>& labels, const Features& features,
           const Vector3d& centre);

  [[nodiscard]] Sight look(const SightQuery& query) const;
  [[nodiscard]] const Vector3d& centre() const { return centre_; }

 private:
  struct Pixel {
    float near_m = 0.0F;  ///< closest return; 0: none
    float far_m = 0.0F;
    float clear_m = 0.0F;  ///< closest return of the 3 x 3 pixels around: rays passed freely up to here
    std::int32_t near_plane = -1;
    std::int32_t far_plane = -1;
  };

  [[nodiscard]] std::size_t pixel_at(const Vector3d& direction) const;
  void fill(const Scan& scan, const std::vector<std::int32_t>& labels);
  void erode();
  [[nodiscard]] bool on_surface(const SightQuery& query, const Vector3d& ray, const Pixel& pixel,
                                Sight& sight) const;

  struct Facet {
    Plane plane;
    bool oriented = false;
  };
  std::vector<Facet> facets_;
  Vector3d centre_;
  std::size_t edge_ = 0;  ///< pixels per cube edge
  std::vector<Pixel> pixels_;
};

}  // namespace limen
