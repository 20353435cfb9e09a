// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "limen/geometry/rigid.h"

namespace limen {

/// Who says where a static scanner stood.
enum class PlaceSource : std::uint8_t {
  unknown,         ///< nobody, and the data do not show it
  assumed,         ///< 0,0,0 of the points, as many files have it, which the data do not refute
  stated_by_file,  ///< the file
  stated_by_user,  ///< the user
  estimated,       ///< the data: density of the points on planes
  per_point        ///< the file or a trajectory, for every point: a mobile scan
};
/// "unknown", "assumed", "file", "user", "estimated", "per point".
const char* to_string(PlaceSource source);

/// Where the scanner of a scan stood, and how that is known.
struct ScannerPlace {
  PlaceSource source = PlaceSource::unknown;
  Vector3d centre = Vector3d::Zero();  ///< of a static scan, metres, world; 0 where unknown or per point
  bool confirmed = false;              ///< the density of the points on planes bears it out
  std::optional<double> sigma_m;  ///< one standard deviation per axis, the largest, where it was estimated
  /// A place that was said and that the data refute: replaced where it was only assumed or the file's word,
  /// kept where the user stated it.
  std::optional<Vector3d> refuted;
};

/// For a user: what the data say of a place that they refute, and what is used; empty where they refute none.
std::string words_of_refuted(const ScannerPlace& place);

}  // namespace limen
