// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/cell_lists.h"
#include "limen/sight/space_view.h"

namespace limen {

/// A model's answer to what is at a place: its surfaces, exactly. It does not contradict: people put
/// things into rooms that no model knows, so that where it has nothing its answer is `unseen`.
class ModelSpace : public SpaceView {
 public:
  /// `features` of a model; questions reach no further than `reach_m` from its surfaces.
  explicit ModelSpace(const Features& features, double reach_m = 0.3);

  [[nodiscard]] Sight look(const SightQuery& query) const override;

 private:
  /// A polygon as a bitmap in its plane, a pixel wider than it is.
  struct Mask {
    Plane plane;
    PlaneFrame frame;
    Vector2d low = Vector2d::Zero();
    int columns = 0;
    int rows = 0;
    std::vector<bool> bits;

    /// In the bitmap, not rounded.
    [[nodiscard]] Vector2d pixel_of(const Vector3d& x) const;
    [[nodiscard]] bool covers(const Vector2d& pixel) const;
  };

  [[nodiscard]] static Mask mask_of(const PlanarPolygon& polygon);
  /// The cells that a question about the surface may stand in, ascending.
  [[nodiscard]] static std::vector<std::int64_t> cells_near(const Mask& mask, double reach_m);

  std::vector<Mask> masks_;
  CellLists cells_;  ///< planes near each cell
};

}  // namespace limen
