// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "limen/base/progress.h"
#include "limen/extract/cells/morton_order.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/model/scan.h"

namespace limen {

class PointNormals;

/// Options of the plane detector for unorganised clouds.
struct GrowOptions {
  double inlier_threshold_m = 0.0;  ///< 0: 3.3 times the noise found in the cloud, between 8 and 30 mm
  int min_inliers = 200;            ///< smallest plane, points
  double finest_cell_m = 0.02;      ///< edge of the smallest cube
  double coarsest_cell_m = 0.32;    ///< edge of the first cubes tried
  double max_angle_deg = 12.0;      ///< between a cube's normal and its plane's

  void check() const;
};

struct GrownPlanes {
  PlaneLabels planes;
  /// One standard deviation of points about their local planes, where the threshold is made of it; else 0.
  double noise_m = 0.0;
  double inlier_threshold_m = 0.0;  ///< the threshold used
  /// Which way the surface faces at each point of the ground's order; null: there are no points.
  std::shared_ptr<const PointNormals> normals;
};

/// The points of a scan in order, to grow planes in them at several thresholds.
class PlaneGround {
 public:
  /// `scan` must outlive it. Throws Error for options out of bounds.
  PlaneGround(const Scan& scan, const GrowOptions& options);
  ~PlaneGround();
  PlaneGround(const PlaneGround&) = delete;
  PlaneGround& operator=(const PlaneGround&) = delete;

  /// Its points in order.
  [[nodiscard]] const MortonOrder& order() const;

  /// As grow_planes(), at this threshold; 0: that of the noise.
  [[nodiscard]] GrownPlanes grow(double inlier_threshold_m, Monitor& monitor) const;

 private:
  struct Ordered;
  GrowOptions options_;
  std::unique_ptr<const Ordered> ordered_;
};

/// Planes of an unorganised cloud, coarse to fine: cubes whose points lie in a plane grow into regions,
/// regions that continue one plane become one, points join the nearest plane of their neighbourhood; what is
/// left is tried again with cubes half as large. The consensus of a region is taken by MSAC over its cubes
/// (2022, eq. 2), then by least squares over its points.
///
/// Departures from 2021, section 2.2: samples are drawn from a connected region rather than from the whole
/// cloud, so that a plane is never made of far-apart chance inliers, and the score is the unitless one.
GrownPlanes grow_planes(const Scan& scan, const GrowOptions& options = {},
                        Monitor& monitor = silent_monitor());

}  // namespace limen
