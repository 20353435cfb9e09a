// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "limen/base/angles.h"

namespace limen {
namespace {

/// Newell's normal: twice the area vector of a planar ring.
Vector3d area_vector(const std::vector<Vector3d>& ring) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i)
    sum += (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]);
  return sum;
}

/// The parts of [0, height] that no hole over the strip [u0, u1] takes away.
std::vector<std::pair<double, double>> free_intervals(const std::vector<PanelRect>& holes, double u,
                                                      double height) {
  std::vector<std::pair<double, double>> blocked;
  for (const PanelRect& hole : holes)
    if (hole.u0 < u && u < hole.u1) blocked.emplace_back(hole.v0, hole.v1);
  std::sort(blocked.begin(), blocked.end());
  std::vector<std::pair<double, double>> free;
  double v = 0.0;
  for (const auto& [low, high] : blocked) {
    if (low > v) free.emplace_back(v, low);
    v = std::max(v, high);
  }
  if (v < height) free.emplace_back(v, height);
  return free;
}

/// Where strips of a panel begin and end.
std::vector<double> cuts_of(const std::vector<PanelRect>& holes, double width) {
  std::vector<double> cuts = {0.0, width};
  for (const PanelRect& hole : holes) {
    cuts.push_back(std::clamp(hole.u0, 0.0, width));
    cuts.push_back(std::clamp(hole.u1, 0.0, width));
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

constexpr double kMergeDistance = 1e-3;
const double kMergeCosine = std::cos(radians(0.01));

/// Planes in cells of their offset, so that only a few are compared.
class PlaneIndex {
 public:
  int find_or_add(const Plane& plane, std::vector<TruePlane>& planes) {
    const auto cell = static_cast<long>(std::floor(plane.offset / kMergeDistance));
    for (long near = cell - 1; near <= cell + 1; ++near) {
      const auto found = cells_.find(near);
      if (found == cells_.end()) continue;
      for (const int id : found->second)
        if (same(planes[static_cast<std::size_t>(id)].plane, plane)) return id;
    }
    const int id = static_cast<int>(planes.size());
    planes.push_back({.plane = plane, .element = Element::wall, .area_m2 = 0.0, .inliers = {}});
    cells_[cell].push_back(id);
    return id;
  }

 private:
  static bool same(const Plane& a, const Plane& b) {
    return a.normal.dot(b.normal) > kMergeCosine && std::abs(a.offset - b.offset) < kMergeDistance;
  }
  std::map<long, std::vector<int>> cells_;
};

}  // namespace

int Mesh::add_surface(const Surface& surface) {
  surfaces_.push_back(surface);
  return static_cast<int>(surfaces_.size()) - 1;
}

void Mesh::add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c, int surface) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), {a, b, c});
  triangles_.push_back({first, first + 1, first + 2});
  surface_of_triangle_.push_back(surface);
  surfaces_[static_cast<std::size_t>(surface)].area_m2 += 0.5 * (b - a).cross(c - a).norm();
}

int Mesh::add_polygon(const std::vector<Vector3d>& ring, const Surface& like) {
  Surface surface = like;
  surface.plane.normal = area_vector(ring).normalized();
  surface.plane.offset = surface.plane.normal.dot(ring[0]);
  const int id = add_surface(surface);
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) add_triangle(ring[0], ring[i], ring[i + 1], id);
  return id;
}

int Mesh::add_sheet(const std::vector<Vector3d>& ring, const Surface& like) {
  const int front = add_polygon(ring, like);
  Surface back = surfaces_[static_cast<std::size_t>(front)];
  back.plane = back.plane.flipped();
  back.back = front;
  const int back_id = add_surface(back);
  surfaces_[static_cast<std::size_t>(front)].back = back_id;
  return front;
}

