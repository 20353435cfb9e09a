// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"
#include "limen/geometry/segment.h"

// For tests: the edges of random buildings, and what a detector would make of them.

namespace limen::synthetic {

inline Matrix3d random_rotation(RandomStream& random) {
  return uniform_rotation(random);
}

/// A turn about the vertical.
inline Matrix3d random_heading(RandomStream& random) {
  return rotation_exp({0.0, 0.0, random.uniform(-std::numbers::pi, std::numbers::pi)});
}

inline void add_box(const Vector3d& low, const Vector3d& high, std::vector<Segment>& edges) {
  for (int k = 0; k < 3; ++k) {
    for (int n = 0; n < 4; ++n) {
      const int u = (k + 1) % 3;
      const int v = (k + 2) % 3;
      Vector3d a = low;
      a[u] = n % 2 == 0 ? low[u] : high[u];
      a[v] = n / 2 == 0 ? low[v] : high[v];
      Vector3d b = a;
      b[k] = high[k];
      edges.push_back({a, b});
    }
  }
}

/// The outline of an opening in a wall across `axis` (0: x, 1: y) at `place`.
inline void add_opening(int axis, double place, const Vector2d& low, const Vector2d& high,
                        std::vector<Segment>& edges) {
  const auto at = [&](double across, double up) {
    Vector3d x(across, across, up);
    x[axis] = place;
    return x;
  };
  const Vector3d corners[4] = {at(low.x(), low.y()), at(high.x(), low.y()), at(high.x(), high.y()),
                               at(low.x(), high.y())};
  for (std::size_t k = 0; k < 4; ++k) edges.push_back({corners[k], corners[(k + 1) % 4]});
}

/// One room: its box, a door or two, a window or two, and some shelves and beams.
inline std::vector<Segment> random_room(const Vector3d& low, const Vector3d& high, RandomStream& random) {
  std::vector<Segment> edges;
  add_box(low, high, edges);
  for (int n = 0; n < 4; ++n) {
    const int axis = static_cast<int>(random.below(2));
    const double place = random.below(2) == 0 ? low[axis] : high[axis];
    const int across = 1 - axis;
    const double left = random.uniform(low[across], high[across] - 1.0);
    const double sill = n < 2 ? low.z() : low.z() + random.uniform(0.6, 1.1);
    const double top = std::min(high.z() - 0.1, low.z() + random.uniform(1.9, 2.3));
    add_opening(axis, place, {left, sill}, {left + random.uniform(0.7, 1.0), top}, edges);
  }
  for (int n = 0; n < 3; ++n) {
    Vector3d a;
    Vector3d b;
    for (int k = 0; k < 3; ++k) {
      a[k] = random.uniform(low[k], high[k] - 0.4);
      b[k] = a[k] + random.uniform(0.3, std::min(1.5, high[k] - a[k]));
    }
    add_box(a, b, edges);
  }
  return edges;
}

/// A building of `storeys` x `across` x `along` rooms of random sizes; every room's edges apart.
inline std::vector<std::vector<Segment>> random_building(int storeys, int across, int along,
                                                         RandomStream& random) {
  const auto lines = [&random](int count, double least, double most) {
    std::vector<double> places = {0.0};
    for (int k = 0; k < count; ++k) places.push_back(places.back() + random.uniform(least, most));
    return places;
  };
  const std::vector<double> x = lines(across, 2.5, 7.0);
  const std::vector<double> y = lines(along, 2.5, 7.0);
  const std::vector<double> z = lines(storeys, 2.6, 3.4);
  std::vector<std::vector<Segment>> rooms;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        rooms.push_back(random_room({x[i] + 0.1, y[j] + 0.1, z[k]},
                                    {x[i + 1] - 0.1, y[j + 1] - 0.1, z[k + 1] - 0.25}, random));
      }
    }
  }
  return rooms;
}

inline std::vector<Segment> joined(const std::vector<std::vector<Segment>>& rooms) {
  std::vector<Segment> all;
  for (const auto& room : rooms) all.insert(all.end(), room.begin(), room.end());
  return all;
}

/// What a detector makes of edges: a share of them found, some in two fragments, ends shortened, all ends
/// noisy, and others that are none.
struct Detector {
  double found_share = 0.7;
  double split_share = 0.2;
  double spurious_share = 0.2;  ///< of the number found
  double noise_m = 0.01;        ///< of every end, per axis
};

inline std::vector<Segment> detect(const std::vector<Segment>& edges, const Detector& detector,
                                   RandomStream& random) {
  std::vector<Segment> found;
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  const auto noise = [&]() -> Vector3d {
    const double x = random.normal();
    const double y = random.normal();
    return detector.noise_m * Vector3d(x, y, random.normal());
  };
  const auto add = [&](const Segment& edge, double from, double to) {
    const Vector3d way = edge.b - edge.a;
    Segment piece = {edge.a + from * way + noise(), edge.a + to * way + noise()};
    if (random.below(2) == 0) std::swap(piece.a, piece.b);
    if (piece.length() > 0.15) found.push_back(piece);
  };
  for (const Segment& edge : edges) {
    low = low.cwiseMin(edge.a.cwiseMin(edge.b));
    high = high.cwiseMax(edge.a.cwiseMax(edge.b));
    if (random.uniform() > detector.found_share) continue;
    const double from = random.uniform(0.0, 0.15);
    const double to = random.uniform(0.85, 1.0);
    if (random.uniform() < detector.split_share) {
      const double cut = random.uniform(from + 0.1, to - 0.1);
      add(edge, from, cut - 0.02);
      add(edge, cut + 0.02, to);
    } else {
      add(edge, from, to);
    }
  }
  const auto spurious = static_cast<std::size_t>(detector.spurious_share * static_cast<double>(found.size()));
  for (std::size_t n = 0; n < spurious; ++n) {
    Vector3d a;
    for (int k = 0; k < 3; ++k) a[k] = random.uniform(low[k], high[k]);
    // Half of them along the building's axes: shadows' borders, furniture.
    Vector3d direction = Vector3d::Unit(static_cast<Eigen::Index>(random.below(3)));
    if (n % 2 == 0) direction = normal_vector(random).normalized();
    found.push_back({a, a + random.uniform(0.2, 1.5) * direction});
  }
  return found;
}

inline std::vector<Segment> moved(const std::vector<Segment>& segments, const Rigid3& b_from_a) {
  std::vector<Segment> result;
  for (const Segment& segment : segments) result.push_back({b_from_a * segment.a, b_from_a * segment.b});
  return result;
}

}  // namespace limen::synthetic
