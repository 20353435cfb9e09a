// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/claim_strips.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr double kSquareM = 0.5;
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

std::vector<SeenPlane> seen_planes(const Scan& scan, const PlaneLabels& planes, double aside_m) {
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
    plane.low.array() -= aside_m;
    plane.high.array() += aside_m;
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

void StripOptions::check() const {
  if (!(threshold_m > 0)) throw_bad_option("threshold_m", threshold_m, "more than 0");
  if (!(aside_m >= 0)) throw_bad_option("aside_m", aside_m, "0 or more");
}

PlaneLabels with_strips(const Scan& scan, const PlaneLabels& planes, const StripOptions& options) {
  options.check();
  if (!scan.centre_known()) return planes;
  const std::vector<SeenPlane> seen = seen_planes(scan, planes, options.aside_m);
  std::vector<std::uint32_t> free;
  for (std::size_t i = 0; i < planes.labels.size(); ++i) {
    if (planes.labels[i] < 0) free.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::vector<std::uint32_t>> strips(seen.size());
  parallel_for(seen.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
    strips[k] = strips_of(scan, seen[k], free, options.threshold_m);
  });
  PlaneLabels more = planes;
  for (std::size_t k = 0; k < strips.size(); ++k) {
    for (const std::uint32_t i : strips[k]) {
      if (more.labels[i] < 0) more.labels[i] = static_cast<std::int32_t>(k);
    }
  }
  return more;
}

}  // namespace limen
