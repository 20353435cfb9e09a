// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_scene.h"

#include <algorithm>
#include <numeric>

#include "limen/geometry/spread_evenly.h"
#include "limen/geometry/triangulate.h"

namespace limen {
namespace {

constexpr std::size_t kMostFaces = 60000;  // triangles per side

void add_points(const RegisterInput& input, std::size_t most, SceneSide& side) {
  std::size_t total = 0;
  for (const PlacedScan& one : input.scans) total += one.scan.size();
  // Far more points than are wanted: every n-th first, for the grid's sake.
  const std::size_t stride = std::max<std::size_t>(1, total / (3 * std::max<std::size_t>(most, 1)));
  std::vector<Vector3d> points;
  points.reserve(total / stride + input.scans.size());
  std::vector<std::size_t> firsts;  // of each scan among the points
  bool coloured = total > 0;
  bool measured = total > 0;
  for (const PlacedScan& one : input.scans) {
    const Scan& scan = one.scan;
    const Rigid3 side_from_scan = to_local(one.group_from_scan, scan.local_origin, side.origin);
    coloured = coloured && (scan.size() == 0 || !scan.colours.empty());
    measured = measured && (scan.size() == 0 || !scan.intensities.empty());
    firsts.push_back(points.size());
    for (std::size_t i = 0; i < scan.size(); i += stride) points.push_back(side_from_scan * scan.points[i]);
  }
  std::size_t s = 0;
  for (const std::uint32_t kept : spread_evenly(points, most)) {
    while (s + 1 < firsts.size() && firsts[s + 1] <= kept) ++s;
    const Scan& scan = input.scans[s].scan;
    const std::size_t i = (kept - firsts[s]) * stride;
    side.points.push_back(points[kept]);
    for (std::size_t c = 0; coloured && c < 3; ++c) side.colours.push_back(scan.colours[3 * i + c]);
    if (measured) side.intensities.push_back(scan.intensities[i]);
  }
}

void add_faces(const BimModel& model, SceneSide& side) {
  std::vector<std::uint32_t> order(model.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return model.faces[a].area_m2 > model.faces[b].area_m2;
  });
  const Vector3d shift = model.local_origin - side.origin;
  for (const std::uint32_t index : order) {
    const BimFace& face = model.faces[index];
    for (const Triangle2& piece : triangulate(face.outline)) {
      if (side.faces.size() == kMostFaces) return;
      side.faces.push_back({shift + face.frame.to_space(piece[0]), shift + face.frame.to_space(piece[1]),
                            shift + face.frame.to_space(piece[2])});
    }
  }
}

}  // namespace

SceneSide scene_side(const RegisterInput& input, std::size_t max_points) {
  SceneSide side;
  if (input.model) {
    side.origin = input.model->local_origin;
    add_faces(*input.model, side);
  } else if (!input.scans.empty()) {
    side.origin = input.scans.front().scan.local_origin;
    add_points(input, max_points, side);
  }
  return side;
}

SceneSide with_picture(SceneSide side, const PicturedSide& pictured) {
  const Vector3d shift = side.origin - pictured.features.local_origin;
  for (Vector3d& point : side.points) point += shift;
  for (Triangle3& face : side.faces) {
    for (Vector3d& corner : face) corner += shift;
  }
  side.origin = pictured.features.local_origin;
  side.pictured = pictured;
  return side;
}

}  // namespace limen
