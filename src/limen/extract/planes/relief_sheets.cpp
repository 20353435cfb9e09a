// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/relief_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace limen {
namespace {

constexpr double kWallWithReliefM2 = 6.0;  // area of a wall whose relief is looked at
constexpr double kWallWithReliefM = 1.0;   // and its narrower side
constexpr double kReliefBeforeM = 1.0;     // how far the relief protrudes
constexpr double kReliefBehindM = 0.8;     // and how deep the openings are
constexpr double kAsideM = 0.5;            // beyond the wall's own points
constexpr double kPureShare = 0.85;        // of a sheet's points, that its surroundings do not explain
constexpr std::size_t kBins = 4;           // of the histogram of offsets, per threshold
constexpr double kPatchM = 0.5;     // edge of the squares in which a sheet is denser than what lies beside it
constexpr std::size_t kDenser = 3;  // times: a square's slab against what lies beside it
constexpr double kUprightSine = 0.17;  // walls: at most so much of the normal is up
constexpr int kRefits = 2;
constexpr double kAlongAxis = 0.97;

/// A wall with its three directions and the box of its relief, in its own coordinates.
struct WallSpace {
  Vector3d origin = Vector3d::Zero();
  std::array<Vector3d, 3> axes{};  ///< outwards, up, along
  Vector3d low = Vector3d::Zero();
  Vector3d high = Vector3d::Zero();

