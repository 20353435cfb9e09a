// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/solid/solid_faces.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "limen/base/progress.h"
#include "limen/bim/solid/solid.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

using Areas = std::vector<Polygon>;

constexpr double kNear_m = 1e-3;

void append(const PolygonMesh& part, PolygonMesh& whole) {
  const auto base = static_cast<std::uint32_t>(whole.points.size());
  const auto before = static_cast<std::uint32_t>(whole.corners.size());
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  for (const std::uint32_t corner : part.corners) whole.corners.push_back(base + corner);
  for (const std::uint32_t end : part.ends) whole.ends.push_back(before + end);
}

/// A mesh that takes part in an operation.
struct Leaf {
  PolygonMesh mesh;  ///< welded and oriented
  std::vector<BimFace> faces;
  Box3 box;
  bool closed = false;
};

/// An operation over leaves by their numbers.
struct Node {
  SolidOperation operation = SolidOperation::mesh;
  std::size_t leaf = 0;
  std::vector<Node> children;
};

Box3 box_of(const BimFace& face) {
  Box3 box;
  for (const Vector2d& p : face.outline.outer) box.add(face.frame.to_space(p));
  return box;
}

/// Whether the mesh bounds a volume: edges match, or the area vectors cancel.
bool bounds_something(const PolygonMesh& mesh) {
  if (is_closed(mesh)) return true;
  Vector3d sum = Vector3d::Zero();
  double area = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    sum += area_vector(mesh, i);
    area += area_vector(mesh, i).norm();
  }
  return sum.norm() < 1e-4 * area && signed_volume(mesh) > 0.0;
}

class Operation {
 public:
  Operation(const Solid& shape, const std::vector<const Solid*>& cutters) : root_(node_of(shape)) {
    if (cutters.empty()) return;
    Node whole{SolidOperation::subtract, 0, {}};
    whole.children.push_back(std::move(root_));
    for (const Solid* cutter : cutters) whole.children.push_back(node_of(*cutter));
    root_ = std::move(whole);
  }

  [[nodiscard]] std::vector<BimFace> faces() const {
    std::vector<BimFace> result;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      for (const BimFace& face : leaves_[i].faces) {
        CancelScope::check();
        add_parts(i, face, result);
      }
    }
    return result;
  }

  [[nodiscard]] std::size_t open_leaves() const {
    return static_cast<std::size_t>(
        std::count_if(leaves_.begin(), leaves_.end(), [](const Leaf& leaf) { return !leaf.closed; }));
  }

 private:
  Node node_of(const Solid& solid) {
    Node node{solid.operation, leaves_.size(), {}};
    if (solid.operation != SolidOperation::mesh) {
      for (const Solid& child : solid.children) node.children.push_back(node_of(child));
      return node;
    }
    Leaf leaf;
    leaf.mesh = oriented(welded(solid.mesh));
    leaf.faces = flat_faces(solid.mesh, -1);
    leaf.box = limen::box_of(leaf.mesh);
    leaf.closed = bounds_something(leaf.mesh);
    leaves_.push_back(std::move(leaf));
    return node;
  }

  /// A face on which the operation is being judged.
  struct Site {
    const BimFace& face;
    Box3 box;
    std::size_t leaf;
  };

  /// Where on the face the node is solid, on one side of it.
  [[nodiscard]] Areas where_solid(const Node& node, const Site& site, PlaneSide side) const {
    if (node.operation == SolidOperation::mesh) return where_solid_leaf(node.leaf, site, side);
    if (node.children.empty()) return {};
    Areas areas = where_solid(node.children.front(), site, side);
    for (std::size_t k = 1; k < node.children.size(); ++k) {
      if (areas.empty() && node.operation != SolidOperation::unite) return {};
      const Areas other = where_solid(node.children[k], site, side);
      if (node.operation == SolidOperation::intersect) {
        areas = intersection(areas, other);
      } else if (!other.empty()) {
        areas = node.operation == SolidOperation::subtract ? difference(areas, other) : merged(areas, other);
      }
    }
    return areas;
  }

  [[nodiscard]] Areas where_solid_leaf(std::size_t index, const Site& site, PlaneSide side) const {
    if (index == site.leaf) return side == PlaneSide::behind ? Areas{site.face.outline} : Areas{};
    const Leaf& leaf = leaves_[index];
    if (!leaf.closed || !leaf.box.touches(site.box, kNear_m)) return {};
    return section(leaf.mesh, site.face.frame, side);
  }

  void add_parts(std::size_t leaf, const BimFace& face, std::vector<BimFace>& result) const {
    const Site site{face, box_of(face), leaf};
    const Areas behind = where_solid(root_, site, PlaneSide::behind);
    const Areas before = where_solid(root_, site, PlaneSide::before);
    const Areas whole{face.outline};
    if (!behind.empty()) {
      const Areas stays = intersection(whole, before.empty() ? behind : difference(behind, before));
      add_faces(face.plane, face.frame, stays, result);
    }
    if (before.empty()) return;
    const Areas turned = intersection(whole, behind.empty() ? before : difference(before, behind));
    if (turned.empty()) return;
    const Plane plane = face.plane.flipped();
    const PlaneFrame frame = make_frame(plane, face.frame.origin);
    add_faces(plane, frame, merged(projected(turned, face.frame, frame)), result);
  }

  void add_faces(const Plane& plane, const PlaneFrame& frame, const Areas& areas,
                 std::vector<BimFace>& result) const {
    for (BimFace& face : faces_in_plane(plane, frame, areas)) result.push_back(std::move(face));
  }

  std::vector<Leaf> leaves_;
  Node root_;
};

