// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/solvers/rigid_from_lines.h"

#include <cmath>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr double kMinSine = 1e-6;

/// Equation 15, as the columns of a matrix.
Matrix3d basis(const Vector3d& vertical, const Vector3d& horizontal) {
  const Vector3d x = vertical.normalized();
  const Vector3d across = horizontal - horizontal.dot(x) * x;
  if (!(across.norm() > kMinSine * horizontal.norm())) {
    throw Error("two parallel lines do not fix a rotation", "rotation_from_lines",
                "pair a vertical with a horizontal edge");
  }
  const Vector3d y = across.normalized();
  Matrix3d columns;
  columns << x, y, x.cross(y);
  return columns;
}

/// What a pair measures: [d]x^t [d]x (a projection across the line), less the wall's normal.
Matrix3d measured_space(const LinePair& pair) {
  const Vector3d& d = pair.target.direction;
  if (!pair.wall_normal) return Matrix3d::Identity() - d * d.transpose();
  const Vector3d across = pair.wall_normal->cross(d);
  const double sine = across.norm();
  if (!(sine > kMinSine)) return Matrix3d::Zero();  // the line runs through the wall: nothing is left
  return across * across.transpose() / (sine * sine);
}

}  // namespace

Matrix3d rotation_from_lines(const LinePair& vertical, const LinePair& horizontal) {
  return basis(vertical.target.direction, horizontal.target.direction) *
         basis(vertical.source.direction, horizontal.source.direction).transpose();  // (16)
}

TranslationFit translation_from_lines(const Matrix3d& target_from_source_rotation,
                                      const std::vector<LinePair>& pairs, const Vector3d& start,
                                      double min_information) {
  const auto gap = [&](const LinePair& pair, const Vector3d& t) {
    return Vector3d(pair.target.point - (target_from_source_rotation * pair.source.point + t));
  };
  TranslationSums sums;  // the information is -M of (19)
  for (const LinePair& pair : pairs) {
    const Matrix3d space = measured_space(pair);
    sums.information += pair.weight * space;
    sums.right_side += pair.weight * space * gap(pair, start);
    sums.weight += pair.weight;
  }
  TranslationFit fit = solve_translation(sums, start, min_information);
  if (!(sums.weight > 0.0)) return fit;
  double sum = 0.0;
  for (const LinePair& pair : pairs) {
    sum += pair.weight * (measured_space(pair) * gap(pair, fit.translation)).squaredNorm();
  }
  fit.rms_m = std::sqrt(sum / sums.weight);
  return fit;
}

Rigid3 rigid_from_lines(const LinePair& vertical, const LinePair& horizontal) {
  const Matrix3d rotation = rotation_from_lines(vertical, horizontal);
  return {rotation, translation_from_lines(rotation, {vertical, horizontal}).translation};
}

}  // namespace limen
