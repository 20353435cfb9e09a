// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/features/extract_features.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/base/ranked.h"
#include "limen/extract/planes/automatic_threshold.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

/// Which planes have most of their points behind walls.
std::vector<bool> mostly_behind(const std::vector<PlanarPolygon>& planes,
                                const std::vector<std::uint32_t>& points,
                                const std::vector<std::int32_t>& labels) {
  std::vector<std::size_t> behind(planes.size(), 0);
  for (const std::uint32_t i : points) {
    if (labels[i] >= 0) ++behind[static_cast<std::size_t>(labels[i])];
  }
  std::vector<bool> interior(planes.size());
  for (std::size_t k = 0; k < planes.size(); ++k) interior[k] = 2 * behind[k] > planes[k].inliers;
  return interior;
}

/// Takes the marked planes out: labels of their points become -1, all others move up.
void remove_planes(const std::vector<bool>& marked, ExtractedFeatures& extracted) {
  std::vector<std::int32_t> place(marked.size(), -1);
  std::vector<PlanarPolygon>& planes = extracted.features.planes;
  std::vector<PlanarPolygon> kept;
  for (std::size_t k = 0; k < marked.size(); ++k) {
    if (marked[k]) continue;
    place[k] = static_cast<std::int32_t>(kept.size());
    kept.push_back(std::move(planes[k]));
  }
  planes = std::move(kept);
  for (std::int32_t& label : extracted.labels) {
    if (label >= 0) label = place[static_cast<std::size_t>(label)];
  }
  for (int& facade : extracted.facades) facade = place[static_cast<std::size_t>(facade)];
}

/// Points behind the walls that belong to no plane, ascending.
std::vector<std::uint32_t> unlabelled(const std::vector<std::uint32_t>& points,
                                      const std::vector<std::int32_t>& labels) {
  std::vector<std::uint32_t> left;
  std::copy_if(points.begin(), points.end(), std::back_inserter(left),
               [&](std::uint32_t i) { return labels[i] < 0; });
  return left;
}

/// The walls, the points behind them, and the planes among these: found anew, as finely as the noise allows,
/// for there are few points and the relief of façades is not theirs.
void add_interior(const Scan& scan, const ExtractOptions& options, ExtractedFeatures& extracted,
                  Monitor& monitor) {
  Features& features = extracted.features;
  extracted.facades = find_facades(features.planes, Vector3d::UnitZ(),
                                   scan.mobile() ? options.interior.facades : options.interior.walls);
  if (extracted.facades.empty()) return;
  const std::vector<std::uint32_t> behind = point_indices(
      find_interior_points(scan, features.planes, extracted.facades, options.interior.points, monitor));
  std::vector<bool> marked = mostly_behind(features.planes, behind, extracted.labels);
  // A wall that others look through stays what it is.
  for (const int facade : extracted.facades) marked[static_cast<std::size_t>(facade)] = false;
  remove_planes(marked, extracted);
  const std::vector<std::uint32_t> left = unlabelled(behind, extracted.labels);
  const Scan part = subset(scan, left);
  GrowOptions grow = options.grow;
  grow.min_inliers = options.interior.min_inliers;
  StagePart choosing(monitor, 0.0, 0.5);
  if (scan.mobile()) {
    grow.inlier_threshold_m = std::min(features.inlier_threshold_m, noise_threshold(part, grow, choosing));
  } else {
    grow.inlier_threshold_m = features.inlier_threshold_m;
  }
  StagePart growing(monitor, 0.5, 1.0);
  PlaneLabels grown = grow_planes(part, grow, growing).planes;
  if (scan.mobile()) grown = split_planes(part, grown);
  const auto first = static_cast<std::int32_t>(features.planes.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (grown.labels[k] >= 0) extracted.labels[left[k]] = first + grown.labels[k];
  }
  std::vector<PlanarPolygon> planes = make_polygons(part, grown, options.polygons, monitor);
  for (PlanarPolygon& plane : planes) plane.interior = true;
  features.planes.insert(features.planes.end(), planes.begin(), planes.end());
}

/// A trajectory's error from how far the tiles of large planes stray from their planes, robustly, the noise
/// taken out. Walls show only what changes along them: on simulated drives with errors of a few waves per
/// street a quarter of it.
double drift_of(const Features& features) {
  constexpr double kLargeM2 = 10.0;
  constexpr double kHidden = 4.0;
  constexpr double kToSigma = 1.4826;  // median of |x| to standard deviation
  std::vector<double> off;
  std::vector<double> noise;
  for (const SurfaceSample& sample : features.samples) {
    if (sample.plane < 0) break;  // clutter follows
    const PlanarPolygon& plane = features.planes[static_cast<std::size_t>(sample.plane)];
    if (plane.area_m2 < kLargeM2 || sample.count < 4) continue;
    off.push_back(std::abs(plane.plane.signed_distance(sample.mean)));
    noise.push_back(features.noise_m / std::sqrt(static_cast<double>(sample.count)));
  }
  if (off.size() < 50) return 0.0;
  const double spread = kToSigma * median(off);
  const double expected = median(noise);
  return kHidden * std::sqrt(std::max(0.0, spread * spread - expected * expected));
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
  const CancelScope scope(monitor);
  // Shares of the work, about.
  constexpr double kDetected = 0.6;
  constexpr double kOutlined = 0.75;
  constexpr double kSeenThrough = 0.95;
  StagePart detecting(monitor, 0.0, kDetected);
  DetectedPlanes detected = detect_planes(scan, options.detect, options.grow, detecting);
  ExtractedFeatures extracted;
  Features& features = extracted.features;
  features.local_origin = scan.local_origin;
  features.noise_m = detected.noise_m;
  features.inlier_threshold_m = detected.planes.inlier_threshold_m;
  StagePart outlining(monitor, kDetected, kOutlined);
  features.planes = make_polygons(scan, detected.planes, options.polygons, outlining);
  extracted.labels = std::move(detected.planes.labels);
  StagePart seeing_through(monitor, kOutlined, kSeenThrough);
  if (scan.centre_known() && options.interior.enabled) add_interior(scan, options, extracted, seeing_through);
  monitor.advance(kSeenThrough, 1.0);
  features.samples = sample_surface(scan, extracted.labels, features.planes, options.samples);
  // A cloud without scanner positions may be of many stations, or of a scanner that moved.
  if (scan.mobile() || !scan.centre_known()) features.drift_m = drift_of(features);
  return extracted;
}

}  // namespace limen
