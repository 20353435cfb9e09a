// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limen/project/retrieve/placed_plane.h"

namespace limen {

/// The walls of a part from above, and the lines of sight to what was seen.
class PlanView {
 public:
  explicit PlanView(const std::vector<PlacedPlane>& planes);

  /// The directions, modulo a quarter turn, that most wall has: one, or two where wings of a building are
  /// turned against one another. Radians.
  [[nodiscard]] const std::vector<double>& main_directions() const { return main_directions_; }

 private:
  friend class PlanImage;
  struct Wall {
    Vector2d from = Vector2d::Zero();
    Vector2d to = Vector2d::Zero();
    double angle = 0.0;   ///< of its normal
    float weight = 0.0F;  ///< 1 from 2 m of height on
  };
  struct Sight {
    Vector2d from = Vector2d::Zero();
    Vector2d to = Vector2d::Zero();
  };
  void add_wall(const PlacedPlane& plane);
  void find_main_directions(const std::vector<PlacedPlane>& planes);

  std::vector<Wall> walls_;  ///< two where a wall may face either way
  std::vector<Sight> sights_;
  std::vector<double> main_directions_;
};

/// A turn, then a shift, of one plan on another.
struct PlanPose {
  double angle = 0.0;
  Vector2d shift = Vector2d::Zero();
  double score = 0.0;  ///< pixels of wall that agree, less those that were looked through
};

/// A plan as pixels of 0.25 m: where wall is that faces each of eight ways, and where a scanner looked
/// through.
class PlanImage {
 public:
  /// No pixels where the plan is larger than 250 x 250 m.
  explicit PlanImage(const PlanView& plan);

  /// The best shifts of another plan's walls after a turn by `angle`: the highest `most` peaks of the
  /// correlation over all shifts. Time: pixels of wall of `other` times pixels of this.
  void add_best_shifts(const PlanView& other, double angle, std::size_t most,
                       std::vector<PlanPose>& poses) const;

 private:
  static constexpr int kWays = 8;
  struct Pixel {
    int x = 0;
    int y = 0;
    int way = 0;
    float weight = 0.0F;
  };
  [[nodiscard]] static int way_of(double angle);
  [[nodiscard]] static std::vector<Pixel> pixels_of(const std::vector<PlanView::Wall>& walls, double turn);
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x - x_);
  }

  int x_ = 0;  ///< of the first pixel
  int y_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::array<std::vector<float>, kWays> ways_;
};

}  // namespace limen
