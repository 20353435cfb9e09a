// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "limen/model/features.h"

// What the papers' own methods take and give. Each is one file pair of this room.

namespace limen {

/// Two scans as a published method sees them.
struct PublishedInput {
  const Features& source;
  const Features& target;
  /// target_from_source before registration, local frames: what "smallest angle" is asked of.
  Rigid3 start = {};
  bool source_outside = false;  ///< the source looks at the building from outside, as a mobile scan does
  bool target_outside = false;
  bool upright = false;           ///< z points up in both frames
  double wall_thickness_m = 0.0;  ///< as the user knows it; 0: not known
  std::uint64_t seed = 1;         ///< of the random trials
};

/// The polygons of one scan that take part in 2021, section 3: of one that looks in from outside only those
/// of the points behind its façades (3.1.2), else all but those that it sees outside. Most inliers first, at
/// most `most`.
std::vector<PlanarPolygon> common_polygons(const Features& features, bool outside, std::size_t most);

/// The one pose that a method ends with, and the number it was chosen by.
struct PublishedPose {
  Rigid3 target_from_source;          ///< local frames
  double criterion = 0.0;             ///< in the unit and sense that the method's header tells
  std::size_t hypotheses = 0;         ///< poses that were compared
  std::vector<Vector3d> not_held;     ///< unit, target frame: shifts that the method assumes
  std::optional<Vector3d> free_turn;  ///< the axis of a turn that it leaves open
};

/// A pose, or why the method has none.
struct PublishedAnswer {
  std::optional<PublishedPose> pose;
  std::string why_none;
};

}  // namespace limen
