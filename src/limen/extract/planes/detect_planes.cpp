// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/detect_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/planes/automatic_threshold.h"
#include "limen/extract/planes/fine_planes.h"
#include "limen/extract/planes/fine_station.h"
#include "limen/extract/planes/msac_planes.h"
#include "limen/extract/planes/straight_scan.h"
#include "limen/extract/planes/topology_planes.h"

namespace limen {
namespace {

constexpr double kMobileThresholdM = 0.025;  // least inlier threshold for the façades of a mobile scan
constexpr double kStationDriftM = 0.001;     // by which parts of one surface may stray in a station

double noise_about(const PlaneLabels& planes) {
  std::vector<std::size_t> counts(planes.fits.size(), 0);
  for (const std::int32_t label : planes.labels) {
    if (label >= 0) ++counts[static_cast<std::size_t>(label)];
  }
  double squares = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const auto count = static_cast<double>(counts[k]);
    squares += count * planes.fits[k].rms_m * planes.fits[k].rms_m;
    total += count;
  }
  return total > 0.0 ? std::sqrt(squares / total) : 0.0;
}

/// 0 leaves the choice to the detector.
double threshold_for(const Scan& scan, const DetectOptions& options, const GrowOptions& grow,
                     Monitor& monitor) {
  const ThresholdRule rule = options.threshold;
  if (grow.inlier_threshold_m > 0.0) return grow.inlier_threshold_m;
  if (rule == ThresholdRule::automatic && !scan.mobile()) return automatic_threshold(scan, grow, monitor);
  // The noise of the whole cloud: on a subset cubes are so large that relief counts as noise.
  if (rule == ThresholdRule::automatic && options.relief) return 0.0;
  if (rule == ThresholdRule::automatic) {
    // A street is too wide for the choice on a subset, and façades have relief of centimetres, whatever the
    // noise.
    return std::max(kMobileThresholdM, noise_threshold(scan, grow, monitor));
  }
  if (rule == ThresholdRule::a_contrario) return a_contrario_threshold(scan, grow, {}, monitor);
  if (rule == ThresholdRule::published)
    return a_contrario_threshold(scan, grow, {.criterion = ThresholdCriterion::published}, monitor);
  return 0.0;
}

PlaneLabels from_scan_lines(const Scan& scan, const DetectOptions& options, const GrowOptions& grow,
                            Monitor& monitor) {
  TopologyPlaneOptions lines;
  lines.inlier_threshold_m = grow.inlier_threshold_m;
  lines.min_inliers = std::max(12, grow.min_inliers);
  lines.seed = options.seed;
  return extract_topology_planes(scan, lines, monitor);
}

PlaneLabels from_msac(const Scan& scan, const DetectOptions& options, const GrowOptions& grow,
                      Monitor& monitor) {
  MsacPlaneOptions msac;
  if (grow.inlier_threshold_m > 0.0) msac.inlier_threshold_m = grow.inlier_threshold_m;
  msac.min_inliers = grow.min_inliers;
  msac.seed = options.seed;
  return msac_planes(scan, msac, monitor);
}

PlaneLabels planes_by(PlaneDetector detector, const Scan& scan, const DetectOptions& options,
                      const GrowOptions& grow, Monitor& monitor) {
  if (detector == PlaneDetector::scan_lines) return from_scan_lines(scan, options, grow, monitor);
  if (detector == PlaneDetector::msac) return from_msac(scan, options, grow, monitor);
  return grow_planes(scan, grow, monitor).planes;
}

/// The planes about the scan's own points.
std::vector<PlaneFit> refitted(const Scan& scan, const PlaneLabels& planes) {
  const Vector3d anchor = scan.points.front();
  std::vector<PointMoments> sums(planes.fits.size());
  for (std::size_t i = 0; i < planes.labels.size(); ++i) {
    if (planes.labels[i] >= 0) sums[static_cast<std::size_t>(planes.labels[i])].add(scan.points[i] - anchor);
  }
  std::vector<PlaneFit> fits;
  for (const PointMoments& sum : sums) {
    PlaneFit fit = fit_plane(sum);
    fit.plane = shifted(fit.plane, -anchor);
    fit.centroid += anchor;
    fits.push_back(fit);
  }
  return fits;
}

/// Planes with the relief of walls as planes of its own: in the scan freed of its drift, which would break
/// walls into bands.
DetectedPlanes detect_relief(const Scan& scan, const GrowOptions& grow, Monitor& monitor) {
  constexpr double kDriftShare = 0.3;  // of the work, about
  StagePart straightening(monitor, 0.0, kDriftShare);
  const ScanDrift drift = scan_drift(scan, straightening);
  std::optional<Scan> straight;
  if (!drift.knots.empty()) straight = straightened(scan, drift);
  const Scan& seen = straight ? *straight : scan;
  StagePart growing(monitor, kDriftShare, 1.0);
  DetectedPlanes detected;
  detected.planes = grow_planes(seen, grow, growing).planes;
  FineOptions fine;
  fine.noise_m = noise_about(detected.planes);
  fine.min_inliers = grow.min_inliers;
  detected.planes = fine_planes(seen, detected.planes, fine);
  detected.noise_m = noise_about(detected.planes);
  if (straight) detected.planes.fits = refitted(scan, detected.planes);
  return detected;
}

/// Planes of a station, those a few millimetres before or behind them separate.
DetectedPlanes detect_fine(const Scan& scan, const GrowOptions& grow, Monitor& monitor) {
  const PlaneGround ground(scan, grow);
  const GrownPlanes grown = ground.grow(grow.inlier_threshold_m, monitor);
  FineOptions fine;
  fine.noise_m = noise_about(grown.planes);
  fine.drift_m = kStationDriftM;
  fine.min_inliers = grow.min_inliers;
  DetectedPlanes detected;
  detected.planes = fine_station_planes(scan, ground.order(), grown, fine);
  detected.noise_m = noise_about(detected.planes);
  return detected;
}

}  // namespace

DetectedPlanes detect_planes(const Scan& scan, const DetectOptions& options, const GrowOptions& grow,
                             Monitor& monitor) {
  grow.check();
  PlaneDetector detector = options.detector;
  if (detector == PlaneDetector::automatic) detector = PlaneDetector::grow;
  if (detector == PlaneDetector::published)
    detector = scan.topology.known() ? PlaneDetector::scan_lines : PlaneDetector::msac;
  if (scan.size() == 0) return {};
  GrowOptions used = grow;
  constexpr double kThresholdShare = 0.4;  // of the work, about
  StagePart choosing(monitor, 0.0, kThresholdShare);
  used.inlier_threshold_m = threshold_for(scan, options, grow, choosing);
  StagePart finding(monitor, kThresholdShare, 1.0);
  if (options.relief && detector == PlaneDetector::grow)
    return scan.mobile() ? detect_relief(scan, used, finding) : detect_fine(scan, used, finding);
  DetectedPlanes detected;
  detected.detector = detector;
  detected.planes = planes_by(detector, scan, options, used, finding);
  detected.noise_m = noise_about(detected.planes);
  return detected;
}

}  // namespace limen
