// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Openings of walls: Djahel, Vallet, Monasse, "Detecting openings for indoor/outdoor registration", 2022,
// sections 2.2 (evidence by ray tracing) and 2.3 (components and their rectangles).
//
// Departures from the printed text:
// - every wall that a ray meets from its seen side counts, not only the first one; the depth behind the
// wall
//   that makes a crossing is measured along the wall's normal (`min_depth_m`), not along the ray;
// - evidence against an opening counts as much as evidence for it: the wall's own points. Where neither was
//   seen (trees, cars, wide gaps between scan lines) nothing is said;
// - components are those of a raster in which each cell says what the nearest ray says, not of a distance
//   threshold between crossings: the spacing of a mobile scan differs by direction and by height;
// - the rectangle is upright: one axis is the vertical projected into the wall. Its sides are where they best
//   part crossings from wall, not at the extreme crossings, or where the opening's side surfaces (reveals)
//   meet the wall's face; each comes with a standard deviation;
// - crossings that end a little behind the wall (frames, blinds, closed doors) count as well as those that
// end
//   in the room, and directions from which a static scanner got nothing back as crossings;
// - windows whose curtain hides the wall around them are distinguished from the curtain.
#include "limen/extract/openings/openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/extract/openings/opening_evidence.h"
#include "limen/extract/openings/opening_grid.h"
#include "limen/extract/openings/opening_rectangles.h"
#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kMinKnown = 0.25;        // part of a rectangle in which something was seen behind the wall
constexpr std::size_t kMinEvidence = 20;  // rays
constexpr double kMinWallRound = 0.5;
constexpr double kMinOpen = 0.7;   // seen part of the rectangle that is open
constexpr double kNiche_m = 0.25;  // shallower recesses with a flat closed back are blind, seen from outside
constexpr double kThroughShare = 0.05;
constexpr double kFoot_m = 0.15;  // a door's lower end is no higher above the foot of the wall beside it

/// Of outer walls: sides that end sooner end at a rebate or a splay.
constexpr double kThinnestFacade_m = 0.25;

/// The lowest wall beside a rectangle, within an opening's breadth; very low where there is none.
double foot_beside(const WallEvidence& evidence, const OpeningGrid& grid, const Box2& box) {
  constexpr double kBeside_m = 0.6;
  Box2 beside = box;
  beside.low -= Vector2d(kBeside_m, 2.0 * kFoot_m);
  beside.high.x() += kBeside_m;
  beside.high.y() = box.low.y() + 0.5;
  std::vector<double> heights;
  for (const std::uint32_t i : grid.samples_in(beside)) {
    const WallSample& sample = evidence.samples[i];
    if (sample.kind == SampleKind::wall && (sample.u < box.low.x() || sample.u > box.high.x()))
      heights.push_back(sample.v);
  }
  constexpr std::size_t kEnough = 5;
  if (heights.size() < kEnough) return -1e9;
  return ranked(heights, kEnough - 1);
}

/// Whether two are one hole seen in two planes of one wall (its face and its frames, a plinth and the wall
/// behind).
bool same_hole(const Opening& a, const Opening& b) {
  constexpr double kWall_m = 0.6;
  const Vector3d u = (a.corners[1] - a.corners[0]).normalized();
  const Vector3d v = (a.corners[3] - a.corners[0]).normalized();
  const Vector3d other = (b.corners[1] - b.corners[0]).normalized();
  if (u.dot(other) < 0.99) return false;
  const Vector3d between = b.middle() - a.middle();
  if (std::abs(between.dot(u.cross(v))) > kWall_m) return false;
  const auto common = [&](const Vector3d& axis, const Vector3d& a_side, const Vector3d& b_side) {
    const double a_half = 0.5 * a_side.norm();
    const double b_half = 0.5 * b_side.norm();
    const double apart = std::abs(between.dot(axis));
    return std::clamp(a_half + b_half - apart, 0.0, 2.0 * std::min(a_half, b_half)) /
           (2.0 * std::min(a_half, b_half));
  };
  // A pane between the bars of a frame lies within its window.
  constexpr double kSame = 0.5;
  return common(u, a.corners[1] - a.corners[0], b.corners[1] - b.corners[0]) > kSame &&
         common(v, a.corners[3] - a.corners[0], b.corners[3] - b.corners[0]) > kSame;
}

