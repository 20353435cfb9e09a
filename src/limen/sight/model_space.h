// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limen/sight/space_view.h"

namespace limen {

/// A model's answer to what stands at a place: its surfaces, exactly. It does not contradict: people put
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

    [[nodiscard]] bool covers(const Vector3d& x) const;
  };

  [[nodiscard]] static Mask mask_of(const PlanarPolygon& polygon);
  void enter(std::int32_t index, double reach_m);

  std::vector<Mask> masks_;
  std::unordered_map<std::int64_t, std::vector<std::int32_t>> cells_;  ///< planes near each cell
};

}  // namespace limen
