// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/sight/panorama_look.h"
#include "limen/sight/space_view.h"

namespace limen {

/// What a panorama knows beside the planes, to be kept and taken back: one entry per pixel in each list.
struct PanoramaState {
  Vector3d centre = Vector3d::Zero();
  std::uint64_t edge = 0;  ///< pixels per cube edge
  std::vector<float> near_m;
  std::vector<float> far_m;
  std::vector<std::int32_t> near_plane;
  std::vector<std::int32_t> far_plane;
};

/// The depth image of a static station on the six faces of a cube: answers in constant time what the scanner
/// saw at a place.
class Panorama : public SpaceView {
 public:
  /// `labels[i]` is the plane of point i in `features.planes`.
  Panorama(const Scan& scan, const std::vector<std::int32_t>& labels, const Features& features,
           const Vector3d& centre);
  /// The same panorama again; `features` are those it was made with. Throws Error where the lists do not fit.
  Panorama(const PanoramaState& state, const Features& features);

  [[nodiscard]] PanoramaState state() const;
  [[nodiscard]] Sight look(const SightQuery& query) const override;
  void look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                       const Rigid3& view_from_scan, const LookTolerances& tolerances,
                       Looks& looks) const override;
  [[nodiscard]] const Vector3d& centre() const { return centre_; }

 private:
  [[nodiscard]] std::size_t pixel_at(const Vector3d& direction) const;
  [[nodiscard]] Sight look_at(const SightQuery& query, double range, const PanoramaPixel& pixel) const;
  void fill(const Scan& scan, const std::vector<std::int32_t>& labels);
  void erode();
  [[nodiscard]] bool on_surface(const SightQuery& query, double range, const PanoramaPixel& pixel,
                                Sight& sight) const;

  std::vector<Facet> facets_;
  std::vector<PanoramaFacet> seen_facets_;  ///< the same from the centre; one more, so that there is one
  Vector3d centre_;
  std::size_t edge_ = 0;  ///< pixels per cube edge
  std::vector<PanoramaPixel> pixels_;
};

}  // namespace limen
