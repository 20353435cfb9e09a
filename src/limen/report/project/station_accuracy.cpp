// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/station_accuracy.h"

#include <algorithm>
#include <cmath>

#include "limen/deviation/deviation.h"
#include "limen/report/summary/precision.h"

namespace limen {

std::optional<StationAccuracy> accuracy_of(const ProjectResult& result, std::size_t scan) {
  const ProjectScan& it = result.scans[scan];
  if (it.model || !it.frame_from_scan) return std::nullopt;
  StationAccuracy found;
  found.held_fixed = result.sigma_scan >= 0 && static_cast<std::size_t>(result.sigma_scan) == scan;
  if (found.held_fixed) return found;
  Matrix3d shifts = it.sigma.covariance.block<3, 3>(3, 3);
  Matrix3d turns = it.sigma.covariance.block<3, 3>(0, 0);
  if (it.sigma.covariance.isZero(0.0)) {
    shifts = it.sigma.translation_m.array().square().matrix().asDiagonal();
    turns = it.sigma.rotation_rad.array().square().matrix().asDiagonal();
  }
  found.sigma_m = shifts.diagonal().cwiseMax(0.0).cwiseSqrt();
  found.heading_sigma_rad = std::sqrt(std::max(0.0, result.up.dot(turns * result.up)));
  found.radius_m = radius_95(shifts);
  found.loa = loa_class(found.radius_m);
  if (result.tolerance_m) found.within_tolerance = found.radius_m <= *result.tolerance_m;
  return found;
}

std::size_t loops_through(const ProjectResult& result, std::size_t link) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(), [&](const GraphLoop& loop) {
        return std::find(loop.links.begin(), loop.links.end(), static_cast<int>(link)) != loop.links.end();
      }));
}

std::optional<bool> within_tolerance(const ProjectResult& result, const ProjectLink& link) {
  if (!result.tolerance_m || !is_checked(link)) return std::nullopt;
  return link.solved.loop_error_m <= *result.tolerance_m;
}

std::optional<double> overlap_of(const ProjectResult& result, std::size_t link) {
  const ProjectLink& it = result.links[link];
  const auto surface = [&](int scan) { return result.scans[static_cast<std::size_t>(scan)].surface_m2; };
  const double smaller = std::min(surface(it.source), surface(it.target));
  if (it.matches.empty() || !(smaller > 0.0)) return std::nullopt;
  double shared = 0.0;
  for (const PlaneMatch& match : it.matches) shared += match.overlap_m2;
  return std::min(1.0, shared / smaller);
}

}  // namespace limen
