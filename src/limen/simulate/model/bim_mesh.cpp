// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/triangulate.h"

namespace limen {
namespace {

constexpr double kParallel = 0.99;
constexpr double kFrameWidth = 0.06;        // m, of a window that is drawn as a block
constexpr double kSmallestPane = 0.05;      // m^2
constexpr double kNarrowestPane = 0.12;     // m: frames are narrower
constexpr double kNarrowestBlock = 0.25;    // m, of a window drawn as a block
constexpr double kThickestPane = 0.05;      // m
constexpr double kThickestDoorPane = 0.03;  // m: leaves are thicker

double narrow_side(const Polygon& polygon) {
  const Box2 box = box_of({polygon});
  return (box.high - box.low).minCoeff();
}

bool is_solid_panel(const BimElement& element) {
  std::string name = element.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  return name.find("solid") != std::string::npos || name.find("opaque") != std::string::npos;
}

Element element_of(const BimElement& element, const Vector3d& normal) {
  switch (element.kind) {
    case BimKind::slab:
    case BimKind::covering:
      if (normal.z() > 0.7) return Element::floor;
      return normal.z() < -0.7 ? Element::ceiling : Element::wall;
    case BimKind::roof:
      return normal.z() < 0.0 ? Element::ceiling : Element::roof;
    case BimKind::stair:
      return Element::stairs;
    case BimKind::railing:
    case BimKind::other:
      return Element::ornament;
    case BimKind::window:
      return Element::frame;
    case BimKind::door:
      return Element::door;
    case BimKind::furniture:
      return Element::furniture;
    case BimKind::terrain:
      return Element::ground;
    default:
      return Element::wall;
  }
}

/// Looks for panes among the faces [begin, end) of one element.
class PaneFinder {
 public:
  PaneFinder(const BimModel& model, std::size_t begin, std::size_t end)
      : faces_(model.faces),
        element_(model.elements[static_cast<std::size_t>(model.faces[begin].element)]),
        begin_(begin),
        end_(end),
        across_(main_direction()) {}

  [[nodiscard]] std::vector<BimPart> run() const {
    std::vector<BimPart> parts;
    std::vector<char> panes(end_ - begin_, 0);
    for (std::size_t i = begin_; i < end_; ++i) panes[i - begin_] = is_pane(i) ? 1 : 0;
    const bool any = std::find(panes.begin(), panes.end(), 1) != panes.end();
    const bool block = !any && element_.kind == BimKind::window;
    for (std::size_t i = begin_; i < end_; ++i) {
      if (block && is_broad(i)) {
        split(i, parts);
        continue;
      }
      const Element kind =
          panes[i - begin_] != 0 ? Element::glass : element_of(element_, faces_[i].plane.normal);
      parts.push_back({i, faces_[i].outline, kind});
    }
    return parts;
  }

 private:
  /// The direction that most of the surface looks along.
  [[nodiscard]] Vector3d main_direction() const {
    Vector3d best = Vector3d::UnitX();
    double most = -1.0;
    for (std::size_t i = begin_; i < end_; ++i) {
      double sum = 0.0;
      for (std::size_t k = begin_; k < end_; ++k)
        if (std::abs(faces_[i].plane.normal.dot(faces_[k].plane.normal)) > kParallel)
          sum += faces_[k].area_m2;
      if (sum <= most) continue;
      most = sum;
      best = faces_[i].plane.normal;
    }
    return best;
  }

  [[nodiscard]] bool is_across(std::size_t i) const {
    return std::abs(faces_[i].plane.normal.dot(across_)) > kParallel;
  }

  [[nodiscard]] bool is_pane(std::size_t i) const {
    const BimFace& face = faces_[i];
    const bool door = element_.kind == BimKind::door;
    const bool plate = element_.kind == BimKind::plate;
    if (plate && (is_solid_panel(element_) || std::abs(face.plane.normal.z()) > 0.3)) return false;
    if (!is_across(i) || face.area_m2 < kSmallestPane || !face.outline.holes.empty()) return false;
    if (narrow_side(face.outline) < kNarrowestPane) return false;
    if (door && !has_frame()) return false;
    return has_mate(face, door ? kThickestDoorPane : kThickestPane);
  }

  /// Whether the other side of a thin sheet lies behind the face.
  [[nodiscard]] bool has_mate(const BimFace& face, double thickest) const {
    for (std::size_t k = begin_; k < end_; ++k) {
      const BimFace& other = faces_[k];
      if (other.plane.normal.dot(face.plane.normal) > -kParallel) continue;
      const double behind = -face.plane.signed_distance(other.frame.to_space(other.outline.outer[0]));
      if (behind < 1e-4 || behind > thickest) continue;
      const auto there = projected({other.outline}, other.frame, face.frame);
      if (intersection_area({face.outline}, there) > 0.8 * face.area_m2) return true;
    }
    return false;
  }

