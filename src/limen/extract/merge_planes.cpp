// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/merge_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limen {
namespace {

constexpr double kExtrapolated = 1.6;  // times the gate: a piece about the plane of the larger one alone

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
  merged.target.resize(pieces.size());
  std::vector<Plane> fits;  // of merged.planes
  for (const std::size_t i : by_size) {
    const PointMoments& piece = pieces[i];
    merged.target[i] = -1;
    if (piece.count < 3.0) continue;
    const Plane own = fit_plane(piece).plane;
    std::size_t k = 0;
    for (; k < fits.size(); ++k) {
      if (std::abs(own.normal.dot(fits[k].normal)) < std::cos(max_angle_rad)) continue;
      // A slight turn of the common plane would hide a step between pieces that lie far apart.
      if (rms_about(piece, fits[k]) >= kExtrapolated * max_rms_m) continue;
      PointMoments both = merged.planes[k];
      both += piece;
      const Plane common = fit_plane(both).plane;
      if (rms_about(piece, common) >= max_rms_m || rms_about(merged.planes[k], common) >= max_rms_m) continue;
      merged.planes[k] = both;
      fits[k] = common;
      break;
    }
    merged.target[i] = static_cast<std::int32_t>(k);
    if (k < fits.size()) continue;
    merged.planes.push_back(piece);
    fits.push_back(own);
  }
  return merged;
}

}  // namespace limen
