// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "limen/extract/openings/opening_grid.h"

namespace limen {

/// Deviation that says: where the side lies was not seen.
constexpr double kUnboundedSigma_m = 1.0;
/// Part of a side along which wall must be seen.
constexpr double kMinBounded = 0.5;

/// A sample's place across a side, growing outwards.
struct SideMark {
  double at = 0.0;
  bool wall = false;
};

/// Where a side lies, and how well it is known.
struct SideSeparator {
  double place = 0.0;  ///< outward coordinate
  double sigma_m = kUnboundedSigma_m;
  bool found = false;
};

/// Where the marks change from open to wall, going outwards: mean and standard deviation of the place given
/// all marks, each wrong with a small probability, every place in [from, to] as likely before. The search
/// ends where a pier has clearly been met.
SideSeparator separate(std::vector<SideMark> marks, double from, double to);

/// The sides of a rectangle in a wall, in the order of Opening::edge_sigma_m.
enum class Side : std::uint8_t { bottom, right, top, left };
constexpr std::array<Side, 4> kSides = {Side::bottom, Side::right, Side::top, Side::left};

/// 0 where the side's place is a coordinate u (right, left), 1 where it is v.
constexpr Eigen::Index axis_of(Side side) {
  return side == Side::left || side == Side::right ? 0 : 1;
}
/// +1 where the outside of the rectangle has the greater coordinate.
constexpr double outward(Side side) {
  return side == Side::right || side == Side::top ? 1.0 : -1.0;
}
inline double place_of(const Box2& box, Side side) {
  return outward(side) > 0.0 ? box.high[axis_of(side)] : box.low[axis_of(side)];
}
inline void set_place(Box2& box, Side side, double place) {
  (outward(side) > 0.0 ? box.high : box.low)[axis_of(side)] = place;
}

/// An upright rectangle in a wall, and how well its sides are known.
struct OpeningRectangle {
  Box2 box;
  std::array<double, 4> sigma_m = {1.0, 1.0, 1.0, 1.0};
  std::array<double, 4> bounded = {};  ///< part of each side along which wall is seen beyond it
  std::size_t evidence = 0;            ///< open samples inside
  std::size_t through = 0;             ///< of these, from far behind the wall
  double fill = 0.0;                   ///< open part of the cells that are open or wall
  double known = 0.0;                  ///< part of the cells that are open
  bool curtain = false;                ///< made of what hangs before the wall
};

/// Rectangles about the open regions of a wall: each side where it parts the open samples inside from the
/// wall's outside with the fewest on the wrong side.
std::vector<OpeningRectangle> opening_rectangles(const WallEvidence& evidence, const OpeningGrid& grid,
                                                 const OpeningOptions& options);

/// Counts what lies inside and along the sides of the rectangle's box.
OpeningRectangle measured(OpeningRectangle rectangle, const WallEvidence& evidence, const OpeningGrid& grid,
                          const OpeningOptions& options);

}  // namespace limen
