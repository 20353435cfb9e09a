// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/simulate/scanner/scanner.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// How the street is scanned.
enum class Outdoor {
  mobile,  ///< by a vehicle that drives past
  tripod   ///< by one more station, before the windows of the first one's room
};

/// Which case to make. The same options give the same case, bit for bit, for any thread count.
struct SceneOptions {
  std::string name = "room";      ///< one of scene_names()
  std::uint64_t seed = 1;         ///< another seed: another building, other stations, other noise
  std::size_t points_indoor = 0;  ///< of each station, about; 0: the scene's own number
  /// Of the scan of the street, about; 0: the scene's own number, which is none for the mobile scan of room
  /// and flat.
  std::size_t points_outdoor = 0;
  std::size_t stations = 0;  ///< tripod stations; 0: the scene's own number
  /// Street façades the first room has open windows in (museum, townhouse, villa); 0: as many as it gets.
  std::size_t facades = 0;
  Outdoor outdoor = Outdoor::mobile;
  bool any_rotation = false;    ///< stations stand at any rotation, else level with any heading
  double curtain_share = -1.0;  ///< of the windows; negative: the scene's own share; none in identical_bays
  bool as_built = false;        ///< walls, slabs and openings are off the drawing as real ones are
  double drift_m = 0.0;         ///< slow error of a mobile trajectory, one standard deviation per axis
  ScannerOptions scanner;

  void check() const;
};

/// The built-in scenes, in the order of the documentation.
std::vector<std::string> scene_names();

/// Builds the scene, scans it and tells the truth about it. Throws Error for an unknown name.
SimulatedCase simulate(const SceneOptions& options, Monitor& monitor = silent_monitor());

}  // namespace limen
