// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limen/extract/openings/opening_rectangles.h"

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

/// Openings behind curtains: where something in folds hangs a little before the wall, with wall seen round it
/// and below, the wall is taken to have an opening. Curtains overhang: the rectangle is the curtain's less a
/// hand's breadth, its sides known to about ten centimetres.
std::vector<OpeningRectangle> curtained_rectangles(const Scan& scan, const WallEvidence& evidence,
                                                   const OpeningGrid& grid, double noise_m,
                                                   const OpeningOptions& options);

/// A rectangle of a wall and what is seen of the frame in it.
struct FramedRectangle {
  OpeningRectangle rectangle;
  std::optional<double> front_m;            ///< as front_depth() says
  std::array<SideSeparator, 2> inner = {};  ///< of the frame's right and left bar, towards the pane; outwards
};

/// Where the upright bars of a frame end towards the pane.
std::array<SideSeparator, 2> frame_edges(const Scan& scan, const WallEvidence& evidence,
                                         const OpeningGrid& grid, const OpeningRectangle& rectangle,
                                         double front_m);

/// Frames of a wall that lie equally deep are often equally wide. Where the windows say so, each upright side
/// is placed again by its frame's inner edge and the width of the other windows.
void share_frame_widths(std::vector<FramedRectangle>& windows);

/// The side surface of an opening (reveal, lintel, sill) as far as its points show.
struct Reveal {
  bool found = false;
  double place = 0.0;          ///< of the side at the wall's face, in the wall's frame
  double sigma_m = 1.0;        ///< one standard deviation of it
  double depth_m = 0.0;        ///< how far behind the wall's face it was seen
  double depth_sigma_m = 0.0;  ///< one standard deviation of its end, where complete
  bool complete = false;       ///< rays passed just beyond the end: it ends there
};

/// The reveals of a rectangle in the order of `kSides`, from the points whose rays crossed the wall in it.
/// `noise_m`: one standard deviation of the points; `front_m`: as front_depth() says.
std::array<Reveal, 4> find_reveals(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                   const OpeningRectangle& rectangle, double noise_m,
                                   std::optional<double> front_m);

/// The outline of an opening that is clearly no rectangle.
struct OpeningOutline {
  Ring ring;           ///< in the wall's frame, counter-clockwise; empty: a rectangle describes it
  Box2 box;            ///< its upright rectangle
  bool round = false;  ///< bent all round, not only at the head
};

/// Looks at the corners of a rectangle: where wall fills two of them (an arch) or all four (a round window)
/// the outline is followed all round, direction by direction from the middle, each time to where open samples
/// and wall part best.
OpeningOutline find_outline(const WallEvidence& evidence, const OpeningGrid& grid,
                            const OpeningRectangle& rectangle);

/// How far behind the wall's face that which stands in an opening nearest to it: a frame, a pane or a
/// blind. Before it lie only the opening's own sides, and those reach as far as it does. None where nothing
/// lies within `kMaxFront_m`.
std::optional<double> front_depth(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                  const OpeningRectangle& rectangle);
constexpr double kMaxFront_m = 0.4;

/// Places the sides again by what passed before them on the way to the front: a ray that goes outwards proves
/// more of the wall open than where it met the face.
void narrow_sides(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid, double front_m,
                  OpeningRectangle& rectangle);

}  // namespace limen
