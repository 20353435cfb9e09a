// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/segments/segments_borders.h"
#include "limen/extract/segments/segments_creases.h"
#include "limen/extract/segments/segments_image.h"
#include "limen/extract/segments/segments_merge.h"
#include "limen/extract/segments/segments_sight.h"

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

/// The labels with those points taken in that belong to no plane though they lie on one, among its points:
/// near an edge the surface about a point is not flat, and plane detectors leave it out. `images` are those
/// of the labels.
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

/// The same scan's features with small planes added among the points of `labels` that have none: window
/// frames, the edges of doors, strips of wall, too small for the plane detector to tell from clutter. An edge
/// tells: what is no straight border of a surface is dropped later.
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

constexpr double kShortestRun = 0.5;  // of an outline, in units of the shortest segment
constexpr double kBeyond = 0.5;       // how far a border is looked for beyond its run, in units of the run
constexpr int kSmooth = 2;            // bins to either side that a place's sight is smoothed over
constexpr int kSmallPlane = 60;       // points of small planes that are looked for among those without one
const double kBorderAngleRad = radians(0.6);  // borders whose direction is known less well are left out

std::vector<std::unique_ptr<PlaneImage>> images_of(const Scan& scan, const std::vector<PlanarPolygon>& planes,
                                                   const std::vector<std::int32_t>& labels,
                                                   Monitor& monitor) {
  const std::vector<std::vector<std::uint32_t>> points = points_of(labels, planes.size());
  std::vector<std::unique_ptr<PlaneImage>> images(planes.size());
  parallel_for(planes.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
    monitor.throw_if_cancelled();
    images[k] = std::make_unique<PlaneImage>(scan.points, points[k], planes[k].frame, planes[k].area_m2);
  });
  return images;
}

/// The borders of one plane.
class BorderFinder {
 public:
  BorderFinder(const Features& features, const BorderSight& sight, const std::vector<char>& ambiguous,
               const SegmentOptions& options)
      : features_(features), sight_(sight), ambiguous_(ambiguous), o_(options) {}

  [[nodiscard]] std::vector<DetectedEdge> run(std::size_t plane, const PlaneImage& image) const {
    std::vector<DetectedEdge> edges;
    for (const StraightRun& run : straight_runs(image, kShortestRun * o_.min_length_m)) {
      if (!sight_.knows() && !run.hole) continue;
      // An outline is cut where it wavers: the points may go on along the line.
      const double beyond_m = std::max(o_.join_gap_m, kBeyond * (run.line.end_m - run.line.begin_m));
      const std::optional<BorderFit> fit = fit_border(image, run, beyond_m, ambiguous_);
      if (!fit || fit->sigma_m > o_.max_border_sigma_m || fit->angle_sigma_rad > kBorderAngleRad) continue;
      add_edges(plane, image, *fit, edges);
    }
    return edges;
  }

 private:
  /// Which bins of a border are edge of the surface.
  [[nodiscard]] std::vector<char> true_bins(std::size_t plane, const PlaneImage& image,
                                            const BorderFit& fit) const {
    std::vector<int> says(fit.bins.size(), 0);
    const Vector2d inward = fit.line.inward();
    for (std::size_t k = 0; k < fit.bins.size(); ++k) {
      const BorderBin& bin = fit.bins[k];
      if (!bin.fits) continue;
      BorderPlace place;
      place.plane = features_.planes[plane].plane;
      place.edge = image.frame().to_space(fit.line.at(bin.t, 0.0));
      place.outward = -(inward.x() * image.frame().u + inward.y() * image.frame().v);
      place.step_m = std::max(0.005, 2.0 * fit.shortfall_m);
      place.point = bin.point;
      says[k] = is_edge(sight_.look(place)) ? 1 : -1;
    }
    std::vector<char> edge(fit.bins.size(), 0);
    for (std::size_t k = 0; k < says.size(); ++k) {
      int sum = 0;
      const std::size_t last = std::min(says.size() - 1, k + kSmooth);
      for (std::size_t i = k < kSmooth ? 0 : k - kSmooth; i <= last; ++i) sum += says[i];
      edge[k] = says[k] != 0 && sum > 0 ? 1 : 0;
    }
    return edge;
  }

  static bool is_edge(Beyond beyond) {
    return beyond == Beyond::open || beyond == Beyond::silent || beyond == Beyond::touching ||
           beyond == Beyond::unknown;
  }

