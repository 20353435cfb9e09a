// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/fine_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/extract/planes/join_pieces.h"
#include "limen/extract/planes/relief_sheets.h"

namespace limen {
namespace {

constexpr double kSquareM = 0.5;
constexpr double kStripAsideM = 0.5;   // how far beyond a plane's points its strips are looked for
constexpr std::size_t kFewest = 4;     // points of a square that make a strip
constexpr std::size_t kTimesMore = 3;  // than beside it

/// A plane with the box of its points and the side it was seen from.
struct SeenPlane {
  Plane plane;
  PlaneFrame frame;
  Vector2d low = Vector2d::Constant(1e300);
  Vector2d high = Vector2d::Constant(-1e300);
  double towards = 0.0;  ///< more than 0: seen from where its normal points

  void add(const Vector3d& x, double centre_above) {
    const Vector2d p = frame.to_plane(x);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    towards += centre_above > 0.0 ? 1.0 : -1.0;
  }
};

std::vector<SeenPlane> seen_planes(const Scan& scan, const PlaneLabels& planes) {
  std::vector<SeenPlane> seen(planes.fits.size());
  for (std::size_t k = 0; k < seen.size(); ++k) {
    seen[k].plane = planes.fits[k].plane;
    seen[k].frame = make_frame(planes.fits[k].plane, planes.fits[k].centroid);
  }
  for (std::size_t i = 0; i < planes.labels.size(); ++i) {
    if (planes.labels[i] < 0) continue;
    SeenPlane& plane = seen[static_cast<std::size_t>(planes.labels[i])];
    plane.add(scan.points[i], plane.plane.signed_distance(scan.centre(i)));
  }
  for (SeenPlane& plane : seen) {
    plane.low.array() -= kStripAsideM;
    plane.high.array() += kStripAsideM;
  }
  return seen;
}

/// The free points that are strips of one plane, ascending.
std::vector<std::uint32_t> strips_of(const Scan& scan, const SeenPlane& seen,
                                     const std::vector<std::uint32_t>& free, double threshold_m) {
  struct Square {
    std::vector<std::uint32_t> in;
    std::size_t beside = 0;
  };
  std::map<std::pair<int, int>, Square> squares;
  for (const std::uint32_t i : free) {
    const double off = std::abs(seen.plane.signed_distance(scan.points[i]));
    if (off > 2.0 * threshold_m) continue;
    const Vector2d p = seen.frame.to_plane(scan.points[i]);
    if ((p.array() < seen.low.array()).any() || (p.array() > seen.high.array()).any()) continue;
    Square& square = squares[{static_cast<int>(std::floor(p.x() / kSquareM)),
                              static_cast<int>(std::floor(p.y() / kSquareM))}];
    const bool alike = seen.plane.signed_distance(scan.centre(i)) * seen.towards > 0.0;
    if (off <= threshold_m && alike) square.in.push_back(i);
    if (off > threshold_m) ++square.beside;
  }
  std::vector<std::uint32_t> strips;
  for (const auto& [place, square] : squares) {
    if (square.in.size() >= kFewest && square.in.size() > kTimesMore * square.beside)
      strips.insert(strips.end(), square.in.begin(), square.in.end());
  }
  return strips;
}

}  // namespace

PlaneLabels with_strips(const Scan& scan, const PlaneLabels& planes, double threshold_m) {
  if (!scan.centre_known()) return planes;
  const std::vector<SeenPlane> seen = seen_planes(scan, planes);
  std::vector<std::uint32_t> free;
  for (std::size_t i = 0; i < planes.labels.size(); ++i) {
    if (planes.labels[i] < 0) free.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::vector<std::uint32_t>> strips(seen.size());
  parallel_for(seen.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
    strips[k] = strips_of(scan, seen[k], free, threshold_m);
  });
  PlaneLabels more = planes;
  for (std::size_t k = 0; k < strips.size(); ++k) {
    for (const std::uint32_t i : strips[k]) {
      if (more.labels[i] < 0) more.labels[i] = static_cast<std::int32_t>(k);
    }
  }
  return more;
}

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

PlaneLabels fine_planes(const Scan& scan, const PlaneLabels& planes, const FineOptions& options) {
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
  return with_strips(scan, labelled_planes(scan, pieces, anchor, threshold_m), sheets.threshold_m);
}

}  // namespace limen
