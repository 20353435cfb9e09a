// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"

namespace limen {

/// Two rectangles taken for one opening under a pose, and how far the source has to move within the wall.
///
/// The wall's normal is left out: seen from its two sides the rectangles lie a wall's thickness apart
/// (2022, 3.1; the bias named there). An opening may be wider inside than outside: what left and right edge
/// say in common is the shift, what they say against one another is the splay and says nothing of the pose.
struct OpeningMatch {
  int source = -1;  ///< index into the source's openings
  int target = -1;
  Vector3d at = Vector3d::Zero();       ///< middle of the target's rectangle, target frame
  Vector3d across = Vector3d::UnitX();  ///< unit vectors in the target's wall
  Vector3d up = Vector3d::UnitZ();
  double shift_across_m = 0.0;
  double shift_up_m = 0.0;
  double sigma_across_m = 1.0;
  double sigma_up_m = 1.0;
  double area_m2 = 0.0;     ///< of the smaller rectangle
  double trust = 1.0;       ///< in (0, 1]: less for openings that were not seen through
  double gap_m = 0.0;       ///< of the source's rectangle behind the target's wall plane
  double tilt_rad = 0.0;    ///< by which the source's rectangle must turn about across x up to stand upright
  bool opposite = false;    ///< seen from the two sides of the wall
  bool by_outline = false;  ///< both saw it arched or round: its shape agrees, and holds the shift
};

/// The rectangle of an opening by a corner and its sides.
struct OpeningFrame {
  Vector3d origin = Vector3d::Zero();   ///< lower left corner
  Vector3d across = Vector3d::UnitX();  ///< unit vectors
  Vector3d up = Vector3d::UnitZ();
  double width = 0.0;
  double height = 0.0;
};

/// The openings of two scans, laid out once to be matched under many poses. Refers to both features.
class OpeningMatching {
 public:
  OpeningMatching(const Features& source, const Features& target);

  /// One-to-one matches, nearest first; middles farther apart within the wall than `gate_m` are no match.
  /// Openings that both scans saw arched or round match only where their outlines have one shape, and these
  /// then hold the shift; where one saw a rectangle, rectangles are compared. `target_from_source`: local
  /// frames.
  [[nodiscard]] std::vector<OpeningMatch> under(const Rigid3& target_from_source, double gate_m) const;

 private:
  const std::vector<Opening>& sources_;
  const std::vector<Opening>& targets_;
  std::vector<OpeningFrame> source_rectangles_;  ///< each in its own scan's frame
  std::vector<OpeningFrame> target_rectangles_;
};

}  // namespace limen
