// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/scan_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/extract/surface/sample_surface.h"
#include "limen/model/features.h"
#include "limen/model/plausible_size.h"
#include "limen/register/frame/frame_planes.h"
#include "limen/register/frame/scan_up.h"
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
  for (const std::uint32_t i : steady_sample(scan, kForSpread, kThinShellM))
    points.emplace_back(axes * scan.points[i]);
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
  if ((better->centre - claimed).norm() < std::max(kNearbyM, kNearbySigma * better->sigma_m))
    return std::nullopt;
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

/// As many points of a large static scan as its scanner's place needs; none of a scan that is not large: it
/// serves itself.
std::optional<Scan> sample_for_place(const Scan& scan) {
  if (scan.mobile() || scan.size() <= 2 * kEnough) return std::nullopt;
  return subset(scan, steady_sample(scan, kEnough, kThinShellM));
}

/// Where the scanner of `scan` stood, about its local origin: what is claimed is tested and kept, or replaced
/// by what the data show, or unknown. `planes`: its large planes.
///
/// The density of the points on planes (sight/estimate_centre.h) confirms a place, or shows another one.
/// Where it shows none, the spread of the points over directions (sight/angular_spread.h) may still refute a
/// claim.
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

/// A place that was estimated, estimated again with better planes; any other place as it is.
ScannerPlace refined_place(const ScannerPlace& place, const Scan& scan, const std::vector<FramePlane>& planes,
                           const Matrix3d& axes) {
  if (place.source != PlaceSource::estimated) return place;
  const std::optional<TestedCentre> test = test_centre(tiled(scan, planes, axes), axes * place.centre);
  if (!test || test->nearby.misfit > kHolds) return place;
  ScannerPlace refined = estimated(test->nearby, axes);
  refined.refuted = place.refuted;
  return refined;
}

constexpr std::size_t kFramePoints = 120000;  // points
constexpr std::size_t kLeastPoints = 1000;
constexpr double kLevelPathDeg = 3.0;  // z of a moving scanner's frame, nearer to up than this, is up
constexpr double kWallDeg = 5.0;
constexpr double kHeadingDeg = 0.5;    // walls off by more count less and less
constexpr double kCornerShare = 0.01;  // of the points that lie beyond the corner along each axis
/// The corner lies this much farther out: the floor and the walls at it must not lie on borders of cells.
constexpr double kMarginM = 0.11;

/// Turns about the vertical only: x along `heading` as it is seen from above.
Matrix3d frame_of(const Vector3d& up, const Vector3d& heading) {
  const Vector3d x = (heading - up * up.dot(heading)).normalized();
  Matrix3d rows;
  rows.row(0) = x.transpose();
  rows.row(1) = up.cross(x).transpose();
  rows.row(2) = up.transpose();
  return rows;
}

/// A horizontal axis to count angles from: the normal of the largest wall, or anything.
Vector3d first_heading(const Vector3d& up, const std::vector<FramePlane>& planes) {
  for (const FramePlane& plane : planes) {
    if (std::abs(plane.plane.normal.dot(up)) < std::sin(radians(kWallDeg))) return plane.plane.normal;
  }
  return up.unitOrthogonal();
}

/// The direction, modulo a quarter turn, along which or across which the most walls stand.
double main_angle(const Matrix3d& frame, const std::vector<FramePlane>& planes) {
  struct Wall {
    double angle;
    double area_m2;
  };
  std::vector<Wall> walls;
  double largest = 0.0;
  for (const FramePlane& plane : planes) {
    const Vector3d n = frame * plane.plane.normal;
    if (std::abs(n.z()) > std::sin(radians(kWallDeg))) continue;
    walls.push_back({std::atan2(n.y(), n.x()), plane.area_m2});
    largest = std::max(largest, plane.area_m2);
  }
  const auto mean_about = [&](double start) {
    double angle = start;
    double total = 0.0;
    for (int round = 0; round < 30; ++round) {
      std::complex<double> sum = 0.0;
      for (const Wall& wall : walls) {
        const double off = std::remainder(wall.angle - angle, 0.5 * std::numbers::pi) / radians(kHeadingDeg);
        const double weight =
            std::max(0.0, wall.area_m2 / largest - 0.1) / ((1.0 + off * off) * (1.0 + off * off));
        sum += weight * std::polar(1.0, 4.0 * (wall.angle - angle));
      }
      total = std::abs(sum);
      const double step = std::arg(sum) / 4.0;
      angle += step;
      if (std::abs(step) < 1e-13) break;
    }
    return std::pair(angle, total);
  };
  std::pair<double, double> best{0.0, -1.0};
  for (std::size_t k = 0; k < std::min<std::size_t>(6, walls.size()); ++k) {
    const std::pair<double, double> found = mean_about(walls[k].angle);
    if (found.second > 1.0001 * best.second) best = found;
  }
  return best.first;
}

/// Which of the four quarter turns: x along the longer side, and towards the side where the points reach
/// further from their middle.
int quarter_of(const Matrix3d& frame, const Scan& sample) {
  std::array<std::vector<double>, 2> along;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Vector3d x = frame * sample.points[i];
    along[0].push_back(x.x());
    along[1].push_back(x.y());
  }
  std::array<double, 2> length{};
  std::array<double, 2> lean{};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t cut = along[k].size() / 50;
    const double low = ranked(along[k], cut);
    const double high = ranked(along[k], along[k].size() - 1 - cut);
    length[k] = high - low;
    lean[k] = 0.5 * (low + high) - median(along[k]);
  }
  const bool swap = length[1] > length[0];
  const bool positive = lean[swap ? 1 : 0] >= 0.0;
  return (swap ? 1 : 0) + (positive ? 0 : 2);
}

