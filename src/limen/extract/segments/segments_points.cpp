// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_points.h"

#include <cmath>
#include <utility>

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

ExtractedFeatures with_small_planes(const Scan& scan, const ExtractedFeatures& extracted,
                                    std::vector<std::int32_t> labels, int min_points, Monitor& monitor) {
  ExtractedFeatures more;
  more.features.local_origin = extracted.features.local_origin;
  more.features.inlier_threshold_m = extracted.features.inlier_threshold_m;
  more.features.noise_m = extracted.features.noise_m;
  more.features.planes = extracted.features.planes;
  more.labels = std::move(labels);
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < more.labels.size(); ++i)
    if (more.labels[i] < 0) left.push_back(static_cast<std::uint32_t>(i));
  if (min_points < 3 || left.size() < static_cast<std::size_t>(min_points)) return more;
  const Scan part = subset(scan, left);
  GrowOptions grow;
  grow.inlier_threshold_m = extracted.features.inlier_threshold_m;
  grow.min_inliers = min_points;
  const PlaneLabels grown = grow_planes(part, grow, monitor).planes;
  const auto first = static_cast<std::int32_t>(more.features.planes.size());
  for (std::size_t k = 0; k < left.size(); ++k)
    if (grown.labels[k] >= 0) more.labels[left[k]] = first + grown.labels[k];
  for (PlanarPolygon& polygon : make_polygons(part, grown, {}, monitor))
    more.features.planes.push_back(std::move(polygon));
  return more;
}

}  // namespace limen
