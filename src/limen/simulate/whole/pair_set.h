// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// A handful of scans of one building that make pairs of every kind: one room scanned twice, on another day
// with its furniture partly moved, rooms that a door joins, different rooms built alike (twins), rooms that
// have nothing in common.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/model/scan.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/scan_style.h"

namespace limen {

/// What two scans have to do with one another.
enum class PairKind : std::uint8_t {
  same_room,   ///< two places in one room
  other_day,   ///< one room, its furniture partly moved in between
  next_room,   ///< rooms that share at least 3 m^2 of seen surface
  twin,        ///< different rooms built alike
  other_room,  ///< of the same building, nothing in common
  unclear      ///< neither: a little surface in common, or not counted (days differ)
};
const char* to_string(PairKind kind);

struct PairSetOptions {
  std::string name = "flats";  ///< one of whole_building_names()
  std::uint64_t seed = 1;
  std::size_t points = 100000;  ///< of a station, about
  std::size_t twins = 3;        ///< rooms like the first one
  bool styles = true;           ///< random ones for scans and furniture; else plain ones
  bool as_built = false;        ///< walls, slabs and openings are off the drawing as real ones are
};

struct PairSetScan {
  Scan scan;
  SimulatedScan truth;
  int day = 0;
};

/// Scans of one building, all poses in one world.
struct PairSet {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<PairSetScan> scans;
  std::vector<ProjectRoom> rooms;
  std::vector<SharedSurface> shared;  ///< among the scans of day 0

  [[nodiscard]] PairKind kind_of(std::size_t a, std::size_t b) const;
  [[nodiscard]] Rigid3 target_from_source(std::size_t source, std::size_t target) const;
  /// Twins whose furniture is of one layout, placed by hand.
  [[nodiscard]] bool furnished_alike(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool mirrored(std::size_t a, std::size_t b) const;
  [[nodiscard]] bool same_storey(std::size_t a, std::size_t b) const;

 private:
  [[nodiscard]] const ProjectRoom& room_of(std::size_t scan) const;
};

/// The same options give the same scans, bit for bit, for any thread count.
PairSet simulate_pair_set(const PairSetOptions& options, Monitor& monitor = silent_monitor());

}  // namespace limen