Matrix3d turned_about_z(const Matrix3d& frame, double angle) {
  return Eigen::AngleAxisd(-angle, Vector3d::UnitZ()).toRotationMatrix() * frame;
}

/// Of value(0) to value(size - 1) the one below which `rank` others lie. Those near the lowest are singled
/// out first, by what a part of them says, so that few have to be kept and sorted; the answer is that of
/// sorting all.
template <typename ValueOf>
double value_of_rank(std::size_t size, std::size_t rank, const ValueOf& value) {
  constexpr std::size_t kPart = 64;
  const auto up_to = [&](double bound, std::size_t step) {
    std::vector<double> values;
    for (std::size_t i = 0; i < size; i += step) {
      const double x = value(i);
      if (x <= bound) values.push_back(x);
    }
    return values;
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  std::vector<double> low;
  if (size >= kPart * kPart * kPart) {
    std::vector<double> part = up_to(kAny, kPart);
    low = up_to(ranked(part, std::min(part.size() - 1, 2 * rank / kPart + 100)), 1);
  }
  if (low.size() <= rank) low = up_to(kAny, 1);
  return ranked(low, rank);
}

/// A corner of the extent, a few stray points left out. Of all points: which were looked at must not show.
Vector3d corner_of(const Matrix3d& frame, const std::vector<Vector3d>& points) {
  Vector3d corner;
  const auto rank = static_cast<std::size_t>(kCornerShare * static_cast<double>(points.size()));
  parallel_for(3, 1, [&](std::size_t first, std::size_t last) {
    for (auto k = static_cast<Eigen::Index>(first); k < static_cast<Eigen::Index>(last); ++k)
      corner[k] =
          value_of_rank(points.size(), rank, [&](std::size_t i) { return frame.row(k).dot(points[i]); }) -
          kMarginM;
  });
  return frame.transpose() * corner;
}

/// A moving scanner's z is that of a national grid or of its own instruments: better than sloping roads.
bool keeps_z(const Scan& scan, const Vector3d& up, Gravity gravity) {
  return scan.mobile() && gravity != Gravity::unknown && up.z() > std::cos(radians(kLevelPathDeg));
}

/// Enough to know about how the scan lies.
Scan every_third(const Scan& sample) {
  std::vector<std::uint32_t> third;
  for (std::uint32_t i = 0; i < sample.size(); i += 3) third.push_back(i);
  return subset(sample, third);
}

Vector3d main_normal(const std::vector<FramePlane>& planes) {
  return planes.empty() ? Vector3d(Vector3d::UnitZ()) : planes.front().plane.normal;
}

Scan seen_from(Scan sample, const ScannerPlace& place) {
  if (sample.mobile()) return sample;
  sample.centres.clear();
  if (place.source != PlaceSource::unknown) sample.centres = {place.centre};
  return sample;
}

/// The rotation that a scan's planes give where `up` is about up.
Matrix3d frame_by(const std::vector<FramePlane>& planes, const Vector3d& up, const Scan& sample,
                  Gravity gravity) {
  const Vector3d z =
      keeps_z(sample, up, gravity) ? Vector3d(Vector3d::UnitZ()) : settled_up(up, planes, sample.mobile());
  Matrix3d frame = frame_of(z, first_heading(z, planes));
  frame = turned_about_z(frame, main_angle(frame, planes));
  return turned_about_z(frame, 0.5 * std::numbers::pi * quarter_of(frame, sample));
}

/// The planes of `sample` found in a frame about right: where its cubes lie no longer depends on how the scan
/// lies in its file.
std::vector<FramePlane> planes_in(const Matrix3d& frame, const Vector3d& corner, const Scan& sample) {
  std::vector<Vector3d> points(sample.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = frame * (sample.points[i] - corner);
  std::vector<FramePlane> planes = frame_planes(points);
  const Rigid3 back{frame.transpose(), corner};
  for (FramePlane& plane : planes) {
    plane.plane = transformed(back, plane.plane);
    plane.middle = back * plane.middle;
  }
  return planes;
}

}  // namespace

ScanFrame find_scan_frame(const Scan& scan, Gravity gravity, Monitor& monitor) {
  ScanFrame found;
  found.rounding_m = coordinate_step_m(scan) / std::sqrt(12.0);
  found.upright = found.surely_upright = gravity == Gravity::up;
  if (scan.centres.size() == 1) {
    found.place.source = scan.centre_source;
    found.place.centre = scan.centres.front();
  }
  if (scan.mobile()) found.place.source = PlaceSource::per_point;
  if (scan.size() < kLeastPoints) return found;
  Scan sample = subset(scan, steady_sample(scan, kFramePoints));
  // Points that lie about as far from their middle are in the sample all together, or not at all.
  if (sample.size() < kLeastPoints) return found;
  const Scan few = every_third(sample);
  const std::vector<FramePlane> first = frame_planes(few.points);
  monitor.throw_if_cancelled();
  const Matrix3d axes = frame_by(first, main_normal(first), few, Gravity::unknown);
  std::optional<Scan> enough = sample_for_place(scan);
  found.place = find_scanner_place(enough ? *enough : scan, first, axes);
  sample = seen_from(std::move(sample), found.place);
  const ScanUp up = find_up(sample, first, gravity, found.place);
  found.upright = up.clear;
  found.surely_upright = up.sure;
  const Matrix3d about = frame_by(first, up.up, few, gravity);
  monitor.throw_if_cancelled();
  const std::vector<FramePlane> planes = planes_in(about, corner_of(about, sample.points), sample);
  found.place = refined_place(found.place, enough ? *enough : scan, planes, about);
  enough.reset();
  found.frame_from_scan = frame_by(planes, about.row(2).transpose(), sample, gravity);
  found.corner = corner_of(found.frame_from_scan, scan.points);
  return found;
}

}  // namespace limen
