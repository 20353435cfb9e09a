// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/translation_from_planes.h"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "limen/base/error.h"

namespace limen {

void TranslationOptions::check() const {
  if (!(min_information > 0.0 && min_information < 1.0 / 3.0)) {
    throw_bad_option("min_information", min_information, "in (0, 1/3)");
  }
}

TranslationFit translation_from_planes(const Matrix3d& target_from_source_rotation,
                                       const std::vector<PlanePair>& pairs, const Vector3d& start,
                                       const TranslationOptions& options) {
  options.check();
  Matrix3d information = Matrix3d::Zero();
  Vector3d right_side = Vector3d::Zero();
  double weight = 0.0;
  const auto gap = [&](const PlanePair& pair, const Vector3d& translation) {
    return -pair.target.signed_distance(target_from_source_rotation * pair.source_point + translation);
  };
  for (const PlanePair& pair : pairs) {
    information += pair.weight * pair.target.normal * pair.target.normal.transpose();  // (22), both sides
    right_side += pair.weight * gap(pair, start) * pair.target.normal;                 // times N^T
    weight += pair.weight;
  }
  TranslationFit fit;
  fit.translation = start;
  if (!(weight > 0.0)) {
    fit.unobserved = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    return fit;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(information / weight);
  const Vector3d& values = solver.eigenvalues();
  for (int i = 0; i < 3; ++i) {
    const Vector3d direction = solver.eigenvectors().col(i);
    if (values[i] <= options.min_information) {
      fit.unobserved.push_back(direction);
    } else {
      fit.translation += direction * (direction.dot(right_side) / weight / values[i]);
    }
  }
  if (values[0] > 1e-15) fit.condition = std::sqrt(values[2] / values[0]);
  double sum = 0.0;
  for (const PlanePair& pair : pairs) sum += pair.weight * std::pow(gap(pair, fit.translation), 2);
  fit.rms_m = std::sqrt(sum / weight);
  return fit;
}

}  // namespace limen