/// The height of the floor at an opening's foot in the wall's frame, where a level plane lies near there.
std::optional<double> floor_at(const Features& features, const OpeningWall& wall, const Box2& box) {
  constexpr double kNear_m = 0.08;
  constexpr double kMinArea_m2 = 0.5;
  constexpr double kReach_m = 0.5;  // from the floor's outline to the opening
  const Vector3d foot = wall.frame.to_space({0.5 * (box.low.x() + box.high.x()), box.low.y()});
  std::optional<double> height;
  std::size_t most = 0;
  for (const PlanarPolygon& polygon : features.planes) {
    const double slope = polygon.plane.normal.dot(wall.frame.v);
    if (std::abs(slope) < 0.995 || polygon.area_m2 < kMinArea_m2 || polygon.inliers <= most) continue;
    const double rise = -polygon.plane.signed_distance(foot) / slope;
    if (std::abs(rise) > kNear_m) continue;
    Box2 around = box_of(polygon.parts);
    around.low.array() -= kReach_m;
    around.high.array() += kReach_m;
    if (!around.contains(polygon.frame.to_plane(foot))) continue;
    most = polygon.inliers;
    height = box.low.y() + rise;
  }
  return height;
}

/// Part of the samples just outside a rectangle that lie on wall. Rays pass everywhere between the bars of a
/// fence: what is bounded by bars is no opening.
double wall_round(const WallEvidence& evidence, const OpeningGrid& grid, const Box2& box) {
  constexpr double kRim_m = 0.15;
  constexpr double kEdge_m = 0.02;
  Box2 outside = box;
  outside.low.array() -= kRim_m;
  outside.high.array() += kRim_m;
  Box2 inside = box;
  inside.low.array() -= kEdge_m;
  inside.high.array() += kEdge_m;
  double wall = 0.0;
  double open = 0.0;
  for (const std::uint32_t i : grid.samples_in(outside)) {
    const WallSample& sample = evidence.samples[i];
    if (inside.contains({sample.u, sample.v})) continue;
    wall += sample.kind == SampleKind::wall ? 1.0 : 0.0;
    open += sample.kind == SampleKind::open ? 1.0 : 0.0;
  }
  return wall / std::max(1.0, wall + open);
}

/// A recess whose back is one flat piece of wall: everything behind the face at one small depth. A window has
/// frames before its pane or blind.
bool is_niche(const WallEvidence& evidence, const OpeningGrid& grid, const Box2& box, double max_depth_m) {
  constexpr double kFlat_m = 0.03;
  constexpr double kRim_m = 0.1;  // sides, and shadows at their feet
  Box2 inside = box;
  inside.low.array() += kRim_m;
  inside.high.array() -= kRim_m;
  std::vector<float> depths;
  for (const std::uint32_t i : grid.samples_in(inside)) {
    if (evidence.samples[i].kind == SampleKind::open) depths.push_back(evidence.samples[i].depth_m);
  }
  if (depths.empty()) return false;
  std::sort(depths.begin(), depths.end());
  const float low = depths[depths.size() / 20];
  const float high = depths[depths.size() - 1 - depths.size() / 20];
  return high - low < kFlat_m && high < max_depth_m;
}

/// As large as a door and seen well, its lintel along all its width: furniture and an open leaf may hide both
/// sides.
bool is_doorway(const OpeningRectangle& rectangle) {
  constexpr std::size_t kEnough = 200;
  const Vector2d size = rectangle.box.high - rectangle.box.low;
  return size.x() > 0.6 && size.x() < 1.8 && size.y() > 1.8 && size.y() < 3.0 &&
         rectangle.evidence >= kEnough && rectangle.bounded[static_cast<std::size_t>(Side::top)] > 0.9;
}

bool acceptable(const Features& features, const OpeningRectangle& rectangle, const WallEvidence& evidence,
                const OpeningGrid& grid, const OpeningOptions& options) {
  const Vector2d size = rectangle.box.high - rectangle.box.low;
  if (size.x() < options.min_width_m || size.x() > options.max_width_m) return false;
  if (size.y() < options.min_height_m || size.y() > options.max_height_m) return false;
  if (rectangle.evidence < kMinEvidence || rectangle.fill < kMinOpen) return false;
  if (rectangle.known < kMinKnown) return false;
  if (wall_round(evidence, grid, rectangle.box) < kMinWallRound) return false;
  int bounded = 0;
  for (const double share : rectangle.bounded) bounded += share >= kMinBounded ? 1 : 0;
  const auto has = [&](Side side) {
    return rectangle.bounded[static_cast<std::size_t>(side)] >= kMinBounded;
  };
  if (bounded >= 3) return true;
  // A door ends at the floor; what has no lintel is a passage between two walls.
  const bool foot = floor_at(features, evidence.wall, rectangle.box) ||
                    rectangle.box.low.y() < foot_beside(evidence, grid, rectangle.box) + kFoot_m;
  if (!has(Side::top) || has(Side::bottom) || !foot) return false;
  return bounded == 2 || is_doorway(rectangle);
}

