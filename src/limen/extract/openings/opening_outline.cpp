// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "limen/extract/openings/opening_rectangles.h"
#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kArchRise_m = 0.6;    // an arch may rise this far above what its sides suggest
constexpr double kCornerShare = 0.2;   // of the shorter side: the corners that are looked at
constexpr double kWallInCorner = 0.4;  // of a corner's samples
constexpr std::size_t kMinInCorner = 6;
constexpr int kDirections = 64;
constexpr double kMaxSigma_m = 0.08;  // of the outline, on average
constexpr double kTolerance_m = 0.01;

struct Sample {
  Vector2d at;
  bool wall = false;
};

std::vector<Sample> samples_about(const WallEvidence& evidence, const OpeningGrid& grid, Box2 box) {
  box.low.array() -= kArchRise_m;
  box.high.array() += kArchRise_m;
  std::vector<Sample> samples;
  for (const std::uint32_t i : grid.samples_in(box)) {
    const WallSample& sample = evidence.samples[i];
    if (sample.kind != SampleKind::cover)
      samples.push_back({{sample.u, sample.v}, sample.kind == SampleKind::wall});
  }
  for (int r = grid.row(box.low.y()); r <= grid.row(box.high.y()); ++r) {
    for (int c = grid.column(box.low.x()); c <= grid.column(box.high.x()); ++c) {
      if (grid.at(c, r) == OpeningGrid::Cell::silent) samples.push_back({grid.middle(c, r), false});
    }
  }
  return samples;
}

/// The box's sides where a narrow strip through its middle meets wall: the top of an arch, not its shoulders.
Box2 middle_extent(const std::vector<Sample>& samples, const Box2& box) {
  constexpr double kStrip = 0.12;  // half width, of the box
  Box2 extent = box;
  const Vector2d middle = 0.5 * (box.low + box.high);
  const Vector2d size = box.high - box.low;
  for (const Side side : kSides) {
    const Eigen::Index axis = axis_of(side);
    std::vector<SideMark> marks;
    for (const Sample& sample : samples) {
      if (std::abs(sample.at[1 - axis] - middle[1 - axis]) > kStrip * size[1 - axis]) continue;
      const double t = outward(side) * (sample.at[axis] - middle[axis]);
      if (t > 0.0) marks.push_back({t, sample.wall});
    }
    const double reach = 0.5 * size[axis] + kArchRise_m;
    const SideSeparator found = separate(std::move(marks), 0.0, reach);
    if (found.found && found.sigma_m < kUnboundedSigma_m)
      set_place(extent, side, middle[axis] + outward(side) * found.place);
  }
  return extent;
}

/// For lower left, lower right, upper right, upper left whether wall fills the corner.
std::array<bool, 4> walled_corners(const std::vector<Sample>& samples, const Box2& box) {
  const double size = kCornerShare * (box.high - box.low).minCoeff();
  std::array<std::size_t, 4> wall{};
  std::array<std::size_t, 4> all{};
  for (const Sample& sample : samples) {
    if (!box.contains(sample.at)) continue;
    const bool left = sample.at.x() < box.low.x() + size;
    const bool right = sample.at.x() > box.high.x() - size;
    const bool low = sample.at.y() < box.low.y() + size;
    const bool high = sample.at.y() > box.high.y() - size;
    if (!(left || right) || !(low || high)) continue;
    const std::size_t corner = low ? (left ? 0 : 1) : (right ? 2 : 3);
    ++all[corner];
    wall[corner] += sample.wall ? 1 : 0;
  }
  std::array<bool, 4> walled{};
  for (std::size_t k = 0; k < 4; ++k) {
    walled[k] =
        all[k] >= kMinInCorner && static_cast<double>(wall[k]) > kWallInCorner * static_cast<double>(all[k]);
  }
  return walled;
}

/// The outline about `middle`: in each direction where open and wall part, by the samples in its wedge.
Ring follow(const std::vector<Sample>& samples, const Box2& box) {
  const Vector2d middle = 0.5 * (box.low + box.high);
  const double reach = 0.5 * (box.high - box.low).norm() + 0.2;
  std::array<std::vector<SideMark>, kDirections> wedges;
  for (const Sample& sample : samples) {
    const Vector2d ray = sample.at - middle;
    const double turn = (std::atan2(ray.y(), ray.x()) + std::numbers::pi) / (2.0 * std::numbers::pi);
    const int wedge = std::min(kDirections - 1, static_cast<int>(turn * kDirections));
    if (ray.norm() < reach) wedges[static_cast<std::size_t>(wedge)].push_back({ray.norm(), sample.wall});
  }
  Ring ring;
  double sigmas = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kDirections - std::numbers::pi;
    const Vector2d along(std::cos(angle), std::sin(angle));
    const SideSeparator found = separate(std::move(wedges[static_cast<std::size_t>(k)]), 0.0, reach);
    // Beyond the box nothing of the opening can lie: a door's foot, a hidden side.
    double radius = 1e9;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const double half = 0.5 * (box.high - box.low)[axis];
      if (std::abs(along[axis]) > 1e-9) radius = std::min(radius, half / std::abs(along[axis]));
    }
    if (found.found && found.sigma_m < kUnboundedSigma_m) {
      radius = std::min(radius, found.place);
      sigmas += found.sigma_m;
    }
    ring.push_back(middle + radius * along);
  }
  return sigmas <= kMaxSigma_m * kDirections ? simplify_ring(ring, kTolerance_m) : Ring{};
}

}  // namespace

OpeningOutline find_outline(const WallEvidence& evidence, const OpeningGrid& grid,
                            const OpeningRectangle& rectangle) {
  const std::vector<Sample> samples = samples_about(evidence, grid, rectangle.box);
  Box2 box = middle_extent(samples, rectangle.box);
  const std::array<bool, 4> walled = walled_corners(samples, box);
  const bool arched = walled[2] && walled[3];
  const bool round = arched && walled[0] && walled[1];
  if (!arched) return {};
  if (!round) {
    // Only the head is bent: the sides and the foot stay where long edges put them.
    box.low = rectangle.box.low;
    box.high.x() = rectangle.box.high.x();
  }
  OpeningOutline outline{follow(samples, box), box, round};
  if (outline.ring.size() < 5) return {};
  return outline;
}

}  // namespace limen
