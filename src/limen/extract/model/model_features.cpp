// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/model_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/progress.h"
#include "limen/extract/model/model_edges.h"
#include "limen/extract/model/model_surface.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr int kSubtiles = 4;            // per tile edge: those inside give area and mean
constexpr double kLeastPlaneM2 = 0.05;  // smaller pieces of surface make edges only
constexpr float kExact = 1e6F;          // points that a sample of a model is worth
constexpr double kDrawnSigmaM = 0.005;  // by how much an opening is built otherwise than drawn
constexpr double kInWallM = 0.01;
constexpr double kMostModelTiles = 3.2e7;  // of 0.25 m on the largest surface that is believed, 2e6 m2

/// One line of a polygon that is asked from left to right: which places on it lie inside.
class LineAcross {
 public:
  LineAcross(const Polygon& polygon, double y) : crossings_(crossings(polygon, y)) {}

  /// `x`: no less than before.
  [[nodiscard]] bool contains(double x) {
    while (passed_ < crossings_.size() && crossings_[passed_] <= x) ++passed_;
    return (crossings_.size() - passed_) % 2 == 1;
  }

  /// The first place inside that is no less than `x`; infinite where there is none.
  [[nodiscard]] double next_inside(double x) {
    if (contains(x)) return x;
    return passed_ < crossings_.size() ? crossings_[passed_] : std::numeric_limits<double>::infinity();
  }

 private:
  std::vector<double> crossings_;
  std::size_t passed_ = 0;
};

std::vector<SurfaceSample> samples_of(const PlanarPolygon& polygon, std::int32_t index, double tile_m) {
  const Box2 box = box_of(polygon.parts);
  const double step = tile_m / kSubtiles;
  std::vector<SurfaceSample> samples;
  const auto first = [&](double x) { return std::floor(x / tile_m); };
  for (double row = first(box.low.y()); row * tile_m < box.high.y(); ++row) {
    CancelScope::check();
    std::vector<LineAcross> lines;
    const auto height = [&](int below) { return row * tile_m + (below + 0.5) * step; };
    for (int below = 0; below < kSubtiles; ++below) lines.emplace_back(polygon.parts.front(), height(below));
    for (double column = first(box.low.x()); column * tile_m < box.high.x(); ++column) {
      double next = std::numeric_limits<double>::infinity();
      for (LineAcross& line : lines) next = std::min(next, line.next_inside(column * tile_m));
      if (std::isinf(next)) break;
      column = std::max(column, first(next));
      Vector2d sum = Vector2d::Zero();
      int inside = 0;
      for (int k = 0; k < kSubtiles * kSubtiles; ++k) {
        const int below = k / kSubtiles;
        const int beside = k % kSubtiles;
        const Vector2d p(column * tile_m + (beside + 0.5) * step, height(below));
        if (!lines[static_cast<std::size_t>(below)].contains(p.x())) continue;
        sum += p;
        ++inside;
      }
      if (inside == 0) continue;
      samples.push_back({polygon.frame.to_space(sum / inside), polygon.plane.normal, index,
                         static_cast<float>(inside * step * step), kExact});
    }
  }
  return samples;
}

/// Throws Error where tiles over the planes and along their outlines would be too many.
void require_few_tiles(double tile_m, const Features& features, const std::string& name) {
  double tiles = 0.0;
  for (const PlanarPolygon& plane : features.planes)
    tiles += plane.area_m2 / (tile_m * tile_m) + outline_length(plane.parts.front()) / tile_m;
  if (tiles <= 2.0 * kMostModelTiles) return;
  throw Error(fmt::format("tiles of {} m are too many for its surface", tile_m), name,
              "take larger tiles, or check the unit of the file");
}

void add_samples(double tile_m, Features& features) {
  std::vector<std::vector<SurfaceSample>> found(features.planes.size());
  parallel_for(features.planes.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      found[i] = samples_of(features.planes[i], static_cast<std::int32_t>(i), tile_m);
  });
  for (const std::vector<SurfaceSample>& samples : found)
    features.samples.insert(features.samples.end(), samples.begin(), samples.end());
}

/// The polygon in whose plane the rectangle lies and whose outline surrounds or touches it; -1: none.
int wall_of(const Vector3d (&corners)[4], const Vector3d& normal, const Features& features) {
  const Vector3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  for (std::size_t i = 0; i < features.planes.size(); ++i) {
    const PlanarPolygon& wall = features.planes[i];
    if (wall.plane.normal.dot(normal) < 0.999) continue;
    if (std::abs(wall.plane.signed_distance(middle)) > kInWallM) continue;
    const Box2 box = box_of(wall.parts);
    for (const Vector3d& corner : corners) {
      const Vector2d p = wall.frame.to_plane(corner);
      if ((p.array() >= box.low.array() - kInWallM).all() && (p.array() <= box.high.array() + kInWallM).all())
        return static_cast<int>(i);
    }
  }
  return -1;
}

void add_opening(const Vector3d (&corners)[4], const Vector3d& normal, double thickness_m,
                 Features& features) {
  Opening opening;
  for (std::size_t k = 0; k < 4; ++k) {
    opening.corners[k] = corners[k];
    opening.edge_sigma_m[k] = kDrawnSigmaM;
  }
  opening.facade = wall_of(corners, normal, features);
  if (opening.facade < 0) return;
  opening.evidence = 1;
  opening.reveal_depth_m = thickness_m;
  opening.reveal_sigma_m = kDrawnSigmaM;
  opening.reveal_complete = thickness_m > 0;
  features.openings.push_back(opening);
}

/// Both faces of every upright opening.
void add_openings(const BimModel& model, Features& features) {
  for (const BimOpening& opening : model.openings) {
    if (std::abs(opening.normal.z()) > 0.1) continue;
    add_opening(opening.corners, opening.normal, opening.thickness_m, features);
    const Vector3d through = -opening.thickness_m * opening.normal;
    // Seen from the other side left is right.
    const Vector3d behind[4] = {opening.corners[1] + through, opening.corners[0] + through,
                                opening.corners[3] + through, opening.corners[2] + through};
    add_opening(behind, -opening.normal, opening.thickness_m, features);
  }
}

}  // namespace

ModelFeatures model_features(const BimModel& model, double tile_m) {
  ModelSurface surface = visible_surface(model);
  ModelFeatures made;
  made.features.local_origin = model.local_origin;
  made.features.segments = sharp_edges(surface.polygons);
  for (std::size_t i = 0; i < surface.polygons.size(); ++i) {
    if (surface.polygons[i].area_m2 < kLeastPlaneM2) break;  // largest first
    made.features.planes.push_back(std::move(surface.polygons[i]));
    made.elements.push_back(surface.elements[i]);
  }
  require_few_tiles(tile_m, made.features, model.name);
  add_samples(tile_m, made.features);
  add_openings(model, made.features);
  return made;
}

}  // namespace limen