Opening make_opening(const OpeningRectangle& rectangle, const OpeningWall& wall) {
  Opening opening;
  const Box2& b = rectangle.box;
  opening.corners[0] = wall.frame.to_space(b.low);
  opening.corners[1] = wall.frame.to_space({b.high.x(), b.low.y()});
  opening.corners[2] = wall.frame.to_space(b.high);
  opening.corners[3] = wall.frame.to_space({b.low.x(), b.high.y()});
  opening.facade = wall.base;
  opening.evidence = rectangle.evidence;
  const double share = static_cast<double>(rectangle.through) /
                       static_cast<double>(std::max<std::size_t>(1, rectangle.evidence));
  opening.view = rectangle.curtain        ? OpeningView::hole
                 : share >= kThroughShare ? OpeningView::through
                                          : OpeningView::recess;
  for (std::size_t k = 0; k < 4; ++k) opening.edge_sigma_m[k] = std::min(1.0, rectangle.sigma_m[k]);
  return opening;
}

/// Takes the places of the sides from the reveals where they were seen, and a door's foot from the floor.
void refine_sides(const Features& features, const OpeningWall& wall, const std::array<Reveal, 4>& reveals,
                  OpeningRectangle& rectangle) {
  for (const Side side : kSides) {
    const Reveal& reveal = reveals[static_cast<std::size_t>(side)];
    double& sigma_m = rectangle.sigma_m[static_cast<std::size_t>(side)];
    if (!reveal.found || reveal.sigma_m > sigma_m) continue;
    set_place(rectangle.box, side, reveal.place);
    sigma_m = reveal.sigma_m;
  }
  constexpr double kFloorSigma_m = 0.005;
  double& foot_sigma_m = rectangle.sigma_m[static_cast<std::size_t>(Side::bottom)];
  const std::optional<double> floor = floor_at(features, wall, rectangle.box);
  if (floor && foot_sigma_m > kFloorSigma_m) {
    rectangle.box.low.y() = *floor;
    foot_sigma_m = kFloorSigma_m;
  }
}

/// The plane side of an arch or a round window would be a chord.
void drop_bent_sides(const OpeningOutline& outline, std::array<Reveal, 4>& reveals) {
  reveals[static_cast<std::size_t>(Side::top)] = {};
  if (!outline.round) return;
  reveals = {};
}

/// The wall's thickness where a side was seen to its end (the least: a door leaf may stand in line with one),
/// else how far the sides go at least: the lintel, or both the left and the right one.
void set_reveal(const std::array<Reveal, 4>& reveals, bool outside, Opening& opening) {
  constexpr double kUnknownEnd_m = 0.02;
  const auto& of = [&](Side side) -> const Reveal& { return reveals[static_cast<std::size_t>(side)]; };
  for (const Side side : {Side::left, Side::right, Side::top}) {
    const Reveal& reveal = of(side);
    // From the street a lintel may be the crown of a flat arch.
    if (outside && (side == Side::top || reveal.depth_m < kThinnestFacade_m)) continue;
    if (!reveal.complete || (opening.reveal_complete && reveal.depth_m >= opening.reveal_depth_m)) continue;
    opening.reveal_depth_m = reveal.depth_m;
    opening.reveal_sigma_m = reveal.depth_sigma_m;
    opening.reveal_complete = true;
  }
  if (opening.reveal_complete) return;
  const double both_m = std::min(of(Side::left).depth_m, of(Side::right).depth_m);
  opening.reveal_depth_m = std::max(of(Side::top).depth_m, both_m);
  if (opening.reveal_depth_m > 0.0) opening.reveal_sigma_m = kUnknownEnd_m;
}

/// An opening as it is found in its wall.
struct FoundHole {
  FramedRectangle framed;
  std::array<Reveal, 4> reveals;
  OpeningOutline outline;
};

FoundHole make_hole(const Scan& scan, const Features& features, const WallEvidence& evidence,
                    const OpeningGrid& grid, const OpeningRectangle& found) {
  FoundHole hole;
  OpeningRectangle& rectangle = hole.framed.rectangle = found;
  hole.outline = find_outline(evidence, grid, rectangle);
  const bool straight = hole.outline.ring.empty();
  if (!straight) rectangle.box = hole.outline.box;
  const std::optional<double> front_m = front_depth(scan, evidence, grid, rectangle);
  // Of façades; a door's leaf may stand farther behind the face than its wall is thick.
  const bool framed = front_m && scan.mobile() && straight;
  if (framed) narrow_sides(scan, evidence, grid, std::min(*front_m, kThinnestFacade_m), rectangle);
  hole.reveals = find_reveals(scan, evidence, grid, rectangle, std::max(features.noise_m, 0.001), front_m);
  if (!straight) drop_bent_sides(hole.outline, hole.reveals);
  refine_sides(features, evidence.wall, hole.reveals, rectangle);
  if (framed) {
    hole.framed.front_m = front_m;
    hole.framed.inner = frame_edges(scan, evidence, grid, rectangle, *front_m);
  }
  return hole;
}

