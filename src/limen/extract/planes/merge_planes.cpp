// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/merge_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limen {
namespace {

// Times the gate: how far a piece may be from the plane of the larger one alone; walls may bulge.
constexpr double kExtrapolated = 1.6;
constexpr double kBulge = 4.0;
constexpr double kLargeM2 = 1.0;
constexpr double kLargeWidthM = 0.5;

/// A piece of the size of a wall: its own extent holds the tilt of a common plane.
bool is_large(const PlaneFit& fit) {
  return 12.0 * std::sqrt(fit.variances[1] * fit.variances[2]) >= kLargeM2 &&
         std::sqrt(12.0 * fit.variances[1]) >= kLargeWidthM;
}

}  // namespace

double rms_about(const PointMoments& moments, const Plane& plane) {
  const double distance = plane.signed_distance(moments.mean());
  const double variance = plane.normal.dot(moments.covariance() * plane.normal);
  return std::sqrt(std::max(0.0, variance) + distance * distance);
}

MergedPieces merge_planes(const std::vector<PointMoments>& pieces, double max_angle_rad, double max_rms_m) {
  std::vector<std::size_t> by_size(pieces.size());
  std::iota(by_size.begin(), by_size.end(), 0U);
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return pieces[a].count > pieces[b].count; });
  MergedPieces merged;
  merged.target.resize(pieces.size(), -1);
  std::vector<PlaneFit> fits;  // of merged.planes
  const auto joined = [&](const PointMoments& piece, const PlaneFit& own, std::size_t k) {
    if (std::abs(own.plane.normal.dot(fits[k].plane.normal)) < std::cos(max_angle_rad)) return false;
    const double reach = is_large(own) && is_large(fits[k]) ? kBulge : kExtrapolated;
    if (rms_about(piece, fits[k].plane) >= reach * max_rms_m) return false;
    PointMoments both = merged.planes[k];
    both += piece;
    const PlaneFit common = fit_plane(both);
    if (rms_about(piece, common.plane) >= max_rms_m) return false;
    if (rms_about(merged.planes[k], common.plane) >= max_rms_m) return false;
    merged.planes[k] = both;
    fits[k] = common;
    return true;
  };
  for (const std::size_t i : by_size) {
    if (pieces[i].count < 3.0) continue;
    const PlaneFit own = fit_plane(pieces[i]);
    std::size_t k = 0;
    while (k < fits.size() && !joined(pieces[i], own, k)) ++k;
    merged.target[i] = static_cast<std::int32_t>(k);
    if (k < fits.size()) continue;
    merged.planes.push_back(pieces[i]);
    fits.push_back(own);
  }
  return merged;
}

}  // namespace limen
