// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/panorama.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kPointsPerPixel = 2.0;

/// The smallest planes of more than a pixel can tell are clutter.
std::int16_t stated_plane(std::int32_t plane) {
  return plane <= std::numeric_limits<std::int16_t>::max() ? static_cast<std::int16_t>(plane)
                                                           : std::int16_t{-1};
}

std::vector<PanoramaFacet> seen_from(const Vector3d& centre, const std::vector<Facet>& facets) {
  std::vector<PanoramaFacet> seen;
  seen.reserve(facets.size() + 1);
  for (const Facet& facet : facets) {
    const Eigen::Vector3f normal = facet.plane.normal.cast<float>();
    seen.push_back({{normal.x(), normal.y(), normal.z()},
                    static_cast<float>(-facet.plane.signed_distance(centre)),
                    facet.oriented ? 1.0F : 0.0F});
  }
  seen.emplace_back();
  return seen;
}

}  // namespace

Panorama::Panorama(const Scan& scan, const std::vector<std::int32_t>& labels, const Features& features,
                   const Vector3d& centre)
    : facets_(facets_of(features)), seen_facets_(seen_from(centre, facets_)), centre_(centre) {
  const double wanted = std::sqrt(static_cast<double>(scan.size()) / (6.0 * kPointsPerPixel));
  edge_ = static_cast<std::size_t>(std::clamp(wanted, 24.0, 384.0));
  pixels_.resize(6 * edge_ * edge_);
  fill(scan, labels);
  erode();
}

Panorama::Panorama(const PanoramaState& state, const Features& features)
    : facets_(facets_of(features)),
      seen_facets_(seen_from(state.centre, facets_)),
      centre_(state.centre),
      edge_(state.edge) {
  const std::size_t count = state.near_m.size();
  const auto is_plane = [&](std::int32_t plane) {
    return plane >= -1 && plane < static_cast<std::int32_t>(facets_.size());
  };
  const bool fits = edge_ > 0 && edge_ < 100000 && count == 6 * edge_ * edge_ &&
                    state.far_m.size() == count && state.near_plane.size() == count &&
                    state.far_plane.size() == count &&
                    std::all_of(state.near_plane.begin(), state.near_plane.end(), is_plane) &&
                    std::all_of(state.far_plane.begin(), state.far_plane.end(), is_plane);
  if (!fits) throw Error("the panorama does not fit its scan", "kept features", "have them made again");
  pixels_.resize(count);
  for (std::size_t k = 0; k < count; ++k)
    pixels_[k] = {state.near_m[k], state.far_m[k], 0.0F, stated_plane(state.near_plane[k]),
                  stated_plane(state.far_plane[k])};
  erode();
}

PanoramaState Panorama::state() const {
  PanoramaState state;
  state.centre = centre_;
  state.edge = edge_;
  for (const PanoramaPixel& pixel : pixels_) {
    state.near_m.push_back(pixel.near_m);
    state.far_m.push_back(pixel.far_m);
    state.near_plane.push_back(pixel.near_plane);
    state.far_plane.push_back(pixel.far_plane);
  }
  return state;
}

std::size_t Panorama::pixel_at(const Vector3d& direction) const {
  // The face by the largest coordinate, the place on it by the two that follow in turn.
  std::size_t axis = 0;
  double largest = std::abs(direction.x());
  double across = direction.y();
  double up = direction.z();
  if (std::abs(direction.y()) > largest) {
    axis = 1;
    largest = std::abs(direction.y());
    across = direction.z();
    up = direction.x();
  }
  if (std::abs(direction.z()) > largest) {
    axis = 2;
    largest = std::abs(direction.z());
    across = direction.x();
    up = direction.y();
  }
  const double half = 0.5 * static_cast<double>(edge_);
  const double scale = half / largest;
  const auto cell = [&](double x) {
    return std::min(edge_ - 1, static_cast<std::size_t>(std::max(0.0, x * scale + half)));
  };
  const std::size_t face = 2 * axis + (direction[static_cast<Eigen::Index>(axis)] < 0 ? 1 : 0);
  return (face * edge_ + cell(across)) * edge_ + cell(up);
}

