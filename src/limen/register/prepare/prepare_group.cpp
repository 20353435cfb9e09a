// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/prepare_group.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/error.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/sight/joined_space.h"

namespace limen {
namespace {

constexpr double kSamePlaneNormal = 0.9995;  // cosine: 1.8 degrees
constexpr double kSamePlaneM = 0.02;
constexpr double kSameOpeningM = 0.2;

/// The scan about `origin` in the group's frame.
Scan placed_about(PlacedScan placed, const Vector3d& origin) {
  const Rigid3 local = to_local(placed.group_from_scan, placed.scan.local_origin, origin);
  Scan scan = moved(std::move(placed.scan), local);
  scan.local_origin = origin;
  scan.level = scan.level && local.rotation(2, 2) > 0.99999;
  return scan;
}

/// Features of several scans, made one.
class Joiner {
 public:
  void add(PreparedScan& part) {
    const Features& features = part.extracted.features;
    std::vector<std::int32_t> joint;
    for (const PlanarPolygon& plane : features.planes) joint.push_back(enter(plane));
    for (SurfaceSample sample : features.samples) {
      if (sample.plane >= 0) sample.plane = joint[static_cast<std::size_t>(sample.plane)];
      all_.samples.push_back(sample);
    }
    for (Opening opening : features.openings) {
      if (opening.facade >= 0) opening.facade = joint[static_cast<std::size_t>(opening.facade)];
      enter(opening);
    }
    all_.segments.insert(all_.segments.end(), features.segments.begin(), features.segments.end());
    all_.noise_m = std::max(all_.noise_m, features.noise_m);
    all_.inlier_threshold_m = std::max(all_.inlier_threshold_m, features.inlier_threshold_m);
    all_.drift_m = std::max(all_.drift_m, features.drift_m);
    views_.push_back({std::move(part.space), std::move(joint)});
  }

  /// The samples plane by plane, clutter last.
  Features features() {
    std::stable_sort(all_.samples.begin(), all_.samples.end(),
                     [](const SurfaceSample& a, const SurfaceSample& b) {
                       return static_cast<std::uint32_t>(a.plane) < static_cast<std::uint32_t>(b.plane);
                     });
    for (SurfaceSample& sample : all_.samples) {
      if (sample.plane >= 0) sample.normal = all_.planes[static_cast<std::size_t>(sample.plane)].plane.normal;
    }
    return std::move(all_);
  }
  std::shared_ptr<const SpaceView> space() { return std::make_shared<JoinedSpace>(std::move(views_)); }

 private:
  static bool same(const PlanarPolygon& a, const PlanarPolygon& b, const std::vector<Polygon>& b_in_a) {
    if (a.oriented != b.oriented || a.plane.normal.dot(b.plane.normal) < kSamePlaneNormal) return false;
    if (std::abs(a.plane.signed_distance(b.centroid)) > kSamePlaneM) return false;
    return intersection_area(a.parts, b_in_a) > 0.0;
  }

  std::int32_t enter(const PlanarPolygon& plane) {
    for (std::size_t i = 0; i < all_.planes.size(); ++i) {
      PlanarPolygon& known = all_.planes[i];
      if (known.plane.normal.dot(plane.plane.normal) < kSamePlaneNormal) continue;
      const std::vector<Polygon> parts = projected(plane.parts, plane.frame, known.frame);
      if (!same(known, plane, parts)) continue;
      known.parts = merged(known.parts, parts);
      known.area_m2 = area(known.parts);
      known.inliers += plane.inliers;
      known.interior = known.interior && plane.interior;
      return static_cast<std::int32_t>(i);
    }
    all_.planes.push_back(plane);
    return static_cast<std::int32_t>(all_.planes.size() - 1);
  }

  /// Of an opening seen twice the better view is kept.
  void enter(const Opening& opening) {
    for (Opening& known : all_.openings) {
      if (known.facade != opening.facade || (known.middle() - opening.middle()).norm() > kSameOpeningM)
        continue;
      if (opening.evidence > known.evidence) known = opening;
      return;
    }
    all_.openings.push_back(opening);
  }

  Features all_;
  std::vector<JoinedSpace::Member> views_;
};

/// All parts in one frame: that of the first scan that shows which way is up, else that of the first.
std::vector<PreparedScan> prepare_parts(std::vector<Scan> scans, const PrepareOptions& options,
                                        Monitor& monitor) {
  std::vector<ScanFrame> frames;
  for (const Scan& scan : scans) frames.push_back(find_scan_frame(scan, options.gravity, monitor));
  const auto upright =
      std::find_if(frames.begin(), frames.end(), [](const ScanFrame& it) { return it.upright; });
  const ScanFrame common = upright == frames.end() ? frames.front() : *upright;
  std::vector<PreparedScan> parts;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    ScanFrame frame = common;
    frame.place = frames[k].place;
    parts.push_back(prepare_in_frame(std::move(scans[k]), frame, options, monitor));
  }
  return parts;
}

bool is_alone(const std::vector<PlacedScan>& scans) {
  if (scans.empty()) throw Error("there is no scan", "group of scans", "give at least one");
  return scans.size() == 1 && to_matrix(scans.front().group_from_scan).isIdentity();
}

PreparedScan joined(std::vector<PlacedScan> scans, const PrepareOptions& options, Monitor& monitor) {
  const PlacedScan& first = scans.front();
  // Near the points: turns about a far origin would amplify the smallest angle.
  const Vector3d origin = (first.group_from_scan * origin_near(first.scan)).array().round();
  std::vector<Scan> placed;
  for (PlacedScan& scan : scans) placed.push_back(placed_about(std::move(scan), origin));
  std::vector<PreparedScan> parts = prepare_parts(std::move(placed), options, monitor);
  PreparedScan group;
  group.upright = parts.front().upright;
  group.surely_upright = parts.front().surely_upright;
  group.upright_from_scan = parts.front().upright_from_scan;
  group.place = parts.front().place;
  group.surroundings = parts.front().surroundings;
  const Vector3d local_origin = parts.front().extracted.features.local_origin;
  Joiner joiner;
  for (PreparedScan& part : parts) {
    group.mobile = group.mobile || part.mobile;
    group.surroundings = common(group.surroundings, part.surroundings);
    group.stations.insert(group.stations.end(), part.stations.begin(), part.stations.end());
    group.details.insert(group.details.end(), part.details.begin(), part.details.end());
    joiner.add(part);
  }
  group.extracted.features = joiner.features();
  group.extracted.features.local_origin = local_origin;
  group.space = joiner.space();
  group.settle_reach();
  return group;
}

}  // namespace

PreparedScan prepare_group(const std::vector<PlacedScan>& scans, const PrepareOptions& options,
                           Monitor& monitor) {
  return is_alone(scans) ? prepare_scan(scans.front().scan, options, monitor)
                         : joined(scans, options, monitor);
}

PreparedScan prepare_group(std::vector<PlacedScan>&& scans, const PrepareOptions& options, Monitor& monitor) {
  return is_alone(scans) ? prepare_scan(std::move(scans.front().scan), options, monitor)
                         : joined(std::move(scans), options, monitor);
}

}  // namespace limen