std::vector<FoundHole> holes_of(const Scan& scan, const Features& features, const WallEvidence& evidence,
                                const OpeningGrid& grid, const OpeningOptions& options) {
  std::vector<FoundHole> holes;
  std::vector<FramedRectangle> framed;
  for (const OpeningRectangle& rectangle : opening_rectangles(evidence, grid, options)) {
    if (!acceptable(features, rectangle, evidence, grid, options)) continue;
    if (scan.mobile() && is_niche(evidence, grid, rectangle.box, kNiche_m)) continue;
    holes.push_back(make_hole(scan, features, evidence, grid, rectangle));
    framed.push_back(holes.back().framed);
  }
  share_frame_widths(framed);
  for (std::size_t i = 0; i < holes.size(); ++i) holes[i].framed = framed[i];
  return holes;
}

std::vector<Opening> openings_of(const Scan& scan, const Features& features, const WallEvidence& evidence,
                                 const DirectionMap& directions, const OpeningOptions& options) {
  const bool any =
      std::any_of(evidence.samples.begin(), evidence.samples.end(), [](const WallSample& sample) {
        return sample.kind == SampleKind::open || sample.kind == SampleKind::cover;
      });
  if (!any) return {};
  const OpeningGrid grid(evidence, directions);
  std::vector<Opening> openings;
  for (const FoundHole& hole : holes_of(scan, features, evidence, grid, options)) {
    openings.push_back(make_opening(hole.framed.rectangle, evidence.wall));
    set_reveal(hole.reveals, scan.mobile(), openings.back());
    for (const Vector2d& p : hole.outline.ring)
      openings.back().outline.push_back(evidence.wall.frame.to_space(p));
  }
  // Not in mobile scans: curtains hang indoors, and what hangs before a façade is often a flag.
  if (scan.mobile()) return openings;
  for (const OpeningRectangle& rectangle :
       curtained_rectangles(scan, evidence, grid, features.noise_m, options)) {
    const Opening opening = make_opening(rectangle, evidence.wall);
    const bool known = std::any_of(openings.begin(), openings.end(),
                                   [&](const Opening& other) { return same_hole(other, opening); });
    if (!known) openings.push_back(opening);
  }
  return openings;
}

/// Each hole once: in the wall with most points, which comes first.
std::vector<Opening> without_doubles(const std::vector<Opening>& openings) {
  std::vector<Opening> kept;
  for (const Opening& opening : openings) {
    const bool doubled = std::any_of(kept.begin(), kept.end(),
                                     [&](const Opening& other) { return same_hole(other, opening); });
    if (!doubled) kept.push_back(opening);
  }
  return kept;
}

}  // namespace

void OpeningOptions::check() const {
  walls.check();
  if (!(min_wall_m >= 0.0)) throw_bad_option("min_wall_m", min_wall_m, "at least 0");
  if (!(min_depth_m > 0.0)) throw_bad_option("min_depth_m", min_depth_m, "greater than 0");
  if (!(through_m > min_depth_m)) throw_bad_option("through_m", through_m, "greater than min_depth_m");
  if (!(min_width_m > 0.0)) throw_bad_option("min_width_m", min_width_m, "greater than 0");
  if (!(min_height_m > 0.0)) throw_bad_option("min_height_m", min_height_m, "greater than 0");
  if (!(max_width_m > min_width_m)) throw_bad_option("max_width_m", max_width_m, "greater than min_width_m");
  if (!(max_height_m > min_height_m))
    throw_bad_option("max_height_m", max_height_m, "greater than min_height_m");
}

std::vector<Opening> find_openings(const Scan& scan, const ExtractedFeatures& extracted, const Vector3d& up,
                                   const OpeningOptions& options, Monitor& monitor) {
  options.check();
  if (scan.size() == 0) return {};
  if (!scan.centre_known() && !options.centre) {
    throw Error("the scanner position is unknown", scan.name,
                "give the scanner position, or a file that contains it");
  }
  const std::vector<OpeningWall> walls = opening_walls(scan, extracted, up, options);
  const std::vector<WallEvidence> evidence = opening_evidence(scan, extracted, walls, options, monitor);
  DirectionMap directions;
  if (!scan.mobile()) directions = DirectionMap(scan, scan.centre_known() ? scan.centre(0) : *options.centre);
  std::vector<std::vector<Opening>> found(evidence.size());
  parallel_for(evidence.size(), 1, [&](std::size_t begin, std::size_t end) {
    monitor.throw_if_cancelled();
    for (std::size_t w = begin; w < end; ++w)
      found[w] = openings_of(scan, extracted.features, evidence[w], directions, options);
  });
  std::vector<Opening> openings;
  for (const std::vector<Opening>& part : found) openings.insert(openings.end(), part.begin(), part.end());
  return without_doubles(openings);
}

}  // namespace limen
