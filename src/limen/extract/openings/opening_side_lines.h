// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace limen {

constexpr double kSideMaxSlope = 0.5;   ///< of splayed sides, metres per metre
constexpr double kSideFloor_m = 0.002;  ///< no side is known better

/// A point seen through the opening, as one of its sides sees it.
struct SidePoint {
  double across = 0.0;   ///< of the point, growing outwards
  double crossed = 0.0;  ///< of its ray on the wall's face
  double depth = 0.0;    ///< behind the wall's face

  /// Tangent of the angle at which the ray meets a side of this slope.
  [[nodiscard]] double graze(double slope) const { return (across - crossed) / depth - slope; }
};

/// `across` over `depth` of a side: its place at the wall's face and how it is splayed.
struct SideLine {
  double place = 0.0;
  double slope = 0.0;
  double score = 0.0;
};

struct FittedSideLine {
  SideLine line;
  double sigma_m = 1.0;
};

/// The side through points at most depths, within `width_m`; with `splayed`, straight unless a splayed one is
/// clearly better.
SideLine find_side_line(const std::vector<SidePoint>& points, double width_m, bool splayed);

/// Least squares over the points near the line; a straight side keeps its direction. Frames and stray points
/// pass for a side: its deviation is that of points anywhere within `width_m`.
FittedSideLine refined_side_line(const std::vector<SidePoint>& points, const SideLine& line, double width_m);

/// The points within a distance of the line whose rays do not run along it.
std::vector<SidePoint> near_side_line(const std::vector<SidePoint>& points, const SideLine& line,
                                      double within_m);

/// Depths that differ among the points.
std::size_t side_depths(const std::vector<SidePoint>& points);

}  // namespace limen
