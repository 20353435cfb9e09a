// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_axes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "limen/geometry/linear.h"
#include "limen/project/state/scan_names.h"

namespace limen {
namespace {

constexpr double kFloorGapM = 1.8;  // stations further apart in height stand on different floors
constexpr double kNearM = 12.0;

}  // namespace

Matrix3d project_axes(const ProjectResult& result) {
  const Vector3d up = result.up.normalized();
  // Of the frame's own axes the one that lies most level.
  const Vector3d level = std::abs(up.x()) < 0.8 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d right = (level - level.dot(up) * up).normalized();
  const Vector3d ahead = up.cross(right);
  // Walls along and across one another count as one direction: their angles, four times. Other houses, which
  // are seen through windows and across the street, do not count where there are stations.
  const bool stations = std::any_of(result.scans.begin(), result.scans.end(), [](const ProjectScan& scan) {
    return scan.component == 0 && !scan.mobile && !scan.patches.empty();
  });
  double sine = 0.0;
  double cosine = 0.0;
  for (const ProjectScan& scan : result.scans) {
    if (scan.component != 0 || (stations && scan.mobile)) continue;
    for (const PlanPatch& patch : scan.patches) {
      const bool far = !scan.mobile && !scan.model && (patch.middle - scan.sigma.centre).norm() > kNearM;
      if (!patch.upright || far) continue;
      const double angle = 4.0 * std::atan2(patch.along.dot(ahead), patch.along.dot(right));
      sine += patch.along.norm() * std::sin(angle);
      cosine += patch.along.norm() * std::cos(angle);
    }
  }
  const double turn = sine == 0.0 && cosine == 0.0 ? 0.0 : 0.25 * std::atan2(sine, cosine);
  Matrix3d axes;
  axes.row(0) = (std::cos(turn) * right + std::sin(turn) * ahead).transpose();
  axes.row(1) = (std::cos(turn) * ahead - std::sin(turn) * right).transpose();
  axes.row(2) = up.transpose();
  return axes;
}

std::string shown_name(const ProjectScan& scan) {
  const std::string name = std::filesystem::path(scan.file).filename().string();
  return scan_name(NumberedScan{name, scan.index, scan.several});
}

std::vector<std::vector<PlanSpot>> project_floors(const ProjectResult& result, const Matrix3d& axes) {
  std::vector<PlanSpot> spots;
  for (std::size_t k = 0; k < result.scans.size(); ++k) {
    const ProjectScan& scan = result.scans[k];
    if (scan.component != 0 || !scan.frame_from_scan || scan.model) continue;
    spots.push_back({k, axes * (scan.stations.empty() ? scan.sigma.centre : scan.stations.front())});
  }
  std::stable_sort(spots.begin(), spots.end(),
                   [](const PlanSpot& a, const PlanSpot& b) { return a.at.z() < b.at.z(); });
  std::vector<std::vector<PlanSpot>> floors;
  for (const PlanSpot& spot : spots) {
    if (floors.empty() || spot.at.z() - floors.back().back().at.z() > kFloorGapM) floors.emplace_back();
    floors.back().push_back(spot);
  }
  return floors;
}

}  // namespace limen
