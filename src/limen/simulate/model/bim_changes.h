// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/base/random.h"
#include "limen/simulate/model/bim_mesh.h"
#include "limen/simulate/model/bim_stations.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// How a building differs from its model.
struct AsBuiltOptions {
  bool on = false;  ///< false: everything is where the model has it
  /// Of walls, columns, plates, doors, windows (by 1 to 5 cm) and slabs (by 0.5 to 2 cm).
  double moved_share = 0.25;
  double furniture_per_m2 = 0.25;  ///< pieces that the model does not have, in the scanned rooms
  /// Of the length of these rooms' walls: wardrobes, shelves, kitchens and the like stand before it, about.
  double hidden_wall_share = 0.0;
};

/// Closes some doors and leaves others open.
void open_doors(const BimModel& model, double open_share, RandomStream& random, BuiltState& built);

/// Moves and drops elements; windows and doors go with their wall. `planned` is what the stations would see
/// of the model as it is, its doors set.
BuiltState as_built(const BimModel& model, const AsBuiltOptions& options, const BuiltState& doors,
                    const std::vector<BimStation>& stations, const BimMesh& planned, RandomStream& random);

/// The differences between the model and what was built, in the order of the elements.
std::vector<ModelChange> changes_of(const BimModel& model, const BuiltState& doors, const BuiltState& built);

/// Puts up `count` spheres on poles, by threes about 1 m from a station, each time the farthest from all
/// others. Throws Error where there is no place.
std::vector<SiteTarget> put_up_spheres(BimMesh& built, const std::vector<BimStation>& stations,
                                       std::size_t count, RandomStream& random);

/// Adds furniture along the walls of the scanned rooms, and boxes on the floors about the stations: tables,
/// crates, clutter on top. Returns how many.
int add_clutter(BimMesh& built, const std::vector<BimStation>& stations, const AsBuiltOptions& options,
                RandomStream& random);

}  // namespace limen