bool in_plane(const BimFace& face, const BimFace& of) {
  if (face.plane.normal.dot(of.plane.normal) < std::cos(kFlatFaceRad)) return false;
  return std::all_of(face.outline.outer.begin(), face.outline.outer.end(), [&](const Vector2d& p) {
    return std::abs(of.plane.signed_distance(face.frame.to_space(p))) <= kFlatFaceM;
  });
}

/// Meshes need no operation where nothing cuts them.
bool is_plain(const Solid& shape) {
  return shape.operation == SolidOperation::mesh;
}

}  // namespace

PolygonMesh all_meshes(const Solid& solid) {
  PolygonMesh mesh = solid.mesh;
  for (const Solid& child : solid.children) append(all_meshes(child), mesh);
  return mesh;
}

std::vector<BimFace> joined_faces(std::vector<BimFace> faces) {
  constexpr std::size_t kMost = 3000;  // each is compared with each
  if (faces.size() > kMost) return faces;
  std::stable_sort(faces.begin(), faces.end(),
                   [](const BimFace& a, const BimFace& b) { return a.area_m2 > b.area_m2; });
  std::vector<char> taken(faces.size(), 0);
  std::vector<BimFace> result;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (taken[i] != 0) continue;
    Areas areas{faces[i].outline};
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      if (taken[j] != 0 || !in_plane(faces[j], faces[i])) continue;
      taken[j] = 1;
      areas.push_back(projected({faces[j].outline}, faces[j].frame, faces[i].frame).front());
    }
    if (areas.size() == 1) {
      result.push_back(std::move(faces[i]));
      continue;
    }
    for (BimFace& face : faces_in_plane(faces[i].plane, faces[i].frame, merged(areas))) {
      face.element = faces[i].element;
      result.push_back(std::move(face));
    }
  }
  return result;
}

SolidFaces solid_faces(const std::vector<Solid>& shapes, const std::vector<const Solid*>& cutters) {
  SolidFaces result;
  PolygonMesh plain;
  std::size_t groups = 0;
  for (const Solid& shape : shapes) {
    const Box3 box = box_of(shape);
    std::vector<const Solid*> near;
    std::copy_if(cutters.begin(), cutters.end(), std::back_inserter(near),
                 [&](const Solid* cutter) { return box_of(*cutter).touches(box, kNear_m); });
    if (is_plain(shape) && near.empty()) {
      append(shape.mesh, plain);
      continue;
    }
    const Operation operation(shape, near);
    std::vector<BimFace> faces = operation.faces();
    std::move(faces.begin(), faces.end(), std::back_inserter(result.faces));
    result.open_cutters += operation.open_leaves();
    ++groups;
  }
  std::vector<BimFace> faces = flat_faces(plain, -1);
  std::move(faces.begin(), faces.end(), std::back_inserter(result.faces));
  if (groups > 0) result.faces = joined_faces(std::move(result.faces));
  return result;
}

}  // namespace limen
