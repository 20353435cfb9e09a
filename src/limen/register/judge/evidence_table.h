// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/register/judge/share_belief.h"

/// The numbers of the judge of pairs. scripts/fit_posterior writes them, but for those that are presumed:
/// all of kInModel, kAsDrawn, and the odds beforehand that end each Surface (pairs are given because they are
/// thought to overlap).
namespace limen::evidence_table {

/// Share of the surface seen by both scans that one of them puts into free space seen by the other.
struct Contradiction {
  double piece_m2;    ///< surface that makes one observation
  ShareBelief right;  ///< under right poses: doors, people, glass, things that were moved
  ShareBelief wrong;  ///< under wrong ones
};
/// Of poses that were not searched for, but follow from others.
inline constexpr Contradiction kPlaced{0.262, {0.0346, 1.27}, {0.943, 3.42}};

/// What surface says, of one sort of pairs.
struct Surface {
  double nats_per_m2;      ///< against chance, of agreeing surface; a plane counts for 5 m^2 at most
  double contrast_per_m2;  ///< nats, of surface that agrees better under one of two poses ...
  double against_per_m2;   ///< ... and of surface that one of them puts into seen free space
  double search_nats;      ///< what the best of all wrong poses reaches by chance
  double built;            ///< weight of how surfaces were built, against chance
  Contradiction contradicted;
  double twice;  ///< share of places that the same two scans see again elsewhere, built and furnished alike
  double nothing_shared;  ///< prior odds of no common surface, against a pose that was proposed ...
  double unlisted;        ///< ... and of a common place whose pose was not proposed
};
inline constexpr Surface kRooms{0.749, 1.16, 7.53, 7.13, 2.23, {0.262, {0.00344, 11.2}, {0.156, 13.2}},
                                0,     1.0,  0.1};
inline constexpr Surface kThroughWall{
    0.939, 0.807, 7.94, 6.06, 1.45, {0.168, {0.000248, 133}, {0.0609, 13.2}}, 0.0171, 1.0, 0.1};
inline constexpr Surface kPastWall{0.66, 1.04, 7.52, 4.31, 0.544, {0.395, {0.000369, 343}, {0.0652, 14.2}},
                                   0,    1.0,  0.1};
inline constexpr Surface kStreets{0.263, 1.2, 7.6, 13.4, 0.0, {0.357, {0.0109, 7.31}, {0.35, 11.1}},
                                  0.0,   1.0, 0.1};
inline constexpr Surface kInModel{1.9, 1.9, 7.6, 9.5, 0.0, {0.4, {0.02, 8.0}, {0.3, 6.0}}, 0.0, 1.0, 0.1};

/// What two scans see of the same furniture and clutter.
struct Furniture {
  ShareBelief stayed;       ///< share of a room's things that are where they were
  ShareBelief in_place;     ///< share of what is seen of such a thing that agrees
  double measured;          ///< factor by which the deviations of a pair's faces are off: median ...
  double measured_spread;   ///< ... and deviation of its logarithm
  double pushed;            ///< share of the others that was pushed ...
  double pushed_m;          ///< ... by so much
  double more_than_chance;  ///< share that agrees in another room, beyond shifted things ...
  double chance_strength;   ///< ... and how well it is known, in observations
  double met;               ///< share of the faces in another room that are near one another by chance ...
  double met_m;             ///< ... to so much
  ShareBelief built_in;     ///< share of a building's things that are its own after all
  ShareBelief alike;        ///< share of the others in a room furnished alike that have a counterpart
  double put_m;             ///< how accurately those were put alike: median ...
  double put_spread;        ///< ... and deviation of its logarithm
};
inline constexpr Furniture kFurniture{{0.768, 4.09},   {0.946, 65.5}, 0.808,  1,     0.911,
                                      0.00777,         0.103,         2.22,   0.115, 0.00968,
                                      {0.00465, 18.4}, {0.389, 3.44}, 0.0248, 0.252};

/// Look-alike places: odds beforehand that a pose whose walls agree lays a place on another one ...
inline constexpr double kOtherwise = 0.939;             ///< ... that is furnished otherwise,
inline constexpr double kOtherwiseBehindWall = 0.0679;  ///< the same where a wall is between the stations,
inline constexpr double kAlike = 0.00458;               ///< and one that is furnished alike.
inline constexpr double kBehindWindows = 0.0236;        ///< that pairs through windows agree on another one,
/// ... and the weight of agreement against it, of that against chance.
inline constexpr double kAgreeingBehind = 0.899;
inline constexpr double kRateStrength = 1.42;  ///< how well their share in a building is known, in scans
inline constexpr double kAsDrawn = 0.02;       ///< that a building is exactly as drawn (presumed) ...
inline constexpr ShareBelief kBuiltInAsDrawn{0.0144, 5.5};  ///< and Furniture::built_in of such a building
inline constexpr double kInPair = 0.106;        ///< share of them whose other place the same two scans show
inline constexpr double kBent = 0.0899;         ///< share of pairs whose scans are bent within themselves
inline constexpr double kSeemsBent = 0.0304;    ///< share of pairs that are not and seem bent by a millimetre
inline constexpr double kBendStrength = 0.157;  ///< how well shares of bends are known in a project, in scans
inline constexpr double kStayedStrength = 0.157;  ///< the same of the share of things that stay

}  // namespace limen::evidence_table