  [[nodiscard]] Vector3d of(const Vector3d& x) const {
    const Vector3d p = x - origin;
    return {axes[0].dot(p), axes[1].dot(p), axes[2].dot(p)};
  }
  [[nodiscard]] bool holds(const Vector3d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// Up, as far as it is known: of a level frame, else that of the largest plane across the wall.
Vector3d up_for(const Scan& scan, const PlaneLabels& planes, const Vector3d& normal) {
  if (scan.level) return Vector3d::UnitZ();
  for (const PlaneFit& fit : planes.fits) {
    if (std::abs(fit.plane.normal.dot(normal)) < 0.5 * kUprightSine) return fit.plane.normal;
  }
  return normal.unitOrthogonal();
}

bool is_wall(const PlaneFit& fit) {
  return 12.0 * std::sqrt(fit.variances[1] * fit.variances[2]) >= kWallWithReliefM2 &&
         std::sqrt(12.0 * fit.variances[1]) >= kWallWithReliefM;
}

std::optional<WallSpace> wall_space(const Scan& scan, const PlaneLabels& planes, std::size_t k,
                                    const std::vector<std::uint32_t>& points) {
  const PlaneFit& fit = planes.fits[k];
  if (points.empty() || !is_wall(fit)) return std::nullopt;
  const Vector3d up = up_for(scan, planes, fit.plane.normal);
  if (std::abs(up.dot(fit.plane.normal)) > kUprightSine) return std::nullopt;
  WallSpace wall;
  wall.origin = fit.plane.project(fit.centroid);
  const bool towards = fit.plane.signed_distance(scan.centre(points.front())) > 0.0;
  wall.axes[0] = towards ? fit.plane.normal : Vector3d(-fit.plane.normal);
  wall.axes[1] = (up - up.dot(wall.axes[0]) * wall.axes[0]).normalized();
  wall.axes[2] = wall.axes[0].cross(wall.axes[1]);
  wall.low = wall.high = wall.of(scan.points[points.front()]);
  for (const std::uint32_t i : points) {
    const Vector3d p = wall.of(scan.points[i]);
    wall.low = wall.low.cwiseMin(p);
    wall.high = wall.high.cwiseMax(p);
  }
  wall.low.array() -= kAsideM;
  wall.high.array() += kAsideM;
  wall.low[0] = -kReliefBehindM;
  wall.high[0] = kReliefBeforeM;
  return wall;
}

/// A point near a wall: its place in the wall's space.
struct ReliefPoint {
  std::uint32_t index = 0;
  const Vector3d* tail = nullptr;  ///< normal of the plane whose noise may have brought it here
  Vector3d at = Vector3d::Zero();
};

/// Counts of offsets, and the places where there are many more than on either side.
class OffsetCounts {
 public:
  OffsetCounts(double low, double high, double threshold_m)
      : low_(low - 8.0 * threshold_m), step_(threshold_m / static_cast<double>(kBins)) {
    sums_.assign(static_cast<std::size_t>((high - low + 16.0 * threshold_m) / step_) + 2, 0);
  }
  void add(double offset) { ++sums_[bin_of(offset) + 1]; }
  void finish() { std::partial_sum(sums_.begin(), sums_.end(), sums_.begin()); }

  /// Offsets where the slab holds at least `least` points beyond those of the emptier side, largest first.
  [[nodiscard]] std::vector<double> peaks(int least, double min_pure) const {
    std::vector<std::pair<int, std::size_t>> found;
    for (std::size_t i = 3 * kBins + 1; i + 3 * kBins + 2 < sums_.size(); ++i) {
      const int in = count(i - kBins, i + kBins);
      const int beside = std::min(count(i - 3 * kBins, i - kBins), count(i + kBins, i + 3 * kBins));
      if (in - beside >= least && in - beside >= min_pure * in) found.emplace_back(beside - in, i);
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> taken;
    for (const auto& [score, i] : found) {
      const auto near = [i = i](std::size_t j) { return (i > j ? i - j : j - i) < 2 * kBins; };
      if (std::none_of(taken.begin(), taken.end(), near)) taken.push_back(i);
    }
    std::vector<double> offsets;
    for (const std::size_t i : taken) offsets.push_back(low_ + step_ * static_cast<double>(i));
    return offsets;
  }

 private:
  [[nodiscard]] std::size_t bin_of(double offset) const {
    return static_cast<std::size_t>(std::max(0.0, (offset - low_) / step_));
  }
  [[nodiscard]] int count(std::size_t begin, std::size_t end) const { return sums_[end] - sums_[begin]; }

  double low_;
  double step_;
  std::vector<int> sums_;
};

/// Looks for the sheets of one wall along one of its directions.
class SheetSearch {
 public:
  SheetSearch(const Scan& scan, const WallSpace& wall, const Vector3d& anchor, const SheetOptions& options)
      : scan_(scan), wall_(wall), anchor_(anchor), o_(options) {}

  /// Sheets seen from the side that `sign` names; their points are taken from `free`.
  std::vector<PlanePiece> run(const std::vector<ReliefPoint>& free, std::size_t axis, double sign,
                              std::vector<char>& taken) const {
    std::vector<ReliefPoint> seen;
    OffsetCounts counts(wall_.low[static_cast<int>(axis)], wall_.high[static_cast<int>(axis)],
                        o_.threshold_m);
    for (const ReliefPoint& point : free) {
      const double towards = wall_.axes[axis].dot(scan_.centre(point.index) - scan_.points[point.index]);
      if (taken[point.index] != 0 || sign * towards <= 0.0) continue;
      if (point.tail != nullptr && std::abs(point.tail->dot(wall_.axes[axis])) > kAlongAxis) continue;
      seen.push_back(point);
      counts.add(point.at[static_cast<int>(axis)]);
    }
    counts.finish();
    std::vector<PlanePiece> sheets;
    for (const double offset : counts.peaks(o_.min_inliers, kPureShare)) {
      PlanePiece sheet = sheet_at(seen, axis, offset, taken);
      if (sheet.points.size() < static_cast<std::size_t>(o_.min_inliers)) continue;
      for (const std::uint32_t i : sheet.points) taken[i] = 1;
      sheets.push_back(std::move(sheet));
    }
    return sheets;
  }

 private:
  /// In a square of a sheet: points within the threshold, and within twice that, but not the threshold.
  struct Patch {
    std::vector<std::uint32_t> in;
    std::size_t beside = 0;
  };

  [[nodiscard]] PlanePiece sheet_at(const std::vector<ReliefPoint>& seen, std::size_t axis, double offset,
                                    const std::vector<char>& taken) const {
    Plane plane{wall_.axes[axis], wall_.axes[axis].dot(wall_.origin) + offset};
    PlanePiece sheet;
    for (int k = 0; k <= kRefits; ++k) {
      sheet = denser(seen, axis, plane, taken);
      if (sheet.points.size() < static_cast<std::size_t>(o_.min_inliers)) return {};
      if (k < kRefits) plane = refitted(sheet, plane);
    }
    return sheet;
  }

  /// The sheet moves to the middle of its points; it turns where they are spread enough to tell.
  [[nodiscard]] Plane refitted(const PlanePiece& sheet, const Plane& plane) const {
    constexpr double kMaxTurnCosine = 0.9998;  // 1.1 degrees
    const Plane fitted = shifted(fit_plane(sheet.moments).plane, -anchor_);
    if (std::abs(fitted.normal.dot(plane.normal)) > kMaxTurnCosine) return fitted;
    return {plane.normal, plane.normal.dot(sheet.moments.mean() + anchor_)};
  }

  [[nodiscard]] PlanePiece denser(const std::vector<ReliefPoint>& seen, std::size_t axis, const Plane& plane,
                                  const std::vector<char>& taken) const {
    std::map<std::pair<int, int>, Patch> patches;
    const int u = axis == 0 ? 1 : 0;
    const int v = axis == 2 ? 1 : 2;
    for (const ReliefPoint& point : seen) {
      const double off = std::abs(plane.signed_distance(scan_.points[point.index]));
      if (off > 2.0 * o_.threshold_m || taken[point.index] != 0) continue;
      Patch& patch = patches[{static_cast<int>(std::floor(point.at[u] / kPatchM)),
                              static_cast<int>(std::floor(point.at[v] / kPatchM))}];
      if (off <= o_.threshold_m) patch.in.push_back(point.index);
      if (off > o_.threshold_m) ++patch.beside;
    }
    std::vector<std::uint32_t> kept;
    std::size_t beside = 0;
    for (const auto& [place, patch] : patches) {
      if (patch.in.size() <= kDenser * patch.beside) continue;
      kept.insert(kept.end(), patch.in.begin(), patch.in.end());
      beside += patch.beside;
    }
    if (static_cast<double>(beside) > (1.0 - kPureShare) * static_cast<double>(kept.size())) return {};
    std::sort(kept.begin(), kept.end());
    return piece_of(scan_, std::move(kept), anchor_);
  }

  const Scan& scan_;
  const WallSpace& wall_;
  const Vector3d& anchor_;
  const SheetOptions& o_;
};

}  // namespace

std::vector<PlanePiece> relief_sheets(const Scan& scan, const PlaneLabels& planes, const Vector3d& anchor,
                                      const SheetOptions& options, const std::vector<std::int32_t>& tails) {
  if (!scan.centre_known()) return {};
  std::vector<char> taken(scan.size(), 0);
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = planes.labels[i] >= 0 ? 1 : 0;
  const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
  std::vector<std::uint32_t> loose;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (taken[i] == 0) loose.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<PlanePiece> sheets;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::optional<WallSpace> wall = wall_space(scan, planes, k, points[k]);
    if (!wall) continue;
    std::vector<ReliefPoint> free;
    for (const std::uint32_t i : loose) {
      if (taken[i] != 0) continue;
      const Vector3d at = wall->of(scan.points[i]);
      if (!wall->holds(at)) continue;
      const std::int32_t tail = tails.empty() ? -1 : tails[i];
      free.push_back({i, tail < 0 ? nullptr : &planes.fits[static_cast<std::size_t>(tail)].plane.normal, at});
    }
    const SheetSearch search(scan, *wall, anchor, options);
    for (const auto& [axis, sign] :
         {std::pair<std::size_t, double>{0, 1.0}, {1, 1.0}, {1, -1.0}, {2, 1.0}, {2, -1.0}}) {
      for (PlanePiece& sheet : search.run(free, axis, sign, taken)) sheets.push_back(std::move(sheet));
    }
  }
  return sheets;
}

}  // namespace limen
