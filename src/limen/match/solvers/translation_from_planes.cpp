// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/translation_from_planes.h"

#include <cmath>

namespace limen {

TranslationFit translation_from_planes(const Matrix3d& target_from_source_rotation,
                                       const std::vector<PlanePair>& pairs, const Vector3d& start) {
  // A direction is observed when its share of the information (eigenvalue of the weighted mean of N N^T)
  // exceeds this: one plane in three tilted by 5.4 degrees.
  constexpr double kMinInformation = 0.003;
  const auto gap = [&](const PlanePair& pair, const Vector3d& translation) {
    return -pair.target.signed_distance(target_from_source_rotation * pair.source_point + translation);
  };
  TranslationSums sums;
  for (const PlanePair& pair : pairs) {
    sums.information +=
        pair.weight * pair.target.normal * pair.target.normal.transpose();   // (22), both sides
    sums.right_side += pair.weight * gap(pair, start) * pair.target.normal;  // times N^T
    sums.weight += pair.weight;
  }
  TranslationFit fit = solve_translation(sums, start, kMinInformation);
  if (!(sums.weight > 0.0)) return fit;
  double sum = 0.0;
  for (const PlanePair& pair : pairs) sum += pair.weight * std::pow(gap(pair, fit.translation), 2);
  fit.rms_m = std::sqrt(sum / sums.weight);
  return fit;
}

}  // namespace limen
