// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/scanner_place.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/extract/surface/sample_surface.h"
#include "limen/model/features.h"
#include "limen/register/frame/steady_sample.h"
#include "limen/register/frame/tukey_sums.h"
#include "limen/sight/angular_spread.h"
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
constexpr double kFarWorse = 3.0;      // and one that the file or the user states
constexpr double kMisfitNoise = 0.02;
constexpr double kAsHidden = 0.03;  // share of the points by which two places may differ in what is hidden
constexpr std::size_t kForSpread = 20000;  // points
constexpr double kFitsBetter = 0.05;  // nats per point by which another place fits better than a false claim
constexpr double kFitsMuchBetter = 0.15;  // and than an estimate that is off

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

/// A sample of the points, turned by `axes`, that shows how they spread over directions.
std::vector<Vector3d> spread_sample(const Scan& scan, const Matrix3d& axes) {
  std::vector<Vector3d> points;
  for (const std::uint32_t i : steady_sample(scan, kForSpread)) points.emplace_back(axes * scan.points[i]);
  return points;
}

ScannerPlace estimated(const EstimatedCentre& found, const Matrix3d& axes) {
  ScannerPlace place;
  place.source = PlaceSource::estimated;
  place.centre = axes.transpose() * found.centre;
  place.confirmed = true;
  place.sigma_m = found.sigma_m;
  return place;
}

/// A place that the data contradict: the user's word is kept, any other gives way to `instead`.
ScannerPlace refuted(const ScannerPlace& claim, const ScannerPlace& instead) {
  ScannerPlace place = claim.source == PlaceSource::stated_by_user ? claim : instead;
  place.refuted = claim.centre;
  return place;
}

/// Of a claim that the density on planes does not bear out: the place that it shows instead, if it clearly
/// shows one. From there no more is hidden than from the claim.
std::optional<ScannerPlace> shown_instead(const ScannerPlace& claim, double claim_misfit,
                                          const Features& features, const std::vector<Vector3d>& sample,
                                          const Matrix3d& axes) {
  const std::optional<EstimatedCentre> better = estimate_centre(features);
  if (!better) return std::nullopt;
  const double ratio = claim.source == PlaceSource::assumed ? kClearlyWorse : kFarWorse;
  if (claim_misfit <= ratio * better->misfit + kMisfitNoise) return std::nullopt;
  const Vector3d claimed = axes * claim.centre;
  if ((better->centre - claimed).norm() < 2.0 * kNearbyM) return std::nullopt;
  const std::size_t cells = direction_cells(sample, claimed);
  const double hidden = angular_spread(sample, claimed, cells).hidden;
  if (angular_spread(sample, better->centre, cells).hidden > hidden + kAsHidden) return std::nullopt;
  return estimated(*better, axes);
}

ScannerPlace tested(const Scan& scan, const Features& features, const Matrix3d& axes) {
  ScannerPlace claim;
  claim.source = scan.centre_source;
  claim.centre = scan.centres.front();
  const Vector3d claimed = axes * claim.centre;
  const std::optional<TestedCentre> test = test_centre(features, claimed);
  if (test) {
    const double off = (test->nearby.centre - claimed).norm();
    claim.confirmed =
        test->nearby.misfit < kHolds && off < std::max(kNearbyM, kNearbySigma * test->nearby.sigma_m);
    if (claim.confirmed) return claim;
  }
  const std::vector<Vector3d> sample = spread_sample(scan, axes);
  if (test) {
    if (const auto shown = shown_instead(claim, test->claim_misfit, features, sample, axes))
      return refuted(claim, *shown);
  }
  if (evenly_thinned(features) || better_place_nearby(sample, claimed) < kFitsBetter) return claim;
  return refuted(claim, {});
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
  if (!found || better_place_nearby(spread_sample(scan, axes), found->centre) > kFitsMuchBetter) return place;
  return estimated(*found, axes);
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
