// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/buildings/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "limen/base/angles.h"
#include "limen/geometry/polygon.h"
#include "limen/geometry/polygon_clip.h"

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

/// Coordinates in a flat panel with four corners: (0, 0), (1, 0), (1, 1), (0, 1) at its corners, even along
/// each line of the other coordinate.
class QuadPanel {
 public:
  explicit QuadPanel(const std::array<Vector3d, 4>& corners, const Vector3d& normal)
      : corners_(corners),
        s_(corners[1] - corners[0]),
        t_(corners[3] - corners[0]),
        st_(corners[2] - corners[1] - t_),
        u_(s_.normalized()),
        v_(normal.cross(u_)) {}

  [[nodiscard]] Vector3d at(const Vector2d& p) const {
    // The corners themselves are met to the last bit: neighbouring panels have them in common.
    if (p.x() == 1.0 && p.y() == 1.0) return corners_[2];
    if (p.x() == 1.0 && p.y() == 0.0) return corners_[1];
    if (p.x() == 0.0 && p.y() == 1.0) return corners_[3];
    return corners_[0] + p.x() * s_ + p.y() * t_ + p.x() * p.y() * st_;
  }

  /// Newton's iteration: the panel is nearly a rectangle.
  [[nodiscard]] Vector2d coordinates_of(const Vector3d& x) const {
    Vector2d p(s_.dot(x - corners_[0]) / s_.squaredNorm(), t_.dot(x - corners_[0]) / t_.squaredNorm());
    for (int step = 0; step < 8; ++step) {
      const Vector3d off = x - at(p);
      const Vector3d by_s = s_ + p.y() * st_;
      const Vector3d by_t = t_ + p.x() * st_;
      const double a = u_.dot(by_s);
      const double b = u_.dot(by_t);
      const double c = v_.dot(by_s);
      const double d = v_.dot(by_t);
      const Vector2d r(u_.dot(off), v_.dot(off));
      p += Vector2d(d * r.x() - b * r.y(), a * r.y() - c * r.x()) / (a * d - b * c);
    }
    return p;
  }

  [[nodiscard]] Vector2d size() const { return {s_.norm(), t_.norm()}; }

 private:
  std::array<Vector3d, 4> corners_;
  Vector3d s_, t_, st_, u_, v_;
};

/// The corner of a rectangle that lies farthest along `normal`: lower left, lower right, upper right, upper
/// left.
std::size_t farthest_corner(const Vector2d& normal) {
  if (normal.y() < 0.0) return normal.x() < 0.0 ? 0 : 1;
  return normal.x() < 0.0 ? 3 : 2;
}

