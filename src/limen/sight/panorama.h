// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

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
  void look_all(std::span<const SightQuery> queries, std::span<Sight> sights) const override;
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
  [[nodiscard]] Sight look_at(const SightQuery& query, double range, const Pixel& pixel) const;
  void fill(const Scan& scan, const std::vector<std::int32_t>& labels);
  void erode();
  [[nodiscard]] bool on_surface(const SightQuery& query, double range, const Pixel& pixel,
                                Sight& sight) const;

  std::vector<Facet> facets_;
  Vector3d centre_;
  std::size_t edge_ = 0;  ///< pixels per cube edge
  std::vector<Pixel> pixels_;
};

}  // namespace limen
