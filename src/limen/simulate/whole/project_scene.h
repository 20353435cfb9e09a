// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "limen/base/progress.h"
#include "limen/model/scan.h"
#include "limen/simulate/scanner/drift.h"
#include "limen/simulate/scanner/scanner.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {

/// Which building to scan, and how. The same options give the same scans, bit for bit, for any thread count.
struct ProjectSceneOptions {
  std::string name = "museum";  ///< one of whole_building_names()
  std::uint64_t seed = 1;
  std::size_t stations = 0;  ///< 0: the building's own number; the building grows with it, up to 2 000
  StationPlaces places = StationPlaces::usual;
  std::size_t tripods = 0;              ///< further stations in the street, all round the building
  int passes = -1;                      ///< of the street; negative: the building's own number
  std::size_t points_station = 120000;  ///< of each, about
  std::size_t points_pass = 0;          ///< of each pass, about; 0: 6 000 a metre, at most 1.2 million
  bool any_rotation = false;            ///< stations at any rotation, else level with any heading
  double drift_m = 0.008;               ///< slow error of the passes, one standard deviation per axis
  DriftKind drift = DriftKind::waves;
  double open_door_share = 0.9;
  bool as_built = false;    ///< walls, slabs and openings are off the drawing as real ones are
  std::size_t targets = 0;  ///< in each room of a station: spheres and checkerboards (site_targets.h)
  bool styles = false;      ///< every station in a style at random (building_scanner.h)
  ScannerOptions scanner;

  void check() const;
};

/// Builds the building, scans it scan by scan, and hands each scan to `keep` when it is made: no two of them
/// lie in memory at once. Stations are in their own frames, passes in the world's (a national grid).
ProjectTruth simulate_project(const ProjectSceneOptions& options,
                              const std::function<void(const Scan&)>& keep,
                              Monitor& monitor = silent_monitor());

}  // namespace limen
