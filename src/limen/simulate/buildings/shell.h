// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "limen/simulate/buildings/as_built.h"
#include "limen/simulate/buildings/floor_plan.h"
#include "limen/simulate/buildings/mesh.h"

namespace limen {

/// A triangle of wall in the coordinates of a panel, counter-clockwise.
using PanelTriangle = std::array<Vector2d, 3>;

/// What is not where it was drawn, and where the openings are in each face then.
struct ShellAsBuilt {
  const AsBuilt& shape;
  const std::vector<std::vector<std::vector<Vector3d>>>& holes;
};

/// A plan with its wall faces, the holes that openings cut into them (one list per face), and what stays of
/// the wall in the corners of holes that are not rectangular.
struct ShellPlan {
  const FloorPlan& plan;
  const std::vector<WallFace>& faces;
  const std::vector<std::vector<PanelRect>>& holes;
  const std::vector<std::vector<PanelTriangle>>& spandrels;
  std::optional<ShellAsBuilt> built;  ///< none: as drawn
};

/// Adds walls, floors, ceilings, stairs, roof, and a plinth, string courses and a cornice, each with the
/// given chance.
void add_shell(Mesh& mesh, const ShellPlan& shell, double ornament_share, RandomStream& random);

/// Whether stairs rise from this room to the next storey, and the floor they take.
bool stairs_rise(const FloorPlan& plan, std::size_t room);
Ring stairs_area(const Room& room);

}  // namespace limen
