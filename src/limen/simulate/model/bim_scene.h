// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/base/progress.h"
#include "limen/model/bim_model.h"
#include "limen/simulate/model/bim_changes.h"
#include "limen/simulate/scanner/scanner.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// How a model is scanned. The same model and options give the same case, bit for bit, for any thread count.
struct BimSceneOptions {
  std::uint64_t seed = 1;             ///< another seed: another room, other places, other changes
  std::size_t stations = 1;           ///< in one room, or in rooms that see one another through doors
  std::size_t points = 250000;        ///< of each station, about
  bool any_rotation = false;          ///< stations have frames of any rotation, else level with any heading
  RoomChoice room = RoomChoice::any;  ///< of the first station
  double open_door_share = 0.5;       ///< doors that stand open: nothing of them is seen
  AsBuiltOptions as_built;
  std::size_t targets = 0;  ///< spheres in all (put_up_spheres)
  ScannerOptions scanner;

  void check() const;
};

/// Scans the rooms of a model. The truth's world is the model's: x_in_world = local_origin + x, so the pose
/// of a scan in the world is its pose in the model. The truth names what differs from the model and which
/// rooms the scans show. Scans are named scan_01, scan_02, ...
///
/// Panes let light pass (see parts_of); the model's outside is all there is of the world. Throws Error where
/// no place for a scanner is found.
SimulatedCase simulate_bim(const BimModel& model, const BimSceneOptions& options,
                           Monitor& monitor = silent_monitor());

}  // namespace limen
