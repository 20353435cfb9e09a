// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "limen/simulate/furnishing/furnish_rooms.h"
#include "limen/simulate/scanner/scanner.h"

namespace limen {

/// How one station was scanned: the instrument, how it was set up, who was in the way.
struct ScanStyle {
  std::size_t points = 120000;  ///< about
  ScannerOptions scanner = {};
  FieldOfView view = {};
  bool any_rotation = false;                ///< the file's frame, else level with any heading
  double tilt_rad = 0.0;                    ///< of the whole instrument, its frame with it
  Vector3d file_origin = Vector3d::Zero();  ///< the scanner in its file's frame
  bool origin_stated = true;                ///< whether the file says where the scanner stood
  int people = 0;                           ///< in its room, while it scanned
};

/// A style at random: noise 1-8 mm, 50-150 % of the points, the field of view, a tilt up to 3 degrees, a
/// scanner off its file's origin (and not stated), glass that mirrors, people, rooms that are scanned by
/// half.
ScanStyle random_scan_style(const ScanStyle& plain, std::uint64_t seed);

/// Furniture that hides little or much.
FurnishingStyle random_furnishing_style(std::uint64_t seed);

}  // namespace limen