/// What lies between a convex ring and a rectangle round it: triangles of the ring's points and the
/// rectangle's corners, which are numbered after the ring's. Both run counter-clockwise.
std::vector<std::array<std::size_t, 3>> rim_triangles(const Ring& ring) {
  const std::size_t n = ring.size();
  std::vector<std::array<std::size_t, 3>> triangles;
  const auto corner_of = [&](std::size_t i) {
    const Vector2d edge = ring[(i + 1) % n] - ring[i % n];
    return farthest_corner({edge.y(), -edge.x()});
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t corner = corner_of(i);
    const std::size_t next = (i + 1) % n;
    triangles.push_back({i, n + corner, next});
    for (std::size_t k = corner; k != corner_of(i + 1); k = (k + 1) % 4)
      triangles.push_back({next, n + k, n + (k + 1) % 4});
  }
  return triangles;
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

/// Planes in cells of their offset, so that only a few are compared.
class PlaneIndex {
 public:
  explicit PlaneIndex(double distance_m)
      : distance_(distance_m),
        cosine_(std::min(std::cos(radians(0.01 * (distance_m / 1e-3))), 1.0 - 1e-15)) {}

  int find_or_add(const Plane& plane, std::vector<TruePlane>& planes) {
    const auto cell = static_cast<long>(std::floor(plane.offset / distance_));
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
  [[nodiscard]] bool same(const Plane& a, const Plane& b) const {
    return a.normal.dot(b.normal) > cosine_ && std::abs(a.offset - b.offset) < distance_;
  }
  double distance_;
  double cosine_;
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

int Mesh::add_quad_panel(const std::array<Vector3d, 4>& corners, const Plane& plane,
                         const std::vector<std::vector<Vector3d>>& holes, const Surface& like) {
  constexpr double kRim = 0.01;
  Surface surface = like;
  surface.plane = plane;
  const int id = add_surface(surface);
  const QuadPanel panel(corners, plane.normal);
  // Each hole lies in a rectangle of the panel's coordinates; what is between them is filled by triangles.
  std::vector<PanelRect> cut;
  for (const std::vector<Vector3d>& hole : holes) {
    Ring ring;
    for (const Vector3d& x : hole) ring.push_back(panel.coordinates_of(x));
    std::vector<Vector3d> points = hole;
    if (signed_area(ring) < 0.0) {
      std::reverse(ring.begin(), ring.end());
      std::reverse(points.begin(), points.end());
    }
    auto [low, high] = box_of(ring);
    const Vector2d rim = Vector2d(kRim, kRim).cwiseQuotient(panel.size());
    low = (low - rim).cwiseMax(0.0);
    high = (high + rim).cwiseMin(1.0);
    cut.push_back({low.x(), low.y(), high.x(), high.y()});
    for (const Vector2d& p : {low, Vector2d(high.x(), low.y()), high, Vector2d(low.x(), high.y())})
      points.push_back(panel.at(p));
    for (const auto& t : rim_triangles(ring)) add_triangle(points[t[0]], points[t[1]], points[t[2]], id);
  }
  const std::vector<double> cuts = cuts_of(cut, 1.0);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    for (const auto& [lower, upper] : free_intervals(cut, 0.5 * (cuts[i] + cuts[i + 1]), 1.0)) {
      const Vector3d a = panel.at({cuts[i], lower});
      const Vector3d c = panel.at({cuts[i + 1], upper});
      add_triangle(a, panel.at({cuts[i + 1], lower}), c, id);
      add_triangle(a, c, panel.at({cuts[i], upper}), id);
    }
  }
  return id;
}

void Mesh::map(const MeshMark& begin, const MeshMark& end, const AffineMap& as_built) {
  for (std::size_t i = begin.surfaces; i < end.surfaces; ++i) {
    Plane& plane = surfaces_[i].plane;
    const Vector3d across = plane.normal.unitOrthogonal();
    const Vector3d foot = as_built(plane.offset * plane.normal);
    plane.normal =
        (as_built.linear * across).cross(as_built.linear * plane.normal.cross(across)).normalized();
    plane.offset = plane.normal.dot(foot);
    surfaces_[i].area_m2 = 0.0;
  }
  for (std::size_t i = begin.triangles; i < end.triangles; ++i) {
    for (const std::uint32_t corner : triangles_[i]) vertices_[corner] = as_built(vertices_[corner]);
    const Vector3d& a = vertices_[triangles_[i][0]];
    surfaces_[static_cast<std::size_t>(surface_of_triangle_[i])].area_m2 +=
        0.5 * (vertices_[triangles_[i][1]] - a).cross(vertices_[triangles_[i][2]] - a).norm();
  }
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

void Mesh::add_ball(const Ball& ball, Surface like) {
  constexpr int kTurns = 12;
  constexpr int kRings = 8;
  constexpr double kRound = 1.1;  // so that no triangle cuts the ball
  like.planar = false;
  like.ball = ball;
  const int id = add_surface(like);
  const auto at = [&](int turn, int ring) -> Vector3d {
    const double a = 2.0 * std::numbers::pi * turn / kTurns;
    const double b = std::numbers::pi * ring / kRings;
    return ball.centre + kRound * ball.radius_m *
                             Vector3d(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b));
  };
  for (int turn = 0; turn < kTurns; ++turn) {
    for (int ring = 0; ring < kRings; ++ring) {
      if (ring > 0) add_triangle(at(turn, ring), at(turn + 1, ring), at(turn + 1, ring + 1), id);
      if (ring + 1 < kRings) add_triangle(at(turn, ring), at(turn + 1, ring + 1), at(turn, ring + 1), id);
    }
  }
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

MergedPlanes merge_planes(const Mesh& mesh, double distance_m) {
  MergedPlanes merged;
  PlaneIndex index(distance_m);
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
      merged.planes[slot].bulge = surface.bulge;
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
