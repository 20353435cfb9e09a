// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/extract/features/extract_features.h"
#include "limen/geometry/plane.h"

namespace limen {

/// The way of a mobile scan, given at knots that stand evenly along it.
struct PassWay {
  std::vector<double> times_s;      ///< ascending
  std::vector<double> distances_m;  ///< travelled
  std::vector<Vector3d> places;     ///< of the scanner position, frame of the features, about their origin

  [[nodiscard]] bool known() const { return !times_s.empty(); }
  [[nodiscard]] int knots() const { return static_cast<int>(times_s.size()); }
};

/// What a short part of a pass, or a static scan, saw of a plane within a cube of 2 m: its tiles, one point
/// each.
struct PassStrip {
  std::int32_t plane = -1;             ///< index into Features::planes
  double place = 0.0;                  ///< along the way of a pass, in knots (place_among)
  Vector3d anchor = Vector3d::Zero();  ///< frame of the features
  PointMoments moments;                ///< about the anchor
};

/// A scan as finding the drift of passes needs it.
struct PassTrack {
  PassWay way;  ///< empty of a static scan, and where it has no times, does not move, or is shorter than 10 m
  std::vector<PassStrip> strips;
};

/// The track of a mobile scan with times that lies in its frame, labelled. Of very many points a part is
/// looked at.
PassTrack find_pass_track(const Scan& laid, const ExtractedFeatures& extracted);

/// That of any other scan, or of a model: strips of its samples.
PassTrack find_static_track(const Features& features);

}  // namespace limen
