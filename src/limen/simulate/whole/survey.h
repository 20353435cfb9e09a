// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/stations.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {

/// A tripod's place: the scanner's centre in the building's frame, and its room, or kStreet.
struct StationPlace {
  Vector3d position = Vector3d::Zero();
  std::size_t room = 0;
};

/// A place for a wish: on the floor, clear of everything, of several the one from which most
/// rays leave its room through doorways.
/// Nothing where the room is too full. The stream is (seed, room, wish's part) alone: other stations do not
/// change it.
std::optional<StationPlace> survey(const WholeBuilding& building, const RayCaster& caster,
                                   const StationWish& wish, std::uint64_t seed);

/// A place in the street for one of `count` tripods all round the building, or nothing. Each has its own
/// stream.
std::optional<StationPlace> survey_street(const WholeBuilding& building, const RayCaster& caster,
                                          std::size_t number, std::size_t count, std::uint64_t seed);

}  // namespace limen
