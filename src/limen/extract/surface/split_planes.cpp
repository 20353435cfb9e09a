// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/split_planes.h"

#include <vector>

#include "limen/base/error.h"
#include "limen/extract/planes/touching_parts.h"
#include "limen/extract/surface/make_polygons.h"

namespace limen {
namespace {

PlaneFit fit_of(const Scan& scan, const std::vector<std::uint32_t>& points) {
  const Vector3d anchor = scan.points[points.front()];
  PointMoments moments;
  for (const std::uint32_t i : points) moments.add(scan.points[i] - anchor);
  PlaneFit fit = fit_plane(moments);
  fit.plane = shifted(fit.plane, -anchor);
  fit.centroid += anchor;
  return fit;
}

}  // namespace

void SplitOptions::check() const {
  if (!(gap_m > 0)) throw_bad_option("gap_m", gap_m, "more than 0");
  if (min_inliers < 3) throw_bad_option("split min_inliers", min_inliers, "3 or more");
}

PlaneLabels split_planes(const Scan& scan, const PlaneLabels& planes, const SplitOptions& options) {
  options.check();
  PlaneLabels split;
  split.inlier_threshold_m = planes.inlier_threshold_m;
  split.labels.assign(planes.labels.size(), -1);
  const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const std::vector<std::uint32_t>& piece :
         touching_parts(scan, planes.fits[k], points[k], options.gap_m)) {
      if (piece.size() < static_cast<std::size_t>(options.min_inliers)) break;
      for (const std::uint32_t i : piece) split.labels[i] = static_cast<std::int32_t>(split.fits.size());
      split.fits.push_back(fit_of(scan, piece));
    }
  }
  return split;
}

}  // namespace limen
