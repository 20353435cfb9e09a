// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {

/// A tripod's place: the scanner's centre in the building's frame.
struct StationPlace {
  Vector3d position = Vector3d::Zero();
  std::size_t room = 0;
};

/// A place for a wish: on the floor, clear of matter, of several the one from which most
/// rays leave its room through doorways.
/// Nothing where the room is too full. The stream is (seed, room, wish's part) alone: other stations do not
/// change it.
std::optional<StationPlace> survey(const WholeBuilding& building, const RayCaster& caster,
                                   const StationWish& wish, std::uint64_t seed);

}  // namespace limen
