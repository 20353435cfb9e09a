// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/panorama_look.h"

#include <cmath>

#include "limen/base/wide.h"
#include "limen/sight/space_view.h"

namespace limen {
namespace {

using Floats = std::array<float, kLookBatch>;
using Numbers = std::array<std::int32_t, kLookBatch>;

/// Between the steps of a look at one batch.
struct LookColumns {
  Floats ray_x, ray_y, ray_z;
  Floats range;
  Numbers pixel;
  Floats near_m, far_m, clear_m;
  Numbers near_plane, far_plane;
  Floats facet_x, facet_y, facet_z, facet_m, facet_oriented;  // of the near plane
  Numbers on_near;
};

/// Where the pieces lie from the centre, and in which pixel: as in Panorama::pixel_at().
LIMEN_WIDE void find_pixels(const PanoramaLook& look, const float* __restrict x, const float* __restrict y,
                            const float* __restrict z, std::size_t size, LookColumns& __restrict at) {
  const std::array<float, 9> r = look.rotation;
  const std::array<float, 3> t = look.shift;
  const float half = 0.5F * static_cast<float>(look.edge);
  const auto last = static_cast<float>(look.edge - 1);
  const std::int32_t edge = look.edge;
  for (std::size_t k = 0; k < size; ++k) {
    const float rx = r[0] * x[k] + r[1] * y[k] + r[2] * z[k] + t[0];
    const float ry = r[3] * x[k] + r[4] * y[k] + r[5] * z[k] + t[1];
    const float rz = r[6] * x[k] + r[7] * y[k] + r[8] * z[k] + t[2];
    const float ax = std::fabs(rx);
    const float ay = std::fabs(ry);
    const float az = std::fabs(rz);
    const bool by_y = ay > ax;
    const float larger = by_y ? ay : ax;
    const bool by_z = az > larger;
    const float largest = by_z ? az : larger;
    const float across = by_z ? rx : (by_y ? rz : ry);
    const float up = by_z ? ry : (by_y ? rx : rz);
    const float towards = by_z ? rz : (by_y ? ry : rx);
    const std::int32_t face = (by_z ? 4 : (by_y ? 2 : 0)) + (towards < 0.0F ? 1 : 0);
    const float scale = half / largest;
    float u = across * scale + half;
    float v = up * scale + half;
    u = u > 0.0F ? u : 0.0F;  // also where nothing is: 0 / 0
    v = v > 0.0F ? v : 0.0F;
    u = u < last ? u : last;
    v = v < last ? v : last;
    at.ray_x[k] = rx;
    at.ray_y[k] = ry;
    at.ray_z[k] = rz;
    at.range[k] = std::sqrt(rx * rx + ry * ry + rz * rz);
    at.pixel[k] = (face * edge + static_cast<std::int32_t>(u)) * edge + static_cast<std::int32_t>(v);
  }
}

/// From memory into columns: what cannot be done many at a time.
void fetch(const PanoramaLook& look, std::size_t size, LookColumns& __restrict at) {
  for (std::size_t k = 0; k < size; ++k) {
    const PanoramaPixel& pixel = look.pixels[at.pixel[k]];
    at.near_m[k] = pixel.near_m;
    at.far_m[k] = pixel.far_m;
    at.clear_m[k] = pixel.clear_m;
    at.near_plane[k] = pixel.near_plane;
    at.far_plane[k] = pixel.far_plane;
    const PanoramaFacet& facet = look.facets[pixel.near_plane < 0 ? 0 : pixel.near_plane];
    at.facet_x[k] = facet.normal[0];
    at.facet_y[k] = facet.normal[1];
    at.facet_z[k] = facet.normal[2];
    at.facet_m[k] = facet.distance_m;
    at.facet_oriented[k] = facet.oriented;
  }
}

constexpr float kSameNormal = 0.94F;  // cosine, as in distance_if_same()

/// What is asked of one batch, from its first piece on.
struct AskedColumns {
  const float* nx;
  const float* ny;
  const float* nz;
  const std::int32_t* planar;
  const float* oriented;
};

constexpr auto kUnseen = static_cast<std::int32_t>(SightKind::unseen);
constexpr auto kFree = static_cast<std::int32_t>(SightKind::free);
constexpr auto kSurface = static_cast<std::int32_t>(SightKind::surface);
constexpr auto kHidden = static_cast<std::int32_t>(SightKind::hidden);

/// As Panorama::look_at(), of the nearer return alone; `on_near` tells where it was met, or need not be.
LIMEN_WIDE void look_near(const PanoramaLook& look, const AskedColumns& asked, std::size_t size,
                          LookColumns& __restrict at, Looks& __restrict looks) {
  const std::array<float, 9> r = look.rotation;
  const float surface_m = look.surface_m;
  const float clutter_m = look.clutter_m;
  const float free_m = look.free_m;
  for (std::size_t k = 0; k < size; ++k) {
    const std::int32_t planar = asked.planar[k];
    const float range = at.range[k];
    const float near = at.near_m[k];
    const float off = range - near;
    const float plane_off = at.facet_x[k] * at.ray_x[k] + at.facet_y[k] * at.ray_y[k] +
                            at.facet_z[k] * at.ray_z[k] - at.facet_m[k];
    const float nx = r[0] * asked.nx[k] + r[1] * asked.ny[k] + r[2] * asked.nz[k];
    const float ny = r[3] * asked.nx[k] + r[4] * asked.ny[k] + r[5] * asked.nz[k];
    const float nz = r[6] * asked.nx[k] + r[7] * asked.ny[k] + r[8] * asked.nz[k];
    const float along = nx * at.facet_x[k] + ny * at.facet_y[k] + nz * at.facet_z[k];
    const float cosine = asked.oriented[k] * at.facet_oriented[k] != 0.0F ? along : std::fabs(along);
    const float tolerance = planar != 0 ? surface_m : clutter_m;
    const bool of_plane = at.near_plane[k] >= 0;
    const float distance = of_plane ? plane_off : off;
    // A plane must have been measured near here, not only somewhere else along it.
    const float reach = of_plane ? 0.3F + 0.03F * range : (planar != 0 ? -1.0F : tolerance);
    const float least_cosine = (of_plane && planar != 0) ? kSameNormal : -1.0F;
    std::int32_t met = std::fabs(distance) <= tolerance ? 1 : 0;
    met = std::fabs(off) <= reach ? met : 0;
    met = cosine >= least_cosine ? met : 0;
    met = near > 0.0F ? met : 0;
    met = range < 0.05F ? 0 : met;
    std::int32_t kind = range > at.far_m[k] ? kHidden : kUnseen;
    kind = near > 0.0F ? kind : kUnseen;
    kind = range < at.clear_m[k] - free_m ? kFree : kind;  // nothing around: clear_m is 0
    kind = met != 0 ? kSurface : kind;
    kind = range < 0.05F ? kFree : kind;
    std::int32_t settled = at.far_plane[k] == at.near_plane[k] ? 1 : met;
    settled = near > 0.0F ? settled : 1;
    settled = range < 0.05F ? 1 : settled;
    looks.kind[k] = kind;
    looks.plane[k] = met != 0 ? at.near_plane[k] : -1;
    looks.distance_m[k] = distance;
    at.on_near[k] = settled;
  }
}

/// The farther return, where a pixel has one on another plane: of few pixels.
void look_far(const PanoramaLook& look, const AskedColumns& asked, std::size_t k, const LookColumns& at,
              Looks& looks) {
  const float range = at.range[k];
  const float off = range - at.far_m[k];
  const bool planar = asked.planar[k] != 0;
  const auto meet = [&](float distance) {
    looks.kind[k] = kSurface;
    looks.plane[k] = at.far_plane[k];
    looks.distance_m[k] = distance;
  };
  if (at.far_plane[k] < 0) {
    if (!planar && std::fabs(off) <= look.clutter_m) meet(off);
    return;
  }
  if (std::fabs(off) > 0.3F + 0.03F * range) return;
  const PanoramaFacet& facet = look.facets[at.far_plane[k]];
  const float distance = facet.normal[0] * at.ray_x[k] + facet.normal[1] * at.ray_y[k] +
                         facet.normal[2] * at.ray_z[k] - facet.distance_m;
  if (std::fabs(distance) > (planar ? look.surface_m : look.clutter_m)) return;
  if (planar) {
    const std::array<float, 9>& r = look.rotation;
    float along = 0.0F;
    for (std::size_t i = 0; i < 3; ++i)
      along += facet.normal[i] *
               (r[3 * i] * asked.nx[k] + r[3 * i + 1] * asked.ny[k] + r[3 * i + 2] * asked.nz[k]);
    const bool signed_normal = asked.oriented[k] != 0.0F && facet.oriented != 0.0F;
    if ((signed_normal ? along : std::fabs(along)) < kSameNormal) return;
  }
  meet(distance);
}

}  // namespace

void look_at_surface(const PanoramaLook& look, const SurfaceColumns& asked, std::size_t begin,
                     std::size_t size, Looks& looks) {
  LookColumns at;
  find_pixels(look, asked.x.data() + begin, asked.y.data() + begin, asked.z.data() + begin, size, at);
  for (std::size_t k = 0; k < size; ++k) {
    const PanoramaPixel* pixel = &look.pixels[at.pixel[k]];
    __builtin_prefetch(pixel);
  }
  fetch(look, size, at);
  const AskedColumns columns{asked.nx.data() + begin, asked.ny.data() + begin, asked.nz.data() + begin,
                             asked.planar.data() + begin, asked.oriented.data() + begin};
  look_near(look, columns, size, at, looks);
  for (std::size_t k = 0; k < size; ++k) {
    if (at.on_near[k] == 0) look_far(look, columns, k, at, looks);
  }
}

}  // namespace limen
