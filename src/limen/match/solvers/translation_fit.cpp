// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/translation_fit.h"

#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {

TranslationFit solve_translation(const TranslationSums& sums, const Vector3d& start, double min_information) {
  TranslationFit fit;
  fit.translation = start;
  if (!(sums.weight > 0.0)) {
    fit.unobserved = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    return fit;
  }
  const Spectrum3 spectrum = spectrum_of(Matrix3d(sums.information / sums.weight));
  const Vector3d& values = spectrum.values;
  for (int i = 0; i < 3; ++i) {
    const Vector3d direction = spectrum.vectors.col(i);
    if (values[i] <= min_information) {
      fit.unobserved.push_back(direction);
    } else {
      fit.translation += direction * (direction.dot(sums.right_side) / sums.weight / values[i]);
    }
  }
  if (values[0] > 1e-15) fit.condition = std::sqrt(values[2] / values[0]);
  return fit;
}

}  // namespace limen
