// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/direction_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kMostUpTiltRad = radians(20.0);  // a cluster further from the vertical is no floor
// Directions are independent when the smallest eigenvalue of the sum of c c^T exceeds this: two lines 14
// degrees apart.
constexpr double kIndependence = 0.03;

/// Angle between two lines, [0, pi/2].
double line_angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

class Clustering {
 public:
  Clustering(const std::vector<Plane>& planes, const std::vector<double>& weights,
             const DirectionClusterOptions& options)
      : planes_(planes), weights_(weights), options_(options), order_(planes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return weight(a) > weight(b); });
  }

  DirectionClusters run() {
    choose_seeds();
    for (const int plane : order_) assign(plane);
    finish();
    return std::move(result_);
  }

 private:
  [[nodiscard]] double weight(int plane) const { return weights_[static_cast<std::size_t>(plane)]; }
  [[nodiscard]] const Vector3d& normal(int plane) const {
    return planes_[static_cast<std::size_t>(plane)].normal;
  }

  /// Step 2: each seed is the heaviest plane further than eps from all seeds before it.
  void choose_seeds() {
    for (const int plane : order_) {
      if (options_.max_clusters > 0 && static_cast<int>(result_.clusters.size()) == options_.max_clusters)
        return;
      const bool apart =
          std::all_of(result_.clusters.begin(), result_.clusters.end(), [&](const auto& cluster) {
            return line_angle(normal(plane), cluster.direction) > options_.max_angle_rad;
          });
      if (!apart) continue;
      result_.clusters.emplace_back();
      result_.clusters.back().direction = normal(plane);
      scatter_.emplace_back(Matrix3d::Zero());
      add(plane, result_.clusters.size() - 1);
    }
  }

  /// Steps 4 to 8.
  void assign(int plane) {
    double smallest = options_.max_angle_rad;
    std::size_t nearest = result_.clusters.size();
    for (std::size_t k = 0; k < result_.clusters.size(); ++k) {
      if (result_.clusters[k].planes.front() == plane) return;
      const double angle = line_angle(normal(plane), result_.clusters[k].direction);
      if (angle > smallest) continue;
      smallest = angle;
      nearest = k;
    }
    if (nearest < result_.clusters.size()) add(plane, nearest);
  }

  void add(int plane, std::size_t k) {
    DirectionCluster& cluster = result_.clusters[k];
    cluster.planes.push_back(plane);
    cluster.weight += weight(plane);
    scatter_[k] += weight(plane) * normal(plane) * normal(plane).transpose();
    if (cluster.weight <= 0.0) return;
    const Spectrum3 spectrum = spectrum_of(scatter_[k]);
    const Vector3d main = spectrum.vectors.col(2);
    cluster.direction = main.dot(normal(cluster.planes.front())) < 0.0 ? Vector3d(-main) : main;
  }

  void finish() {
    Matrix3d directions = Matrix3d::Zero();
    for (const DirectionCluster& cluster : result_.clusters)
      directions += cluster.direction * cluster.direction.transpose();
    const Spectrum3 spectrum = spectrum_of(directions);
    result_.independent = static_cast<int>((spectrum.values.array() > kIndependence).count());
  }

  const std::vector<Plane>& planes_;
  const std::vector<double>& weights_;
  const DirectionClusterOptions& options_;
  std::vector<int> order_;  ///< planes, heaviest first
  std::vector<Matrix3d> scatter_;
  DirectionClusters result_;
};

/// Steps 9 and 10: the cluster nearest to the vertical.
int horizontal_cluster(const std::vector<DirectionCluster>& clusters, const Vector3d& up) {
  double smallest = kMostUpTiltRad;
  int best = -1;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const double tilt = line_angle(clusters[k].direction, up);
    if (tilt > smallest) continue;
    smallest = tilt;
    best = static_cast<int>(k);
  }
  return best;
}

}  // namespace

DirectionClusters cluster_directions(const std::vector<Plane>& planes, const std::vector<double>& weights,
                                     const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options) {
  DirectionClusters found = Clustering(planes, weights, options).run();
  if (up) found.horizontal = horizontal_cluster(found.clusters, *up);
  return found;
}

DirectionClusters cluster_directions(const std::vector<PlanarPolygon>& polygons,
                                     const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options) {
  std::vector<Plane> planes;
  std::vector<double> weights;
  for (const PlanarPolygon& polygon : polygons) {
    planes.push_back(polygon.plane);
    weights.push_back(static_cast<double>(polygon.inliers));
  }
  return cluster_directions(planes, weights, up, options);
}

DirectionClusters cluster_directions(const std::vector<Segment>& segments, const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options) {
  constexpr double kNoLengthM = 1e-6;
  std::vector<Plane> directions;
  std::vector<double> weights;
  std::vector<int> used;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double length = segments[i].length();
    if (!(length > kNoLengthM)) continue;
    used.push_back(static_cast<int>(i));
    directions.push_back({segments[i].direction(), 0.0});
    weights.push_back(length);
  }
  DirectionClusters found = cluster_directions(directions, weights, up, options);
  for (DirectionCluster& cluster : found.clusters) {
    for (int& index : cluster.planes) index = used[static_cast<std::size_t>(index)];
  }
  return found;
}

}  // namespace limen
