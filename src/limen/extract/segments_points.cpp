// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments_points.h"

#include <cmath>

#include "limen/base/parallel.h"

namespace limen {
namespace {

/// The nearest plane that the point lies on, among its points; -1: none.
std::int32_t plane_about(const Vector3d& x, const std::vector<Plane>& planes, double threshold_m,
                         const std::vector<std::unique_ptr<PlaneImage>>& images) {
  std::int32_t best = -1;
  double least = threshold_m;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const double distance = std::abs(planes[k].signed_distance(x));
    if (distance >= least || !images[k]->covered(images[k]->frame().to_plane(x))) continue;
    least = distance;
    best = static_cast<std::int32_t>(k);
  }
  return best;
}

}  // namespace

std::vector<std::int32_t> completed_labels(const Scan& scan, const ExtractedFeatures& extracted,
                                           const std::vector<std::unique_ptr<PlaneImage>>& images) {
  constexpr std::size_t kGrain = 16384;
  std::vector<Plane> planes;
  for (const PlanarPolygon& polygon : extracted.features.planes) planes.push_back(polygon.plane);
  std::vector<std::int32_t> labels = extracted.labels;
  parallel_for(labels.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (labels[i] >= 0) continue;
      labels[i] = plane_about(scan.points[i], planes, extracted.features.inlier_threshold_m, images);
    }
  });
  return labels;
}

}  // namespace limen