  void add_edges(std::size_t plane, const PlaneImage& image, const BorderFit& fit,
                 std::vector<DetectedEdge>& edges) const {
    const std::vector<char> edge = true_bins(plane, image, fit);
    const double half = 0.5 * fit.bin_m;
    double begin = 0.0;
    double last = -1e9;
    int count = 0;
    const auto finish = [&] {
      // A stretch must be well filled: bins that fit here and there are chance.
      if (count > 0 && 2.0 * count * fit.bin_m >= last - begin) {
        DetectedEdge found;
        found.kind = EdgeKind::border;
        found.planes = {static_cast<std::int32_t>(plane), -1};
        found.sigma_m = fit.sigma_m;
        found.segment = {image.frame().to_space(fit.line.at(begin - half, 0.0)),
                         image.frame().to_space(fit.line.at(last + half, 0.0))};
        edges.push_back(found);
      }
      count = 0;
    };
    for (std::size_t k = 0; k < edge.size(); ++k) {
      if (edge[k] == 0) continue;
      const double t = fit.bins[k].t;
      if (count > 0 && t - last > std::max(o_.join_gap_m, 4.0 * fit.bin_m)) finish();
      if (count == 0) begin = t;
      last = t;
      ++count;
    }
    finish();
  }

  const Features& features_;
  const BorderSight& sight_;
  const std::vector<char>& ambiguous_;
  const SegmentOptions& o_;
};

/// What borders are found from.
struct BorderScene {
  const Scan& scan;
  const ExtractedFeatures& extracted;
  const std::vector<std::unique_ptr<PlaneImage>>& images;
  const std::vector<char>& ambiguous;
};

std::vector<DetectedEdge> find_borders(const BorderScene& scene, const SegmentOptions& options,
                                       Monitor& monitor) {
  constexpr double kLeastSame_m = 0.02;
  const Features& features = scene.extracted.features;
  const BorderSight sight(scene.scan, scene.extracted,
                          std::max(kLeastSame_m, 1.5 * features.inlier_threshold_m));
  const BorderFinder finder(features, sight, scene.ambiguous, options);
  std::vector<std::vector<DetectedEdge>> found(scene.images.size());
  parallel_for(found.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
    monitor.throw_if_cancelled();
    found[k] = finder.run(k, *scene.images[k]);
  });
  std::vector<DetectedEdge> edges;
  for (const auto& part : found) edges.insert(edges.end(), part.begin(), part.end());
  return edges;
}

}  // namespace

void SegmentOptions::check() const {
  if (!(min_length_m > 0.0)) throw_bad_option("min_length_m", min_length_m, "greater than 0");
  if (!(min_angle_deg > 0.0 && min_angle_deg <= 90.0))
    throw_bad_option("min_angle_deg", min_angle_deg, "greater than 0, at most 90");
  // One line of a building has no longer gap, and every line is extended by it.
  if (!(join_gap_m >= 0.0 && join_gap_m <= 100.0))
    throw_bad_option("join_gap_m", join_gap_m, "from 0 to 100");
  if (!(max_border_sigma_m > 0.0))
    throw_bad_option("max_border_sigma_m", max_border_sigma_m, "greater than 0");
}

std::vector<DetectedEdge> find_edges(const Scan& scan, const ExtractedFeatures& extracted,
                                     const SegmentOptions& options, Monitor& monitor) {
  options.check();
  std::vector<std::unique_ptr<PlaneImage>> images =
      images_of(scan, extracted.features.planes, extracted.labels, monitor);
  const ExtractedFeatures more =
      with_small_planes(scan, extracted, completed_labels(scan, extracted, images), kSmallPlane, monitor);
  images = images_of(scan, more.features.planes, more.labels, monitor);
  const Creases creases = find_creases(more.features, images, options, scan.size());
  std::vector<DetectedEdge> edges;
  if (options.creases) edges = creases.edges;
  if (options.borders) {
    const std::vector<DetectedEdge> borders =
        find_borders({scan, more, images, creases.ambiguous}, options, monitor);
    edges.insert(edges.end(), borders.begin(), borders.end());
  }
  edges = merged_edges(std::move(edges), options.join_gap_m, options.min_length_m);
  const auto planes = static_cast<std::int32_t>(extracted.features.planes.size());
  for (DetectedEdge& edge : edges)
    for (std::int32_t& plane : edge.planes)
      if (plane >= planes) plane = -1;
  return edges;
}

std::vector<Segment> find_segments(const Scan& scan, const ExtractedFeatures& extracted,
                                   const SegmentOptions& options, Monitor& monitor) {
  std::vector<Segment> segments;
  for (const DetectedEdge& edge : find_edges(scan, extracted, options, monitor))
    segments.push_back(edge.segment);
  return segments;
}

}  // namespace limen
