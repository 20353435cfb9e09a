// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include "limen/extract/openings/opening_rectangles.h"
#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kFrontStart_m = 0.015;  // nearer to the face all is the wall's own
constexpr double kFrontLayer_m = 0.015;  // in which what faces the scanner lies
constexpr double kFrontRim_m = 0.025;    // along the sides, which are no frame
constexpr std::size_t kFrontPoints = 6;
constexpr double kNarrowReach_m = 0.3;  // of a side from where it was found first
constexpr double kBeforeFront_m = 0.008;
constexpr double kNarrowTrim = 0.12;  // of a side's length that is left out at either corner
constexpr double kFrontShare = 0.02;  // of all points in the opening

/// Samples about an opening with the place that each of them proves to be open: a ray that goes outwards
/// passed before the side as far as the front, which the side reaches.
class Narrower {
 public:
  Narrower(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid, double front_m,
           const Box2& box)
      : box_(box) {
    Box2 around = box;
    around.low.array() -= kNarrowReach_m;
    around.high.array() += kNarrowReach_m;
    for (const std::uint32_t i : grid.samples_in(around)) {
      const WallSample& sample = evidence.samples[i];
      if (sample.kind == SampleKind::cover) continue;
      const Vector2d crossed(sample.u, sample.v);
      Vector2d reached = crossed;
      const double depth_m = static_cast<double>(sample.depth_m);
      // What ends before the front is a side, or blends two surfaces at one: where it is, is asked elsewhere.
      if (sample.kind != SampleKind::wall && depth_m > front_m - kBeforeFront_m) {
        reached = evidence.wall.frame.to_plane(scan.points[sample.point]);
        if (depth_m > front_m + kFrontLayer_m) reached = crossed + front_m / depth_m * (reached - crossed);
      }
      marks_.push_back({crossed, reached, sample.kind == SampleKind::wall});
    }
  }

  [[nodiscard]] SideSeparator find(Side side, double reach_m) const {
    const Eigen::Index axis = axis_of(side);
    const Eigen::Index other = 1 - axis;
    const double trim_m = kNarrowTrim * (box_.high[other] - box_.low[other]);
    const double low = box_.low[other] + trim_m;
    const double high = box_.high[other] - trim_m;
    const double sign = outward(side);
    const double at = sign * place_of(box_, side);
    const double from = at - std::min(reach_m, 0.5 * (box_.high[axis] - box_.low[axis]));
    const double to = at + reach_m;
    std::vector<SideMark> marks;
    for (const Mark& mark : marks_) {
      if (mark.crossed[other] < low || mark.crossed[other] > high) continue;
      const double t = std::max(sign * mark.crossed[axis], sign * mark.reached[axis]);
      if (t >= from && t <= to) marks.push_back({t, mark.wall});
    }
    return separate(std::move(marks), from, to);
  }

 private:
  struct Mark {
    Vector2d crossed;
    Vector2d reached;
    bool wall;
  };

  const Box2& box_;
  std::vector<Mark> marks_;
};

}  // namespace

std::optional<double> front_depth(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                  const OpeningRectangle& rectangle) {
  Box2 inside = rectangle.box;
  for (const Side side : kSides) {
    const double sigma_m = rectangle.sigma_m[static_cast<std::size_t>(side)];
    const double rim_m = std::max(kFrontRim_m, 2.0 * std::min(sigma_m, 0.05));
    set_place(inside, side, place_of(inside, side) - outward(side) * rim_m);
  }
  if (inside.empty()) return std::nullopt;
  std::vector<double> depths;
  std::size_t all = 0;
  for (const std::uint32_t i : grid.samples_in(rectangle.box)) {
    const WallSample& sample = evidence.samples[i];
    if (sample.kind != SampleKind::open && sample.kind != SampleKind::shallow) continue;
    ++all;
    const double depth_m = static_cast<double>(sample.depth_m);
    if (depth_m < kFrontStart_m || depth_m > kMaxFront_m + kFrontLayer_m) continue;
    if (inside.contains(evidence.wall.frame.to_plane(scan.points[sample.point]))) depths.push_back(depth_m);
  }
  std::sort(depths.begin(), depths.end());
  const auto enough =
      std::max(kFrontPoints, static_cast<std::size_t>(kFrontShare * static_cast<double>(all)));
  for (std::size_t i = 0; i + enough <= depths.size(); ++i) {
    if (depths[i + enough - 1] - depths[i] > kFrontLayer_m) continue;
    const auto end = std::upper_bound(depths.begin(), depths.end(), depths[i] + kFrontLayer_m);
    return depths[(i + static_cast<std::size_t>(end - depths.begin())) / 2];
  }
  return std::nullopt;
}

void narrow_sides(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid, double front_m,
                  OpeningRectangle& rectangle) {
  const Narrower narrower(scan, evidence, grid, front_m, rectangle.box);
  for (const Side side : kSides) {
    double& sigma_m = rectangle.sigma_m[static_cast<std::size_t>(side)];
    if (sigma_m >= kUnboundedSigma_m) continue;
    const SideSeparator found = narrower.find(side, std::min(kNarrowReach_m, 3.0 * sigma_m + 0.02));
    if (!found.found || found.sigma_m >= kUnboundedSigma_m) continue;
    set_place(rectangle.box, side, outward(side) * found.place);
    sigma_m = found.sigma_m;
  }
}

}  // namespace limen
