// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/published/published_pose.h"

#include <algorithm>
#include <iterator>

namespace limen {

std::vector<WallEdges> wall_edges(const Features& features, bool upright) {
  std::optional<Vector3d> up;
  if (upright) up = Vector3d::UnitZ();
  std::vector<WallEdges> walls;
  for (const WallWithOpenings& wall : walls_with_openings(features, up)) {
    WallEdges edges;
    edges.normal = wall.normal();
    edges.right = wall.frame.u;
    for (const WallRectangle& rectangle : wall.rectangles) {
      for (const std::size_t k : {0U, 2U}) {
        edges.horizontal.push_back(edge_segment(wall, rectangle, k));
        edges.corners.push_back(edges.horizontal.back().a);
        edges.corners.push_back(edges.horizontal.back().b);
      }
      for (const std::size_t k : {1U, 3U}) edges.vertical.push_back(edge_segment(wall, rectangle, k));
    }
    walls.push_back(std::move(edges));
  }
  return walls;
}

std::vector<Segment> all_edges(const std::vector<WallEdges>& walls) {
  std::vector<Segment> all;
  for (const WallEdges& wall : walls) {
    all.insert(all.end(), wall.horizontal.begin(), wall.horizontal.end());
    all.insert(all.end(), wall.vertical.begin(), wall.vertical.end());
  }
  return all;
}

std::vector<PlanarPolygon> common_polygons(const Features& features, bool outside) {
  constexpr std::size_t kMostPolygons = 24;
  std::vector<PlanarPolygon> common;
  std::copy_if(features.planes.begin(), features.planes.end(), std::back_inserter(common),
               [outside](const PlanarPolygon& polygon) { return polygon.interior == outside; });
  std::stable_sort(common.begin(), common.end(),
                   [](const PlanarPolygon& a, const PlanarPolygon& b) { return a.inliers > b.inliers; });
  if (common.size() > kMostPolygons) common.resize(kMostPolygons);
  return common;
}

}  // namespace limen
