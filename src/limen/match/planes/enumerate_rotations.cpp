// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/enumerate_rotations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kMinAngleDeg = 25.0;          // two directions nearer than this fix no rotation
constexpr std::ptrdiff_t kMostDirections = 8;  // heaviest directions used per scan

/// The rotation that takes the frame of (a1, a2) to that of (b1, b2).
Matrix3d rotation_of_pair(const Vector3d& a1, const Vector3d& a2, const Vector3d& b1, const Vector3d& b2) {
  const Matrix3d correlation =
      b1 * a1.transpose() + b2 * a2.transpose() + b1.cross(b2) * a1.cross(a2).transpose();
  return nearest_rotation(correlation);
}

/// Least squares (Wahba) over all directions of the source that meet one of the target, signs as they fall.
Matrix3d refined(const Matrix3d& start, const std::vector<AxisDirection>& source,
                 const std::vector<AxisDirection>& target, double gate) {
  Matrix3d rotation = start;
  for (int round = 0; round < 2; ++round) {
    Matrix3d correlation = Matrix3d::Zero();
    std::vector<Vector3d> used;
    for (const AxisDirection& a : source) {
      const Vector3d turned = rotation * a.direction;
      const AxisDirection* nearest = nullptr;
      double best = std::cos(gate);
      for (const AxisDirection& b : target) {
        const double cosine = std::abs(turned.dot(b.direction));
        if (cosine > best) {
          best = cosine;
          nearest = &b;
        }
      }
      if (nearest == nullptr) continue;
      const double sign = turned.dot(nearest->direction) < 0 ? -1.0 : 1.0;
      correlation +=
          std::min(a.weight, nearest->weight) * sign * nearest->direction * a.direction.transpose();
      used.push_back(turned);
    }
    // Two independent directions are needed; with exactly two the third row follows from the determinant.
    const bool enough = std::any_of(used.begin(), used.end(), [&](const Vector3d& d) {
      return std::abs(d.dot(used.front())) < std::cos(radians(kMinAngleDeg));
    });
    if (!enough) return rotation;
    rotation = nearest_rotation(correlation);
  }
  return rotation;
}

bool keeps_up(const Matrix3d& rotation, double tolerance_rad) {
  return rotation(2, 2) > std::cos(tolerance_rad);
}

}  // namespace

std::vector<AxisDirection> axis_directions(const Features& features, double cluster_deg) {
  std::vector<std::size_t> order(features.planes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return features.planes[a].area_m2 > features.planes[b].area_m2;
  });
  struct Cluster {
    Matrix3d outer = Matrix3d::Zero();
    AxisDirection axis;
  };
  std::vector<Cluster> clusters;
  for (const std::size_t i : order) {
    const PlanarPolygon& plane = features.planes[i];
    if (plane.area_m2 <= 0) continue;
    const auto near = std::find_if(clusters.begin(), clusters.end(), [&](const Cluster& cluster) {
      return std::abs(cluster.axis.direction.dot(plane.plane.normal)) >= std::cos(radians(cluster_deg));
    });
    Cluster& cluster = near != clusters.end() ? *near : clusters.emplace_back();
    cluster.outer += plane.area_m2 * plane.plane.normal * plane.plane.normal.transpose();
    cluster.axis.weight += plane.area_m2;
    const Spectrum3 spectrum = spectrum_of(cluster.outer);
    cluster.axis.direction = spectrum.vectors.col(2);
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.axis.weight > b.axis.weight; });
  std::vector<AxisDirection> axes;
  for (const Cluster& cluster : clusters) axes.push_back(cluster.axis);
  return axes;
}

std::vector<Matrix3d> enumerate_rotations(const std::vector<AxisDirection>& source,
                                          const std::vector<AxisDirection>& target,
                                          const RotationOptions& options) {
  std::vector<AxisDirection> from(
      source.begin(),
      source.begin() + std::min<std::ptrdiff_t>(kMostDirections, static_cast<std::ptrdiff_t>(source.size())));
  std::vector<AxisDirection> to(
      target.begin(),
      target.begin() + std::min<std::ptrdiff_t>(kMostDirections, static_cast<std::ptrdiff_t>(target.size())));
  if (options.gravity_known) {
    // The vertical is a direction of both scans even where neither floor nor ceiling was seen.
    from.push_back({Vector3d::UnitZ(), 1.0});
    to.push_back({Vector3d::UnitZ(), 1.0});
  }
  std::vector<Matrix3d> rotations;
  const double gate = radians(options.direction_deg);
  const auto add = [&](const Matrix3d& rotation) {
    if (options.gravity_known && !keeps_up(rotation, radians(options.gravity_tolerance_deg))) return;
    const Matrix3d better = refined(rotation, from, to, gate);
    const bool known = std::any_of(rotations.begin(), rotations.end(), [&](const Matrix3d& other) {
      return rotation_angle(other.transpose() * better) < radians(options.same_rotation_deg);
    });
    if (!known) rotations.push_back(better);
  };
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t j = i + 1; j < from.size(); ++j) {
      const double cosine = from[i].direction.dot(from[j].direction);
      if (std::abs(cosine) > std::cos(radians(kMinAngleDeg))) continue;
      for (std::size_t k = 0; k < to.size(); ++k) {
        for (std::size_t l = 0; l < to.size(); ++l) {
          if (k == l) continue;
          for (const double sign : {1.0, -1.0}) {
            const double other = sign * to[k].direction.dot(to[l].direction);
            if (std::abs(std::acos(std::clamp(other, -1.0, 1.0)) - std::acos(std::clamp(cosine, -1.0, 1.0))) >
                gate) {
              continue;
            }
            add(rotation_of_pair(from[i].direction, from[j].direction, to[k].direction,
                                 sign * to[l].direction));
            add(rotation_of_pair(from[i].direction, from[j].direction, -to[k].direction,
                                 -sign * to[l].direction));
          }
        }
      }
    }
  }
  return rotations;
}

}  // namespace limen
