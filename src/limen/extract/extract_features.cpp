// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/extract_features.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "limen/base/error.h"

namespace limen {
namespace {

/// Points behind the façades that belong to no plane yet, ascending.
std::vector<std::uint32_t> unlabelled(const std::vector<std::uint32_t>& points,
                                      const std::vector<std::int32_t>& labels) {
  std::vector<std::uint32_t> left;
  std::copy_if(points.begin(), points.end(), std::back_inserter(left),
               [&](std::uint32_t i) { return labels[i] < 0; });
  return left;
}

/// Planes most of whose points lie behind a façade are interior.
void mark_interior(std::vector<PlanarPolygon>& planes, const std::vector<std::uint32_t>& points,
                   const std::vector<std::int32_t>& labels) {
  std::vector<std::size_t> behind(planes.size(), 0);
  for (const std::uint32_t i : points) {
    if (labels[i] >= 0) ++behind[static_cast<std::size_t>(labels[i])];
  }
  for (std::size_t k = 0; k < planes.size(); ++k) planes[k].interior = 2 * behind[k] > planes[k].inliers;
}

/// The walls, the points behind them, and the planes among these that were too small for the whole scan.
void add_interior(const Scan& scan, const ExtractOptions& options, ExtractedFeatures& extracted,
                  Monitor& monitor) {
  Features& features = extracted.features;
  extracted.facades = find_facades(features.planes, Vector3d::UnitZ(),
                                   scan.mobile() ? options.interior.facades : options.interior.walls);
  if (extracted.facades.empty()) return;
  const std::vector<std::uint32_t> behind = point_indices(
      find_interior_points(scan, features.planes, extracted.facades, options.interior.points, monitor));
  extracted.interior_points = behind.size();
  const std::vector<std::uint32_t> left = unlabelled(behind, extracted.labels);
  GrowOptions grow = options.grow;
  grow.min_inliers = options.interior.min_inliers;
  grow.inlier_threshold_m = features.inlier_threshold_m;
  const Scan part = subset(scan, left);
  const GrownPlanes grown = grow_planes(part, grow, monitor);
  const auto first = static_cast<std::int32_t>(features.planes.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (grown.planes.labels[k] >= 0) extracted.labels[left[k]] = first + grown.planes.labels[k];
  }
  const std::vector<PlanarPolygon> planes = make_polygons(part, grown.planes, options.polygons, monitor);
  features.planes.insert(features.planes.end(), planes.begin(), planes.end());
  mark_interior(features.planes, behind, extracted.labels);
}

}  // namespace

void InteriorOptions::check() const {
  if (min_inliers < 3) throw_bad_option("interior min_inliers", min_inliers, "3 or more");
  facades.check();
  walls.check();
  points.check();
}

void ExtractOptions::check() const {
  grow.check();
  interior.check();
  polygons.check();
  samples.check();
}

ExtractedFeatures extract_features(const Scan& scan, const ExtractOptions& options, Monitor& monitor) {
  options.check();
  DetectedPlanes detected = detect_planes(scan, options.detect, options.grow, monitor);
  ExtractedFeatures extracted;
  Features& features = extracted.features;
  features.local_origin = scan.local_origin;
  features.noise_m = detected.noise_m;
  features.inlier_threshold_m = detected.planes.inlier_threshold_m;
  features.planes = make_polygons(scan, detected.planes, options.polygons, monitor);
  extracted.labels = std::move(detected.planes.labels);
  if (scan.centre_known() && options.interior.enabled) add_interior(scan, options, extracted, monitor);
  features.samples = sample_surface(scan, extracted.labels, features.planes, options.samples);
  return extracted;
}

void add_seen_through(const Scan& scan, const ExtractOptions& options, ExtractedFeatures& extracted,
                      Monitor& monitor) {
  add_interior(scan, options, extracted, monitor);
  Features& features = extracted.features;
  features.samples = sample_surface(scan, extracted.labels, features.planes, options.samples);
}

}  // namespace limen
