// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/match/segments/segment_distance.h"
#include "limen/model/features.h"

// Djahel, Monasse, Vallet, "Detecting openings for indoor/outdoor registration", 2022, sections 3.2 and 3.3.
//
// Departures from the printed text:
// - nested random choice (wall pair, then a vertical and a horizontal edge of each) is replaced by all pairs
//   of walls and all pairs of openings of like size: the set is finite, and the result always the same;
// - directions have no signs to guess: the scanner is on its own side of the wall in each scan, so
//   "right" and "up" are known. Seen from opposite sides, left and right change places; both cases are tried;
// - the wall's normal is taken out of the distance and of the fit. The two rectangles of one window lie a
//   wall's thickness apart, and the printed distance would pull the thickness to zero. The shift along the
//   normal is either held by windows in another wall, or it is an assumption, and said to be one;
// - only edges that were seen count;
// - the pose is fitted to all edges that agree, not to two.

namespace limen {

/// From where the two scans saw a wall.
enum class WallSides : std::uint8_t {
  opposite,  ///< one from inside, one from outside: normals oppose, left and right change places
  same
};

struct OpeningPoseOptions {
  bool gravity_known = true;      ///< both z axes point up; else each opening's own upper side is taken
  double min_thickness_m = 0.05;  ///< of a wall between opposite sides
  double max_thickness_m = 1.2;
  std::vector<double> thicknesses_m = {0.15, 0.3, 0.45, 0.6};  ///< assumed where nothing holds the normal
  /// Poses that are fitted for each of the two cases of sides, the source's walls taking turns. Where nothing
  /// holds the normal, each is listed once per assumed thickness.
  std::size_t max_poses = 600;
};

/// Edges of one opening lie no farther apart, wall normal taken out.
inline constexpr double kOpeningEdgesM = 0.15;
inline constexpr double kSameFaceM = 0.3;         ///< faces seen from one side are taken for one within this
inline constexpr double kSameInWallM = 0.05;      ///< poses nearer than this in the wall, and
inline constexpr double kSameAcrossWallM = 0.05;  ///< than this across it, are one

/// An opening of each scan that are taken for one.
struct OpeningPair {
  int source = -1;  ///< index into the source's openings
  int target = -1;
};

/// A pose proposed by openings, in the scans' local frames.
struct OpeningPose {
  Rigid3 target_from_source;
  /// Equation 14 in the form of (9) over all seen edges of both scans, wall normals taken out; a cost, m^3.
  double distance = 0.0;
  double support_m = 0.0;    ///< length of edges that lie on edges of the other scan, mean of both scans
  int matched_openings = 0;  ///< number of `pairs`
  std::vector<OpeningPair> pairs;
  int source_wall = -1;  ///< index into Features::planes of the wall that proposed it
  int target_wall = -1;
  WallSides sides = WallSides::opposite;
  Vector3d wall_normal = Vector3d::UnitX();  ///< unit, target frame, of the target's wall towards its scanner
  /// The source's face of that wall lies this far behind the target's, metres; about 0 for `same`.
  double thickness_m = 0.0;
  /// False: `thickness_m` is assumed, and the shift along `wall_normal` with it. True: openings in another
  /// wall hold it, or both scans saw the same face.
  bool thickness_held = false;
};

/// All poses that lay openings of the source on openings of the target, for any starting pose: lowest
/// distance first, no two alike. On a regular façade all shifts by a window are listed. Deterministic. Empty
/// where one scan has no opening.
std::vector<OpeningPose> enumerate_opening_poses(const Features& source, const Features& target,
                                                 const OpeningPoseOptions& options = {});

}  // namespace limen
