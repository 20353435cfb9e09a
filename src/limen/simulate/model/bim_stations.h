// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/base/progress.h"
#include "limen/base/random.h"
#include "limen/simulate/model/bim_rooms.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {

/// What a station asks of a room.
enum class RoomChoice {
  any,
  unique,    ///< no other room of the model is like it
  repeated,  ///< another one is
  each       ///< the stations go through all rooms, one after the other
};

/// A tripod's place in a model.
struct BimStation {
  Vector3d position = Vector3d::Zero();  ///< about the model's local origin
  int room = -1;                         ///< index into the rooms; -1: in none that the model names
};

/// `count` unit vectors, evenly spread over the sphere, in a fixed order.
std::vector<Vector3d> spread_directions(int count);

/// Free places: the first in a room of at least 5 m^2 and 2 m height, the others in its sight, in the same
/// room or through doors, or (`each`) in all rooms of at least 2 m^2 in turn, as long as there is space; 1.4
/// to 1.8 m above the floor, at least 0.5 m from everything. Models without rooms are searched for places
/// with a floor below, a ceiling above and walls around. Throws Error where there is none.
std::vector<BimStation> place_bim_stations(const std::vector<BimRoom>& rooms, const RayCaster& caster,
                                           std::size_t count, RoomChoice choice, RandomStream& random);

}  // namespace limen
