// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/features/extract_features.h"
#include "limen/geometry/segment.h"
#include "limen/model/scan.h"

// 3-D line segments of a scan: the edges of its surfaces. After Lu, Liu, Li: Fast 3D line segment detection
// from unorganized point cloud (2019): planes by region growing and merging, each plane's points projected
// into an image, contours of the image with its holes, lines fitted to them, back to 3-D.
//
// Departures from the printed text:
// - the planes are those of extract_features; where two of them meet, their line of intersection is the edge:
//   it is better known than either contour, which is dropped there;
// - the image is filled by discs as wide as the points are apart at each place, not by pixels of one size;
// - lines are fitted to the outermost points, not to pixels, and moved outwards by what the points' own
// spacing
//   says that they fall short of the edge;
// - a border of a plane's points is no edge where something nearer to the scanner hides what lies beyond.

namespace limen {

struct SegmentOptions {
  double min_length_m = 0.2;          ///< of a segment, > 0
  double min_angle_deg = 12.0;        ///< between two planes that make an edge, in (0, 90]
  double join_gap_m = 0.15;           ///< pieces of one line are joined across gaps up to this, >= 0
  bool creases = true;                ///< where two planes meet
  bool borders = true;                ///< where a plane ends
  double max_border_sigma_m = 0.006;  ///< borders whose place is known less well are left out, > 0

  void check() const;
};

/// What a segment is an edge of.
enum class EdgeKind : std::uint8_t {
  crease,  ///< two planes meet in it
  border   ///< one plane ends in it
};

/// A segment and what it was made of.
struct DetectedEdge {
  Segment segment;  ///< about the scan's local origin
  EdgeKind kind = EdgeKind::crease;
  /// Indices into Features::planes, the second only of a crease; -1 is also a small plane that was
  /// looked for here alone.
  std::array<std::int32_t, 2> planes = {-1, -1};
  double sigma_m = 0.0;  ///< one standard deviation of its place across, from the fit
};

/// The edges of a scan, longest first. Borders are judged by what the scanner saw beyond them: with an
/// unknown scanner position only the outlines of holes are taken.
std::vector<DetectedEdge> find_edges(const Scan& scan, const ExtractedFeatures& extracted,
                                     const SegmentOptions& options = {}, Monitor& monitor = silent_monitor());

/// The same as bare segments, about the scan's local origin, longest first: the one-call door.
std::vector<Segment> find_segments(const Scan& scan, const ExtractedFeatures& extracted,
                                   const SegmentOptions& options = {}, Monitor& monitor = silent_monitor());

}  // namespace limen
