// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/sample_model.h"

#include <cmath>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/random.h"
#include "limen/extract/model/model_surface.h"
#include "limen/geometry/points_apart.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kTrialsPerPlace = 6.0;  // points tried per place that one could have
constexpr double kMostDarts = 2e7;       // points tried; more: Error

/// Darts thrown at the polygon's box, as many per area as `per_m2` says.
void throw_darts(const PlanarPolygon& polygon, double per_m2, RandomStream random, PointsApart& disks) {
  const Box2 box = box_of(polygon.parts);
  const Vector2d size = box.high - box.low;
  const auto darts = static_cast<std::size_t>(std::ceil(per_m2 * size.prod()));
  for (std::size_t k = 0; k < darts; ++k) {
    const double u = random.uniform();
    const double v = random.uniform();
    const Vector2d p = box.low + Vector2d(u * size.x(), v * size.y());
    if (contains(polygon.parts.front(), p)) disks.add(polygon.frame.to_space(p));
  }
}

}  // namespace

Scan sample_model(const BimModel& model, const ModelSamplingOptions& options) {
  const ModelSurface surface = visible_surface(model);
  const double per_m2 = kTrialsPerPlace / (options.spacing_m * options.spacing_m);
  double darts = 0.0;
  for (const PlanarPolygon& polygon : surface.polygons) {
    const Box2 box = box_of(polygon.parts);
    darts += per_m2 * (box.high - box.low).prod();
  }
  if (darts > kMostDarts) {
    throw Error(
        fmt::format("points at a spacing of {} m are too many for its surface", options.spacing_m),
        model.name,
        fmt::format("give a spacing of {:.2f} m or more", options.spacing_m * std::sqrt(darts / kMostDarts)));
  }
  PointsApart disks(options.spacing_m);
  for (std::size_t i = 0; i < surface.polygons.size(); ++i)
    throw_darts(surface.polygons[i], per_m2, RandomStream(options.seed, i), disks);
  Scan scan;
  scan.name = model.name;
  scan.local_origin = model.local_origin;
  scan.points = std::move(disks.points());
  scan.level = true;
  return scan;
}

std::vector<Segment> sampled_model_segments(const BimModel& model, const ModelSamplingOptions& sampling,
                                            const SegmentOptions& options) {
  const Scan scan = sample_model(model, sampling);
  return find_segments(scan, extract_features(scan), options);
}

}  // namespace limen
