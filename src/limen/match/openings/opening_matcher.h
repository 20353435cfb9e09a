// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "limen/match/openings/enumerate_opening_poses.h"
#include "limen/match/openings/opening_walls.h"

namespace limen {

/// A wall of each scan that a pose brings together, and their rectangles that agree.
struct WallMeeting {
  std::size_t source_wall = 0;
  std::size_t target_wall = 0;
  double thickness_m = 0.0;  ///< the source's face lies this far behind the target's
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< rectangles of the two walls
};

/// How far two rectangles in one frame agree.
struct RectangleFit {
  int common_edges = 0;     ///< seen in both
  double length_m = 0.0;    ///< of these
  double squares_m2 = 0.0;  ///< mean square distance of these
};

/// The walls with openings of two scans, ready to be compared in many poses.
class OpeningMatcher {
 public:
  OpeningMatcher(std::vector<WallWithOpenings> source, std::vector<WallWithOpenings> target,
                 const OpeningPoseOptions& options);

  [[nodiscard]] const std::vector<WallWithOpenings>& source() const { return source_; }
  [[nodiscard]] const std::vector<WallWithOpenings>& target() const { return target_; }

  /// Whether two rectangles, in one frame, may be one opening: a vertical and a horizontal edge seen in both,
  /// widths and heights within the tolerance where all their edges were seen.
  [[nodiscard]] bool alike(const WallRectangle& a, const WallRectangle& b) const;
  /// The fit of two rectangles that are alike, `a` shifted; none where an edge lies too far off.
  [[nodiscard]] std::optional<RectangleFit> fit_of(const WallRectangle& a, const Vector2d& shift,
                                                   const WallRectangle& b) const;
  /// Rectangles (of one frame) that fit those of a target wall under a shift, each at most once.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> pairs_at(
      const std::vector<WallRectangle>& rectangles, std::size_t target_wall, const Vector2d& shift) const;

  /// Walls of both scans that face each other rightly at a pose, a possible thickness apart; with their
  /// pairs.
  [[nodiscard]] std::vector<WallMeeting> meetings(const Rigid3& target_from_source, WallSides sides) const;
  /// Equation 14 over all walls, in the form of (9), at the pose shifted along `direction` (unit, target
  /// frame) by each of `shifts_m`. Walls across that direction are compared once: their normal is left out
  /// anyhow.
  [[nodiscard]] std::vector<SetDistance> distances_along(const Rigid3& target_from_source, WallSides sides,
                                                         const Vector3d& direction,
                                                         const std::vector<double>& shifts_m) const;

  /// A pose with the evidence for it.
  struct Fit {
    Rigid3 target_from_source;
    std::vector<WallMeeting> meetings;
    bool normal_held = false;  ///< openings of walls in several directions hold all three shifts
  };
  /// The pose that fits all edges which agree at `start` best, robustly: walls on walls, up on up, edges on
  /// edges. Where all walls are parallel, the shift across them stays as it is. None where nothing agrees.
  [[nodiscard]] std::optional<Fit> fit(const Rigid3& start, WallSides sides) const;

 private:
  [[nodiscard]] bool possible(double thickness_m, WallSides sides) const;
  [[nodiscard]] bool face(const Matrix3d& rotation, std::size_t source_wall, std::size_t target_wall,
                          WallSides sides) const;
  [[nodiscard]] double thickness_at(const Rigid3& target_from_source, std::size_t source_wall,
                                    std::size_t target_wall) const;
  /// For each shift the best gain of one source wall: a wall of the source is one wall of the target.
  [[nodiscard]] std::vector<SetDistance> best_of_wall(std::size_t source_wall,
                                                      const Rigid3& target_from_source, WallSides sides,
                                                      const Vector3d& direction,
                                                      const std::vector<double>& shifts_m) const;
  [[nodiscard]] std::vector<WallRectangle> in_target_wall(const Rigid3& target_from_source,
                                                          std::size_t source_wall, std::size_t target_wall,
                                                          WallSides sides) const;
  [[nodiscard]] Matrix3d rotation_of(const std::vector<WallMeeting>& meetings, WallSides sides) const;
  [[nodiscard]] Fit improved(const Fit& old, WallSides sides) const;

  std::vector<WallWithOpenings> source_;
  std::vector<WallWithOpenings> target_;  // rectangles by their left edge
  std::vector<std::vector<Segment>> source_edges_;
  std::vector<SegmentSetMeasure> target_measures_;
  std::vector<double> widest_m_;  // rectangle of each target wall
  double source_nominal_ = 0.0;
  double target_nominal_ = 0.0;
  OpeningPoseOptions options_;
};

}  // namespace limen