void Panorama::fill(const Scan& scan, const std::vector<std::int32_t>& labels) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d ray = scan.points[i] - centre_;
    const auto range = static_cast<float>(ray.norm());
    if (!(range > 0.01F)) continue;
    PanoramaPixel& pixel = pixels_[pixel_at(ray)];
    if (pixel.near_m == 0.0F || range < pixel.near_m) {
      pixel.near_m = range;
      pixel.near_plane = stated_plane(labels[i]);
    }
    if (range > pixel.far_m) {
      pixel.far_m = range;
      pixel.far_plane = stated_plane(labels[i]);
    }
  }
}

void Panorama::erode() {
  const auto n = static_cast<std::ptrdiff_t>(edge_);
  parallel_for(6 * edge_, edge_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const auto face = static_cast<std::ptrdiff_t>(row / edge_);
      const auto y = static_cast<std::ptrdiff_t>(row % edge_);
      for (std::ptrdiff_t x = 0; x < n; ++x) {
        float clear = 1e30F;
        for (std::ptrdiff_t v = std::max<std::ptrdiff_t>(0, y - 1); v <= std::min(n - 1, y + 1); ++v) {
          for (std::ptrdiff_t u = std::max<std::ptrdiff_t>(0, x - 1); u <= std::min(n - 1, x + 1); ++u) {
            const float near = pixels_[static_cast<std::size_t>((face * n + v) * n + u)].near_m;
            if (near > 0.0F) clear = std::min(clear, near);
          }
        }
        pixels_[row * edge_ + static_cast<std::size_t>(x)].clear_m = clear < 1e30F ? clear : 0.0F;
      }
    }
  });
}

bool Panorama::on_surface(const SightQuery& query, double range, const PanoramaPixel& pixel,
                          Sight& sight) const {
  const auto test = [&](float measured, std::int32_t plane) {
    const double off = range - static_cast<double>(measured);
    if (plane < 0) {
      if (!query.of_clutter() || std::abs(off) > query.surface_m) return false;
      sight = {SightKind::surface, -1, off};
      return true;
    }
    // The plane must have been measured near here, not only somewhere else along it.
    if (std::abs(off) > 0.3 + 0.03 * range) return false;
    const std::optional<double> distance = distance_if_same(query, facets_[static_cast<std::size_t>(plane)]);
    if (!distance) return false;
    sight = {SightKind::surface, plane, *distance};
    return true;
  };
  return test(pixel.near_m, pixel.near_plane) ||
         (pixel.far_plane != pixel.near_plane && test(pixel.far_m, pixel.far_plane));
}

Sight Panorama::look_at(const SightQuery& query, double range, const PanoramaPixel& pixel) const {
  Sight sight;
  if (range < 0.05) return {SightKind::free, -1, 0.0};
  if (pixel.clear_m == 0.0F) return sight;
  if (pixel.near_m > 0.0F && on_surface(query, range, pixel, sight)) return sight;
  if (range < pixel.clear_m - query.free_m) return {SightKind::free, -1, 0.0};
  if (pixel.near_m > 0.0F && range > pixel.far_m) return {SightKind::hidden, -1, 0.0};
  return sight;
}

Sight Panorama::look(const SightQuery& query) const {
  const Vector3d ray = query.at - centre_;
  return look_at(query, ray.norm(), pixels_[pixel_at(ray)]);
}

void Panorama::look_at_surface(const SurfaceColumns& asked, std::size_t begin, std::size_t size,
                               const Rigid3& view_from_scan, const LookTolerances& tolerances,
                               Looks& looks) const {
  PanoramaLook look;
  look.pixels = pixels_.data();
  look.facets = seen_facets_.data();
  look.edge = static_cast<std::int32_t>(edge_);
  const Vector3d shift = view_from_scan.translation - centre_;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    for (std::size_t column = 0; column < 3; ++column)
      look.rotation[3 * row + column] =
          static_cast<float>(view_from_scan.rotation(i, static_cast<Eigen::Index>(column)));
    look.shift[row] = static_cast<float>(shift[i]);
  }
  look.surface_m = static_cast<float>(tolerances.surface_m);
  look.clutter_m = static_cast<float>(tolerances.clutter_m);
  look.free_m = static_cast<float>(tolerances.free_m);
  limen::look_at_surface(look, asked, begin, size, looks);
}

}  // namespace limen
