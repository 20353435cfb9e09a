// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/fine_planes.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "limen/base/error.h"
#include "limen/extract/planes/claim_strips.h"
#include "limen/extract/planes/join_pieces.h"
#include "limen/extract/planes/relief_sheets.h"

namespace limen {
namespace {

constexpr double kGapM = 0.5;  // parts of a plane this far apart may be two planes
constexpr double kLeastNoiseM = 0.001;
constexpr double kNoisesOfThreshold = 3.3;

std::vector<PlanePiece> hanging_parts(const Scan& scan, const PlaneLabels& planes, const Vector3d& anchor) {
  const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
  std::vector<PlanePiece> parts;
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (PlanePiece& part : parts_of(scan, planes.fits[k], points[k], kGapM, anchor))
      parts.push_back(std::move(part));
  }
  return parts;
}

/// A plane per piece.
PlaneLabels labelled_planes(const Scan& scan, const std::vector<PlanePiece>& pieces, const Vector3d& anchor,
                            double threshold_m) {
  PlaneLabels planes;
  planes.inlier_threshold_m = threshold_m;
  planes.labels = labels_with(std::vector<std::int32_t>(scan.size(), -1), pieces);
  for (const PlanePiece& piece : pieces) {
    PlaneFit fit = fit_plane(piece.moments);
    fit.plane = shifted(fit.plane, -anchor);
    fit.centroid += anchor;
    planes.fits.push_back(fit);
  }
  return planes;
}

}  // namespace

void FineOptions::check() const {
  if (!(noise_m >= 0)) throw_bad_option("noise_m", noise_m, "0 or more");
  if (!(drift_m >= 0)) throw_bad_option("drift_m", drift_m, "0 or more");
  if (min_inliers < 3) throw_bad_option("min_inliers", min_inliers, "3 or more");
}

PlaneLabels fine_planes(const Scan& scan, const PlaneLabels& planes, const FineOptions& options) {
  options.check();
  if (planes.fits.empty()) return planes;
  const auto least = static_cast<std::size_t>(options.min_inliers);
  const Vector3d anchor = planes.fits.front().centroid;
  JoinOptions join;
  join.noise_m = std::max(kLeastNoiseM, options.noise_m);
  join.drift_m = options.drift_m;
  const double threshold_m = planes.inlier_threshold_m;
  std::vector<PlanePiece> pieces = joined_pieces(hanging_parts(scan, planes, anchor), join);
  std::erase_if(pieces, [&](const PlanePiece& piece) { return piece.points.size() < least; });
  const PlaneLabels apart = labelled_planes(scan, pieces, anchor, threshold_m);
  SheetOptions sheets;
  sheets.threshold_m = std::min(threshold_m, kNoisesOfThreshold * join.noise_m);
  sheets.min_inliers = options.min_inliers;
  for (PlanePiece& sheet : relief_sheets(scan, apart, anchor, sheets)) pieces.push_back(std::move(sheet));
  pieces = joined_pieces(std::move(pieces), join);
  return with_strips(scan, labelled_planes(scan, pieces, anchor, threshold_m),
                     {.threshold_m = sheets.threshold_m});
}

}  // namespace limen
