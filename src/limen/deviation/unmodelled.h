// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "limen/deviation/deviation.h"

namespace limen {

/// Points that no face explains, of any number of scans: cubes of `cell_m` with what lies in them, so that
/// memory goes with the space they fill.
class UnmodelledPoints {
 public:
  explicit UnmodelledPoints(double cell_m) : cell_m_(cell_m) {}

  void add(const Vector3d& x);
  /// The pieces into which the points fall whose cubes touch; those of at least `min_points`, most points
  /// first. `low` and `high`: the model's extent.
  [[nodiscard]] std::vector<UnmodelledObject> pieces(std::size_t min_points, const Vector3d& low,
                                                     const Vector3d& high) const;

 private:
  double cell_m_;
  std::unordered_map<std::uint64_t, std::size_t> places_;  ///< in the lists below, as they came
  std::vector<std::uint64_t> keys_;
  std::vector<UnmodelledObject> cubes_;  ///< `centre` is the sum of the points
};

/// The same of points that are all there.
std::vector<UnmodelledObject> pieces_of(const std::vector<Vector3d>& points, double cell_m,
                                        std::size_t min_points, const Vector3d& low, const Vector3d& high);

}  // namespace limen
