// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/bim_model.h"
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

}  // namespace limen
