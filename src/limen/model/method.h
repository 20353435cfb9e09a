// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// What poses are proposed from.
enum class Method {
  automatic,  ///< all there is
  polygons,   ///< planar polygons (2021)
  openings,   ///< openings (2022)
  hybrid,     ///< openings, and planes for the shift across the wall (2023, III)
  segments    ///< line segments (2023, IV)
};
const char* to_string(Method method);

/// What is known of the vertical.
enum class Gravity {
  automatic,  ///< level where the planes of both scans say so, else as each scan shows by itself
  up,         ///< both z axes point up
  unknown     ///< any orientation: only what each scan shows by itself counts
};

}  // namespace limen
