// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/scanner.h"

namespace limen {

/// A street along some façades of a building and what is in it.
struct StreetOptions {
  std::size_t first_edge = 0;    ///< of the envelope
  std::size_t edges = 1;         ///< how many façades the street follows
  double path_m = 8.0;           ///< from the façades to the vehicle's path
  double opposite_m = 17.0;      ///< to the façades across the street; 0: none
  double tree_spacing_m = 16.0;  ///< on the building's side; 0: no trees
  double car_share = 0.5;        ///< of the parking places taken
  double antenna_m = 2.4;        ///< height of the scanner above the road
  FacadeOptions opposite;        ///< how the houses across look
  bool bare = false;             ///< nothing but the road: no pavement, trees, cars, poles, houses
};

/// The envelope's edges [first, first + count) moved outwards by `distance`: count + 1 corners.
std::vector<Vector2d> offset_chain(const Ring& envelope, std::size_t first, std::size_t count,
                                   double distance);

/// Adds ground, pavement, houses across, trees, cars and poles; returns the path of the scanner.
VehiclePath add_street(World& world, std::size_t building, const StreetOptions& options,
                       RandomStream& random);

/// A vehicle's path along `count` façades from `first` on, `distance_m` before them, rounded at the corners.
VehiclePath drive_past(const Ring& envelope, std::size_t first, std::size_t count, double distance_m,
                       double antenna_m);

/// Ground all round, and a garden with trees behind the building's edge `edge`.
void add_ground(World& world);
void add_garden(World& world, std::size_t building, std::size_t edge, RandomStream& random);

}  // namespace limen
