// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_grid.h"

#include <algorithm>
#include <cmath>

namespace limen {
namespace {

constexpr double kStep = 1e-4;
constexpr double kRoundOffset = 100.0;
/// Integers are kept below this, so that a box that is given a little too small does no harm.
constexpr double kMostSteps = 2.1e9;

}  // namespace

LasBox moved_box(const LasBox& box, const Rigid3& target_from_source) {
  LasBox moved;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vector3d x{(corner & 1U) != 0 ? box.high.x() : box.low.x(),
                     (corner & 2U) != 0 ? box.high.y() : box.low.y(),
                     (corner & 4U) != 0 ? box.high.z() : box.low.z()};
    const Vector3d y = target_from_source * x;
    moved.low = corner == 0 ? y : Vector3d(moved.low.cwiseMin(y));
    moved.high = corner == 0 ? y : Vector3d(moved.high.cwiseMax(y));
  }
  return moved;
}

std::optional<LasBox> stated_box(const LasHeader& header) {
  const bool sound =
      header.low.allFinite() && header.high.allFinite() && (header.low.array() <= header.high.array()).all();
  if (!sound) return {};
  return LasBox{header.low, header.high};
}

Vector3d round_offset(const Vector3d& near) {
  return (near / kRoundOffset).array().round() * kRoundOffset;
}

LasGrid moved_grid(const LasHeader& header, const Rigid3& target_from_source, const LasBox& box) {
  LasGrid grid;
  if (target_from_source.rotation.isIdentity(0.0)) {
    grid.scale = header.scale;
    grid.offset = header.offset + target_from_source.translation;
    grid.unchanged = true;
    return grid;
  }
  double step = std::min(kStep, header.scale.cwiseAbs().minCoeff());
  const Vector3d middle = 0.5 * (box.low + box.high);
  grid.offset = round_offset(middle);
  const double reach =
      std::max((box.high - grid.offset).cwiseAbs().maxCoeff(), (box.low - grid.offset).cwiseAbs().maxCoeff());
  while (reach > kMostSteps * step && std::isfinite(reach)) step *= 10.0;
  grid.scale.setConstant(step);
  return grid;
}

}  // namespace limen