int Mesh::add_panel(const PlaneFrame& frame, const Vector2d& size, const std::vector<PanelRect>& holes,
                    const Surface& like) {
  Surface surface = like;
  surface.plane.normal = frame.u.cross(frame.v).normalized();
  surface.plane.offset = surface.plane.normal.dot(frame.origin);
  const int id = add_surface(surface);
  const std::vector<double> cuts = cuts_of(holes, size.x());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    for (const auto& [low, high] : free_intervals(holes, 0.5 * (cuts[i] + cuts[i + 1]), size.y())) {
      const Vector3d a = frame.to_space({cuts[i], low});
      const Vector3d c = frame.to_space({cuts[i + 1], high});
      add_triangle(a, frame.to_space({cuts[i + 1], low}), c, id);
      add_triangle(a, c, frame.to_space({cuts[i], high}), id);
    }
  }
  return id;
}

void Mesh::add_prism(const std::vector<Vector3d>& ring, double height, const Surface& like) {
  const Vector3d up(0.0, 0.0, height);
  std::vector<Vector3d> top;
  top.reserve(ring.size());
  for (const Vector3d& corner : ring) top.push_back(corner + up);
  add_polygon(top, like);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    add_polygon({ring[i], ring[next], top[next], top[i]}, like);
  }
}

void Mesh::add_box(const BoxPlace& place, const Vector3d& size, const Surface& like) {
  const Vector3d x = 0.5 * size.x() * Vector3d(std::cos(place.yaw_rad), std::sin(place.yaw_rad), 0.0);
  const Vector3d y = 0.5 * size.y() * Vector3d(-std::sin(place.yaw_rad), std::cos(place.yaw_rad), 0.0);
  const std::vector<Vector3d> ring = {place.base - x - y, place.base + x - y, place.base + x + y,
                                      place.base - x + y};
  add_prism(ring, size.z(), like);
  add_polygon({ring[3], ring[2], ring[1], ring[0]}, like);
}

void Mesh::add_shifted(std::size_t first_surface, const std::array<std::size_t, 2>& range,
                       const Vector3d& shift) {
  std::map<int, int> copies;
  for (std::size_t i = range[0]; i < range[1]; ++i) {
    const int original = surface_of_triangle_[i];
    if (static_cast<std::size_t>(original) < first_surface) continue;
    if (copies.find(original) == copies.end()) {
      Surface copy = surfaces_[static_cast<std::size_t>(original)];
      copy.plane.offset += copy.plane.normal.dot(shift);
      copy.area_m2 = 0.0;
      copies[original] = add_surface(copy);
    }
    const std::array<std::uint32_t, 3> corners = triangles_[i];
    add_triangle(vertices_[corners[0]] + shift, vertices_[corners[1]] + shift, vertices_[corners[2]] + shift,
                 copies[original]);
  }
}

MergedPlanes merge_planes(const Mesh& mesh) {
  MergedPlanes merged;
  PlaneIndex index;
  std::vector<double> largest;
  for (const Surface& surface : mesh.surfaces()) {
    if (!surface.planar || surface.element == Element::portal) {
      merged.plane_of_surface.push_back(-1);
      continue;
    }
    const int id = index.find_or_add(surface.plane, merged.planes);
    merged.plane_of_surface.push_back(id);
    const auto slot = static_cast<std::size_t>(id);
    largest.resize(merged.planes.size(), -1.0);
    merged.planes[slot].area_m2 += surface.area_m2;
    if (surface.area_m2 > largest[slot]) {
      largest[slot] = surface.area_m2;
      merged.planes[slot].element = surface.element;
      merged.planes[slot].plane = surface.plane;
    }
  }
  return merged;
}

Surface surface_of(Element element, int opening) {
  Surface surface;
  surface.element = element;
  surface.opening = opening;
  switch (element) {
    case Element::wall:
      surface.reflectivity = 0.7;
      break;
    case Element::ceiling:
      surface.reflectivity = 0.85;
      break;
    case Element::floor:
      surface.reflectivity = 0.4;
      break;
    case Element::glass:
      surface.reflectivity = 0.5;
      break;
    case Element::frame:
    case Element::mullion:
      surface.reflectivity = 0.8;
      break;
    case Element::ground:
      surface.reflectivity = 0.2;
      break;
    case Element::car:
      surface.reflectivity = 0.25;
      break;
    case Element::tree:
      surface.reflectivity = 0.45;
      break;
    default:
      break;
  }
  surface.planar = element != Element::tree && element != Element::pole;
  return surface;
}

}  // namespace limen
