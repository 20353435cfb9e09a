// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/named.h"
#include "limen/base/progress.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

enum class PlaneDetector {
  automatic,   ///< the one that measured best: grow. scan_lines is faster, but not better (docs/polygons.md)
  grow,        ///< cubes, coarse to fine: needs nothing but points (grow_planes.h)
  scan_lines,  ///< 2021, section 2.1: needs the scan's lines (topology_planes.h)
  msac,        ///< 2021, section 2.2: the published baseline, slow (msac_planes.h)
  published    ///< 2021, section 2: scan_lines where the scan's lines are known, else msac
};
/// Those that are for users.
inline constexpr Named<PlaneDetector> kPlaneDetectors[] = {{PlaneDetector::automatic, "auto"},
                                                           {PlaneDetector::grow, "grow"},
                                                           {PlaneDetector::msac, "msac"},
                                                           {PlaneDetector::scan_lines, "scan_lines"}};

/// Where the inlier threshold comes from when GrowOptions::inlier_threshold_m is 0.
enum class ThresholdRule {
  automatic,    ///< a contrario among multiples of what the noise asks for (automatic_threshold.h); mobile
                ///< scans: what the noise asks for, at least 25 mm
  noise,        ///< the detector's own: 3.3 times the noise it finds
  a_contrario,  ///< 2021, 3.1.1: among 5, 10, 15, 20, 30 and 50 mm, whatever the noise
  published     ///< the same by equations 3 to 6 as they are printed (automatic_threshold.h)
};
/// Those that are for users.
inline constexpr Named<ThresholdRule> kThresholdRules[] = {{ThresholdRule::automatic, "auto"},
                                                           {ThresholdRule::noise, "noise"},
                                                           {ThresholdRule::a_contrario, "a_contrario"}};

struct DetectOptions {
  PlaneDetector detector = PlaneDetector::automatic;
  ThresholdRule threshold = ThresholdRule::automatic;
  std::uint64_t seed = 1;  ///< of the detectors that draw samples
  /// Of mobile scans, with `grow`: the relief of façades as planes of its own, as finely as the noise allows
  /// (fine_planes.h). Without it, and by the automatic threshold, what protrudes by a few centimetres is one
  /// plane: fewer planes, each of them large, as a pose is sought with.
  bool relief = true;
};

struct DetectedPlanes {
  PlaneLabels planes;
  double noise_m = 0.0;                          ///< root mean square distance of the inliers to their planes
  PlaneDetector detector = PlaneDetector::grow;  ///< the detector used; never automatic or published
};

/// Planes by the detector asked for. `grow.inlier_threshold_m` and `grow.min_inliers` hold for each of them.
/// Throws Error where scan_lines is asked for and the scan's lines are not known.
DetectedPlanes detect_planes(const Scan& scan, const DetectOptions& options = {},
                             const GrowOptions& grow = {}, Monitor& monitor = silent_monitor());

}  // namespace limen
