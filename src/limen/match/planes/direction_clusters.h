// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/base/angles.h"
#include "limen/geometry/polygon.h"
#include "limen/geometry/segment.h"

// Djahel, Monasse, Vallet 2021, section 3.2.2, algorithm 1: greedy clustering of planes by direction.
//
// Departures from the printed text:
// - the seeds' test lacks the absolute value: a direction is a line, so |n . c| < cos(eps) is meant;
// - eps is an angle for the seeds but is compared with 1 - |n . c| for the others: here |n . c| >= cos(eps)
//   throughout;
// - the weighted centroid of normals of either sign is meaningless: a cluster's direction is the main
//   eigenvector of the sum of w n n^T;
// - the printed algorithm takes for granted that three independent directions exist: `independent`
//   says whether they do;
// - any number of directions, for buildings with oblique wings: a smaller eps and max_clusters = 0.

namespace limen {

struct DirectionClusterOptions {
  /// eps of algorithm 1, in (0, pi/2): 45 degrees gives the published three directions; about 10 degrees
  /// distinguishes oblique wings.
  double max_angle_rad = radians(45.0);
  int max_clusters = 3;  ///< 0: as many as there are, >= 0
};

/// Planes whose normals are about parallel or opposed.
struct DirectionCluster {
  Vector3d direction = Vector3d::UnitZ();  ///< unit, on the side of the heaviest plane's normal
  double weight = 0.0;                     ///< sum of the planes' weights
  std::vector<int> planes;                 ///< indices, heaviest first; the first is the seed
};

struct DirectionClusters {
  std::vector<DirectionCluster> clusters;  ///< in the order of their seeds, heaviest seed first
  int horizontal = -1;                     ///< the cluster of floors and ceilings; -1: none, or no gravity
  int independent = 0;                     ///< rank of the directions: 0 to 3
};

/// `weights`: one per plane (inliers, or area), >= 0. `up`: unit vector against gravity where it is known.
DirectionClusters cluster_directions(const std::vector<Plane>& planes, const std::vector<double>& weights,
                                     const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options = {});
/// The same with the inliers as weights, as published.
DirectionClusters cluster_directions(const std::vector<PlanarPolygon>& polygons,
                                     const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options = {});
/// The same for the directions of segments, weighted by their lengths (2023, section IV-B); `planes` of the
/// result are indices of segments. Segments shorter than a micrometre count nowhere.
DirectionClusters cluster_directions(const std::vector<Segment>& segments, const std::optional<Vector3d>& up,
                                     const DirectionClusterOptions& options = {});

}  // namespace limen
