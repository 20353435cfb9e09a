// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/simulate/floor_plan.h"
#include "limen/simulate/mesh.h"

namespace limen {

/// A plan with its wall faces and the holes that openings cut into them (one list per face).
struct ShellPlan {
  const FloorPlan& plan;
  const std::vector<WallFace>& faces;
  const std::vector<std::vector<PanelRect>>& holes;
};

/// Adds walls, floors, ceilings, stairs, roof, and a plinth, string courses and a cornice, each with the
/// given chance.
void add_shell(Mesh& mesh, const ShellPlan& shell, double ornament_share, RandomStream& random);

/// Whether stairs rise from this room to the next storey, and the floor they take.
bool stairs_rise(const FloorPlan& plan, std::size_t room);
Ring stairs_area(const Room& room);

}  // namespace limen
