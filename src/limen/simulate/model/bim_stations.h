// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "limen/base/progress.h"
#include "limen/base/random.h"
#include "limen/model/bim_model.h"
#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// A space of a model as a surveyor sees it, about the model's local origin.
struct BimRoom {
  int space = -1;                ///< index into BimModel::spaces
  std::vector<Polygon> outline;  ///< its plan, x and y
  double floor_m = 0.0;          ///< height of its floor
  double height_m = 0.0;         ///< between its lowest and its highest point
  double area_m2 = 0.0;          ///< of its plan
  double length_m = 0.0;         ///< of the smallest rectangle round its plan, the longer side
  double width_m = 0.0;
  std::vector<Vector3d> openings;  ///< width, height, sill above the floor of each; in ascending order
};

/// All spaces that have a plan.
std::vector<BimRoom> rooms_of(const BimModel& model);

/// Whether two rooms have the same plan, height and openings, each length within 5 cm. Which way round an
/// opening lies is not looked at.
bool alike(const BimRoom& a, const BimRoom& b);

/// What the truth says of a room among all.
ModelRoom describe(const BimModel& model, const std::vector<BimRoom>& rooms, std::size_t room);

/// What a station asks of a room.
enum class RoomChoice {
  any,
  unique,    ///< no other room of the model is like it
  repeated,  ///< another one is
  each,      ///< the stations go through all rooms, one after the other
  doorways   ///< the same after one in every doorway between two rooms of the lowest storey
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
std::vector<BimStation> place_bim_stations(const BimModel& model, const std::vector<BimRoom>& rooms,
                                           const RayCaster& caster, std::size_t count, RoomChoice choice,
                                           RandomStream& random);

}  // namespace limen
