// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// A street of 100 m that a pass drives along while its trajectory walks off, and stations that stand in it:
/// digests as scans of it would give them. The world is the frame of all; what a pass sees is off by how far
/// it has strayed then.
class SyntheticStreet {
 public:
  static constexpr int kKnots = 41;
  static constexpr double kKnotM = 2.5;
  static constexpr double kPassSeesM = 8.0;  // ahead and behind

  SyntheticStreet(double drift_m, std::uint64_t seed) : random_(seed, 3) {
    // A walk in steps of a quarter of a knot, about its own mean.
    const int steps = 4 * (kKnots - 1);
    const double step_m = drift_m * std::sqrt(6.0 / steps);
    walked_.emplace_back(Vector3d::Zero());
    for (int k = 0; k < steps; ++k) walked_.emplace_back(walked_.back() + step_m * normal_vector(random_));
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& at : walked_) mean += at / static_cast<double>(walked_.size());
    for (Vector3d& at : walked_) at -= mean;
  }

  /// By how much the pass has strayed at a place along its way, in knots.
  [[nodiscard]] Vector3d strayed(double place) const {
    const double at = std::clamp(4.0 * place, 0.0, static_cast<double>(walked_.size() - 1));
    const auto before = std::min(static_cast<std::size_t>(at), walked_.size() - 2);
    const double share = at - static_cast<double>(before);
    return (1.0 - share) * walked_[before] + share * walked_[before + 1];
  }
  static double x_of(double place) { return kKnotM * place - 50.0; }

  ProjectNode pass() {
    ProjectNode node;
    node.digest.mobile = true;
    for (int k = 0; k < kKnots; ++k) {
      node.digest.track.way.times_s.push_back(100.0 + k);
      node.digest.track.way.distances_m.push_back(kKnotM * k);
      node.digest.track.way.places.emplace_back(x_of(k), 0.0, 2.0);
    }
    for (double part = 0.5; part < kKnots - 1; part += 1.0) see(x_of(part), part, kPassSeesM, node.digest);
    settle(node.digest);
    return node;
  }

  /// What is at `x` sees the street as far as 12 m.
  ProjectNode station(double x) {
    ProjectNode node;
    see(x, -1.0, 12.0, node.digest);
    settle(node.digest);
    return node;
  }

  /// The walls, the road and the house fronts across: planes are numbered alike in all scans.
  static constexpr std::int32_t kPlanes = 9;

 private:
  /// Strips of 2 m of all surfaces within reach, of a pass as it has strayed there.
  void see(double x, double place, double reach_m, ScanDigest& digest) {
    const Vector3d off = place < 0.0 ? Vector3d(Vector3d::Zero()) : strayed(place);
    for (double along = -56.0; along < 56.0; along += 2.0) {
      if (std::abs(along + 1.0 - x) > reach_m) continue;
      strip(0, {along, 9.0, 1.0}, Vector3d::UnitX(), Vector3d::UnitZ(), off, place, digest);
      strip(1, {along, -8.0, 1.0}, Vector3d::UnitX(), Vector3d::UnitZ(), off, place, digest);
      strip(2, {along, 0.0, 0.0}, Vector3d::UnitX(), Vector3d::UnitY(), off, place, digest);
    }
    for (std::int32_t front = 0; front < 6; ++front) {
      const double stands = -50.0 + 20.0 * front;
      if (std::abs(stands - x) > reach_m) continue;
      strip(3 + front, {stands, 6.5, 1.0}, Vector3d::UnitY(), Vector3d::UnitZ(), off, place, digest);
    }
  }

  void strip(std::int32_t plane, const Vector3d& corner, const Vector3d& u, const Vector3d& v,
             const Vector3d& off, double place, ScanDigest& digest) {
    constexpr double kNoiseM = 0.001;
    PassStrip seen;
    seen.plane = plane;
    seen.place = std::max(0.0, place);
    seen.anchor = corner + u + v;
    const Vector3d normal = u.cross(v);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 3; ++j)
        seen.moments.add(corner + (0.25 + 0.5 * i) * u + (0.3 + 0.6 * j) * v + off +
                         kNoiseM * random_.normal() * normal - seen.anchor);
    }
    digest.track.strips.push_back(seen);
  }

  /// Planes of all that the strips show.
  static void settle(ScanDigest& digest) {
    std::vector<PointMoments> seen(kPlanes);
    for (const PassStrip& strip : digest.track.strips)
      seen[static_cast<std::size_t>(strip.plane)].add(strip.anchor + strip.moments.mean());
    digest.planes.resize(kPlanes);
    for (std::int32_t k = 0; k < kPlanes; ++k) {
      PlaneDigest& plane = digest.planes[static_cast<std::size_t>(k)];
      plane.plane.normal = k < 2 ? Vector3d::UnitY() : k == 2 ? Vector3d::UnitZ() : Vector3d::UnitX();
      const PointMoments& points = seen[static_cast<std::size_t>(k)];
      if (points.count < 1.0) continue;
      plane.centroid = points.mean();
      plane.plane.offset = plane.plane.normal.dot(plane.centroid);
      for (const PassStrip& strip : digest.track.strips) {
        if (strip.plane != k) continue;
        const Vector3d middle = strip.anchor + strip.moments.mean() - plane.centroid;
        for (const double u : {-0.75, 0.75}) {
          for (const double v : {-0.6, 0.6})
            plane.moments.add(middle + u * (k < 3 ? Vector3d::UnitX() : Vector3d::UnitY()) +
                              v * (k == 2 ? Vector3d::UnitY() : Vector3d::UnitZ()));
        }
      }
      plane.area_m2 = plane.moments.count;  // a square metre each
    }
  }

  RandomStream random_;
  std::vector<Vector3d> walked_;
};

}  // namespace limen
