// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/register/judge/share_belief.h"

/// The numbers of the judge of pairs, written by scripts/fit_posterior.
namespace limen::evidence_table {

/// Share of the surface seen by both scans that one of them puts into free space seen by the other.
struct Contradiction {
  double piece_m2;    ///< surface that makes one observation
  ShareBelief right;  ///< under right poses: doors, people, glass, things that were moved
  ShareBelief wrong;  ///< under wrong ones
};
/// Of poses that were not searched for, but follow from others.
inline constexpr Contradiction kPlaced{0.498, {0.0484, 1.338}, {0.9266, 3.553}};

/// What surface says, of one sort of pairs.
struct Surface {
  double nats_per_m2;      ///< against chance, of agreeing surface; a plane counts for 5 m^2 at most
  double contrast_per_m2;  ///< nats, of surface that agrees better under one of two poses ...
  double against_per_m2;   ///< ... and of surface that one of them puts into seen free space
  double search_nats;      ///< what the best of all wrong poses reaches by chance
  Contradiction contradicted;
  double nothing_shared;  ///< odds beforehand that nothing is shared, against a pose that was proposed ...
  double unlisted;        ///< ... and that a place is shared whose pose was not proposed
};
inline constexpr Surface kRooms{0.755, 1.083, 7.78, 7.51, {0.211, {0.0206, 1.14}, {0.205, 6.15}}, 1.0, 0.1};
inline constexpr Surface kThroughWall{1.132, 1.029, 7.61, 13.90, {0.393, {0.0455, 3.82}, {0.280, 6.06}},
                                      1.0,   0.1};
inline constexpr Surface kInModel{1.9, 1.9, 7.6, 9.5, {0.4, {0.02, 8.0}, {0.3, 6.0}}, 1.0, 0.1};

/// Look-alike places: odds beforehand that a pose whose walls agree lays a place on another one ...
inline constexpr double kOtherwise = 1.335;        ///< ... that is furnished otherwise,
inline constexpr double kOtherwiseApart = 0.1553;  ///< the same where a wall is between the stations,
inline constexpr double kAlike = 0.007048;         ///< and one that is furnished alike.
inline constexpr double kInPair = 0.06387;  ///< share of them whose other place the same two scans show
inline constexpr double kThings = 0.8147;   ///< weight of what things say, against chance ...
inline constexpr double kBuilt = 1.616;     ///< ... and of how surfaces were built
inline constexpr double kBent = 0.08544;    ///< share of pairs whose scans are bent within themselves

}  // namespace limen::evidence_table
