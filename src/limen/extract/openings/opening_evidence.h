// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/openings/openings.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {

/// A wall in which openings are looked for: all planes that lie in one plane and face one way.
struct OpeningWall {
  int base = -1;             ///< index of the largest of its planes
  Plane plane;               ///< of the base, the normal towards the scanner
  PlaneFrame frame;          ///< u to the right as the scanner sees it, v up
  Box2 box;                  ///< of its planes' outlines, in the frame
  double spacing_m = 0.0;    ///< root of the area per point
  std::vector<char> planes;  ///< for each plane of the features: what its points are to this wall (PlaneRole)
};

enum class PlaneRole : char {
  other,   ///< only the place of its points counts
  member,  ///< its points are wall
  relief   ///< parallel, a little before the wall: its points are wall
};

/// What the ray of a point says of the place where it meets the wall's plane.
enum class SampleKind : std::uint8_t {
  wall,    ///< the point lies on the wall
  open,    ///< it lies behind the wall
  cover,   ///< it lies a little before it
  shallow  ///< it lies too little behind it to prove an opening: the side of one, or rough wall
};

struct WallSample {
  float u = 0.0F;           ///< of the place in the wall's frame, metres
  float v = 0.0F;           ///< the same
  float depth_m = 0.0F;     ///< of the point behind the wall's plane; negative: before it
  std::uint32_t point = 0;  ///< index into the scan
  SampleKind kind = SampleKind::wall;
};

struct WallEvidence {
  OpeningWall wall;
  std::vector<WallSample> samples;  ///< by ascending point index
};

/// The walls of a scan, most points first. `up`: unit vector against gravity.
std::vector<OpeningWall> opening_walls(const Scan& scan, const ExtractedFeatures& extracted,
                                       const Vector3d& up, const OpeningOptions& options);

/// For each wall what the rays say of it. A ray speaks of every wall it meets from the seen side. Throws
/// Error where the scanner position is not known.
std::vector<WallEvidence> opening_evidence(const Scan& scan, const ExtractedFeatures& extracted,
                                           const std::vector<OpeningWall>& walls,
                                           const OpeningOptions& options, Monitor& monitor);

}  // namespace limen