  [[nodiscard]] bool has_frame() const {
    for (std::size_t k = begin_; k < end_; ++k)
      if (is_across(k) && !faces_[k].outline.holes.empty()) return true;
    return false;
  }

  [[nodiscard]] bool is_broad(std::size_t i) const {
    return is_across(i) && faces_[i].outline.holes.empty() &&
           narrow_side(faces_[i].outline) >= kNarrowestBlock;
  }

  void split(std::size_t i, std::vector<BimPart>& parts) const {
    const std::vector<Polygon> panes = grown({faces_[i].outline}, -kFrameWidth);
    for (const Polygon& pane : panes) parts.push_back({i, pane, Element::glass});
    for (const Polygon& bar : difference({faces_[i].outline}, panes))
      parts.push_back({i, bar, Element::frame});
  }

  const std::vector<BimFace>& faces_;
  const BimElement& element_;
  std::size_t begin_;
  std::size_t end_;
  Vector3d across_;
};

bool may_have_panes(BimKind kind) {
  return kind == BimKind::window || kind == BimKind::plate || kind == BimKind::door;
}

/// Per element: a closed solid whose normals point outwards.
std::vector<char> closed_elements(const BimModel& model) {
  struct Sums {
    Vector3d normals = Vector3d::Zero();
    double area = 0.0;
    double volume = 0.0;
  };
  std::vector<Sums> sums(model.elements.size());
  for (const BimFace& face : model.faces) {
    Sums& sum = sums[static_cast<std::size_t>(face.element)];
    sum.normals += face.area_m2 * face.plane.normal;
    sum.area += face.area_m2;
    sum.volume += face.area_m2 * face.plane.offset / 3.0;
  }
  std::vector<char> closed;
  closed.reserve(sums.size());
  for (const Sums& sum : sums)
    closed.push_back(sum.normals.norm() < 1e-3 * sum.area && sum.volume > 0.0 ? 1 : 0);
  return closed;
}

/// Adds one part, seen from one side or from both.
void add_part(BimMesh& built, const BimFace& face, const BimPart& part, const Vector3d& shift,
              bool one_sided) {
  const std::vector<Triangle2> triangles = triangulate(part.outline);
  if (triangles.empty()) return;
  Surface surface = surface_of(part.element);
  surface.planar = true;
  surface.plane = {face.plane.normal, face.plane.offset + face.plane.normal.dot(shift)};
  const auto first = static_cast<int>(built.mesh.surfaces().size());
  if (!one_sided) surface.back = first + 1;
  built.mesh.add_surface(surface);
  built.element_of_surface.push_back(face.element);
  if (!one_sided) {
    Surface back = surface;
    back.plane = surface.plane.flipped();
    back.back = first;
    back.area_m2 = area(part.outline);
    built.mesh.add_surface(back);
    built.element_of_surface.push_back(face.element);
  }
  const auto place = [&](const Vector2d& p) { return Vector3d(face.frame.to_space(p) + shift); };
  for (const Triangle2& t : triangles) built.mesh.add_triangle(place(t[0]), place(t[1]), place(t[2]), first);
}

}  // namespace

std::vector<BimPart> parts_of(const BimModel& model) {
  std::vector<BimPart> parts;
  for (std::size_t begin = 0; begin < model.faces.size();) {
    std::size_t end = begin + 1;
    while (end < model.faces.size() && model.faces[end].element == model.faces[begin].element) ++end;
    const BimElement& element = model.elements[static_cast<std::size_t>(model.faces[begin].element)];
    if (may_have_panes(element.kind)) {
      for (BimPart& part : PaneFinder(model, begin, end).run()) parts.push_back(std::move(part));
    } else {
      for (std::size_t i = begin; i < end; ++i)
        parts.push_back({i, model.faces[i].outline, element_of(element, model.faces[i].plane.normal)});
    }
    begin = end;
  }
  return parts;
}

BuiltState as_planned(const BimModel& model) {
  return {std::vector<Vector3d>(model.elements.size(), Vector3d::Zero()),
          std::vector<char>(model.elements.size(), 1)};
}

BimMesh build_mesh(const BimModel& model, const std::vector<BimPart>& parts, const BuiltState& built) {
  // A mesh may be the skin of a room instead of a solid: only IFC says which.
  const bool solids = model.schema.rfind("IFC", 0) == 0;
  const std::vector<char> closed = closed_elements(model);
  BimMesh result;
  for (const BimPart& part : parts) {
    const BimFace& face = model.faces[part.face];
    const auto element = static_cast<std::size_t>(face.element);
    if (built.there[element] == 0) continue;
    const bool one_sided = solids && closed[element] != 0 && !may_have_panes(model.elements[element].kind);
    add_part(result, face, part, built.shift_m[element], one_sided);
  }
  return result;
}

}  // namespace limen
