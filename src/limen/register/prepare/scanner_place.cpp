// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/scanner_place.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limen/base/parallel.h"
#include "limen/extract/surface/sample_surface.h"
#include "limen/io/table/optical_centre.h"
#include "limen/model/features.h"
#include "limen/register/prepare/steady_sample.h"
#include "limen/register/prepare/tukey_sums.h"
#include "limen/sight/estimate_centre.h"

namespace limen {
namespace {

constexpr std::size_t kLookedPerPiece = 65536;
constexpr std::size_t kEnough = 500000;  // points; chance spoils the density of a share of them
constexpr double kOnPlaneM = 0.02;
constexpr double kTileM = 0.3;
constexpr double kNearbyM = 0.15;      // a claim this near to where the density puts it is borne out,
constexpr double kNearbySigma = 4.0;   // or so many of its standard deviations
constexpr double kHolds = 0.1;         // misfit of the density below which the law holds
constexpr double kClearlyWorse = 1.5;  // ratio of misfits at which a claim that was only assumed gives way,
constexpr double kFarWorse = 3.0;      // and one that was told
constexpr double kMisfitNoise = 0.02;
constexpr double kAsHidden = 0.03;  // share of the points by which two places may differ in what is hidden

/// Tiles of the large planes, turned by `axes`.
Features tiled(const Scan& scan, const std::vector<FramePlane>& planes, const Matrix3d& axes) {
  Features features;
  for (const FramePlane& plane : planes) {
    PlanarPolygon polygon;
    polygon.plane = plane.plane;
    polygon.frame = make_frame(transformed({axes, Vector3d::Zero()}, plane.plane), axes * plane.middle);
    polygon.frame = {axes.transpose() * polygon.frame.origin, axes.transpose() * polygon.frame.u,
                     axes.transpose() * polygon.frame.v};
    polygon.area_m2 = plane.area_m2;
    features.planes.push_back(polygon);
  }
  std::vector<std::int32_t> labels(scan.size(), -1);
  std::vector<Plane> large;
  for (const FramePlane& plane : planes) large.push_back(plane.plane);
  parallel_for(scan.size(), kLookedPerPiece, [&](std::size_t begin, std::size_t end) {
    label_nearest(scan.points, begin, end, large, kOnPlaneM, labels);
  });
  SampleOptions options;
  options.tile_m = kTileM;
  options.clutter = false;
  features.samples = sample_surface(scan, labels, features.planes, options);
  for (PlanarPolygon& polygon : features.planes)
    polygon.plane = transformed({axes, Vector3d::Zero()}, polygon.plane);
  for (SurfaceSample& sample : features.samples) sample.mean = axes * sample.mean;
  return features;
}

bool as_clear(const Scan& scan, const Vector3d& place, const Vector3d& claim) {
  return hidden_share(scan.points, place) <= hidden_share(scan.points, claim) + kAsHidden;
}

ScannerPlace estimated(const EstimatedCentre& found, const Matrix3d& axes) {
  ScannerPlace place;
  place.source = PlaceSource::estimated;
  place.centre = axes.transpose() * found.centre;
  place.confirmed = true;
  place.sigma_m = found.sigma_m;
  return place;
}

ScannerPlace tested(const Scan& scan, const Features& features, const Matrix3d& axes) {
  ScannerPlace kept;
  kept.source = scan.centre_source;
  kept.centre = scan.centres.front();
  const std::optional<TestedCentre> test = test_centre(features, axes * kept.centre);
  if (!test) return kept;
  const double off = (test->nearby.centre - axes * kept.centre).norm();
  kept.confirmed =
      test->nearby.misfit < kHolds && off < std::max(kNearbyM, kNearbySigma * test->nearby.sigma_m);
  if (kept.confirmed) return kept;
  const std::optional<EstimatedCentre> better = estimate_centre(features);
  if (!better) return kept;
  const double ratio = kept.source == PlaceSource::assumed ? kClearlyWorse : kFarWorse;
  const bool worse = test->claim_misfit > ratio * better->misfit + kMisfitNoise;
  ScannerPlace place = estimated(*better, axes);
  if (!worse || (place.centre - kept.centre).norm() < 2.0 * kNearbyM) return kept;
  if (!as_clear(scan, place.centre, kept.centre)) return kept;
  if (kept.source == PlaceSource::told_by_user) {
    kept.refuted = kept.centre;
    return kept;
  }
  place.refuted = kept.centre;
  return place;
}

}  // namespace

std::optional<Scan> sample_for_place(const Scan& scan) {
  if (scan.mobile() || scan.size() <= 2 * kEnough) return std::nullopt;
  return subset(scan, steady_sample(scan, kEnough));
}

ScannerPlace find_scanner_place(const Scan& scan, const std::vector<FramePlane>& planes,
                                const Matrix3d& axes) {
  ScannerPlace place;
  if (scan.mobile()) {
    place.source = PlaceSource::per_point;
    return place;
  }
  const Features features = tiled(scan, planes, axes);
  if (scan.centre_known()) return tested(scan, features, axes);
  const std::optional<EstimatedCentre> found = estimate_centre(features);
  return found ? estimated(*found, axes) : place;
}

ScannerPlace refined_place(const ScannerPlace& place, const Scan& scan, const std::vector<FramePlane>& planes,
                           const Matrix3d& axes) {
  if (place.source != PlaceSource::estimated) return place;
  const std::optional<TestedCentre> test = test_centre(tiled(scan, planes, axes), axes * place.centre);
  if (!test || test->nearby.misfit > kHolds) return place;
  ScannerPlace refined = estimated(test->nearby, axes);
  refined.refuted = place.refuted;
  return refined;
}

}  // namespace limen
