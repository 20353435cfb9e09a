// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/station_accuracy.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
        return loop.closes &&
               std::find(loop.links.begin(), loop.links.end(), static_cast<int>(link)) != loop.links.end();
      }));
}

std::optional<bool> within_tolerance(const ProjectResult& result, const ProjectLink& link) {
  if (!result.tolerance_m || !is_checked(link) || link.solved.state == LinkState::rejected)
    return std::nullopt;
  return link.solved.loop_error_m <= *result.tolerance_m;
}

std::optional<BundleError> bundle_error(const ProjectResult& result) {
  BundleError error;
  std::vector<PlaneMatch> all;
  for (std::size_t k = 0; k < result.links.size(); ++k) {
    const std::vector<PlaneMatch>& planes = result.links[k].adjusted;
    all.insert(all.end(), planes.begin(), planes.end());
    const double rms_m = plane_distance_rms(planes).value_or(-1.0);
    if (rms_m <= error.worst_rms_m) continue;
    error.worst = k;
    error.worst_rms_m = rms_m;
  }
  const std::optional<double> rms_m = plane_distance_rms(all);
  if (!rms_m) return std::nullopt;
  error.rms_m = *rms_m;
  error.planes = all.size();
  return error;
}

namespace {

/// By a number, the largest first; those alike in their order.
template <typename Size>
std::vector<std::size_t> largest_first(std::size_t count, const Size& size) {
  std::vector<std::pair<double, std::size_t>> sizes;
  for (std::size_t k = 0; k < count; ++k) sizes.emplace_back(-size(k), k);
  std::sort(sizes.begin(), sizes.end());
  std::vector<std::size_t> order;
  for (const auto& [unused, k] : sizes) order.push_back(k);
  return order;
}

constexpr double kStep = 1e6;  // metres: more than any residual

}  // namespace

std::vector<std::size_t> worst_scans_first(const ProjectResult& result) {
  return largest_first(result.scans.size(), [&](std::size_t k) {
    const ProjectScan& scan = result.scans[k];
    const std::optional<StationAccuracy> it = accuracy_of(result, k);
    if (!scan.readable) return 5 * kStep;
    if (scan.model) return scan.state == NodeState::registered ? -kStep : 4 * kStep;
    const double radius_m = it ? it->radius_m : 0.0;
    switch (scan.state) {
      case NodeState::floating:
        return 4 * kStep + radius_m;
      case NodeState::ambiguous:
        return 3 * kStep + radius_m;
      case NodeState::under_constrained:
        return 2 * kStep + radius_m;
      case NodeState::probable:
        return kStep + radius_m;
      case NodeState::registered:
        break;
    }
    return radius_m;
  });
}

std::vector<std::size_t> worst_links_first(const ProjectResult& result) {
  return largest_first(result.links.size(), [&](std::size_t k) {
    const SolvedLink& link = result.links[k].solved;
    switch (link.state) {
      case LinkState::ambiguous:
        return 4 * kStep + link.loop_error_m;
      case LinkState::bridge:
        return 3 * kStep;
      case LinkState::verified:
        return 2 * kStep + link.loop_error_m;
      case LinkState::weak:
      case LinkState::in_place:
        return kStep + link.loop_error_m;
      case LinkState::rejected:
        break;
    }
    return link.loop_error_m;
  });
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
