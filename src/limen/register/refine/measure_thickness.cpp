// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/measure_thickness.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limen {
namespace {

constexpr double kLeastPlaneSigmaM = 0.0005;  // of a plane's place at an opening

/// Neighbouring points err alike: n of them are taken for the square root of n independent ones.
double plane_sigma_m(const PlanarPolygon& plane) {
  const double independent = std::sqrt(static_cast<double>(std::max<std::size_t>(1, plane.inliers)));
  return std::hypot(kLeastPlaneSigmaM, plane.rms_m / std::sqrt(independent));
}

}  // namespace

std::vector<MeasuredThickness> measure_thickness(const RefinedPose& pose, const Features& source,
                                                 const Features& target) {
  const Matrix6d covariance = covariance_of(pose) + pose.spread;
  struct Sum {
    double gap = 0.0;
    double weight = 0.0;
    double variance = 0.0;
    int openings = 0;
  };
  std::map<std::pair<int, int>, Sum> walls;
  for (const OpeningMatch& match : pose.openings) {
    const int inner = source.openings[static_cast<std::size_t>(match.source)].facade;
    const int outer = target.openings[static_cast<std::size_t>(match.target)].facade;
    if (!match.opposite || inner < 0 || outer < 0) continue;
    const Vector3d normal = match.across.cross(match.up);
    Eigen::Matrix<double, 6, 1> row;
    row << (match.at - pose.centre).cross(normal), normal;
    Sum& sum = walls[{inner, outer}];
    sum.gap += match.area_m2 * match.gap_m;
    sum.variance += match.area_m2 * row.dot(covariance * row);
    sum.weight += match.area_m2;
    ++sum.openings;
  }
  std::vector<MeasuredThickness> measured;
  for (const auto& [wall, sum] : walls) {
    const double planes = std::hypot(plane_sigma_m(source.planes[static_cast<std::size_t>(wall.first)]),
                                     plane_sigma_m(target.planes[static_cast<std::size_t>(wall.second)]));
    // What holds the pose and the wall itself were scanned at different moments of a drive.
    const double drift = std::hypot(source.drift_m, target.drift_m);
    measured.push_back({wall.first, wall.second, sum.openings, sum.gap / sum.weight,
                        std::hypot(std::sqrt(sum.variance / sum.weight), planes, drift)});
  }
  std::stable_sort(measured.begin(), measured.end(),
                   [](const auto& a, const auto& b) { return a.openings > b.openings; });
  return measured;
}

}  // namespace limen
