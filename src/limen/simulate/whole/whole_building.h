// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/furnishing/furnish_rooms.h"
#include "limen/simulate/scanner/scanner.h"
#include "limen/simulate/whole/project_truth.h"

namespace limen {

/// Where the stations of a whole building stand.
enum class StationPlaces {
  usual,    ///< in every room, more than one in long rooms, corridors and on stairs
  rooms,    ///< one in every room
  doorways  ///< as usual, and one in every open doorway between two such rooms
};

/// Where a station is wanted: in a room, within a part of its longer side, or in a doorway.
struct StationWish {
  std::size_t room = 0;
  double from = 0.0;  ///< share of the longer side
  double to = 1.0;
  int doorway = -1;  ///< index into World::openings
};

/// A whole building with its street, furnished, and who scans it from where.
struct WholeBuilding {
  World world;  ///< building 0 is the one that is scanned
  std::vector<StationWish> wishes;
  std::vector<VehiclePath> passes;
  std::vector<ProjectRoom> rooms;
  std::vector<double> head_turns_rad = {0.0};
};

struct WholeBuildingOptions {
  std::string name = "museum";  ///< one of whole_building_names()
  std::uint64_t seed = 1;
  /// 0: the building's own number; the building grows with it. With stations in doorways all its rooms have
  /// some.
  std::size_t stations = 0;
  StationPlaces places = StationPlaces::usual;
  int passes = -1;  ///< of the street, each along two façades; negative: the building's own number
  double open_door_share = 0.9;
  FurnishingStyle furnishing = {};
  bool as_built = false;  ///< walls, slabs and openings are off the drawing as real ones are
};

/// museum, equal_bays, flats, office_floor, hotel, terrace.
std::vector<std::string> whole_building_names();

/// Throws Error for an unknown name.
WholeBuilding make_whole_building(const WholeBuildingOptions& options);

}  // namespace limen
