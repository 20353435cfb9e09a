// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_recipe.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kTouch = 1e-6;  // m: what lies in one plane

Vector3d direction_of(const BimPrism& prism) {
  return prism.base.u.cross(prism.base.v);
}

BimFace face_of(const PlaneFrame& frame, const Polygon& outline, std::int32_t element) {
  BimFace face;
  face.frame = frame;
  face.plane.normal = frame.u.cross(frame.v);
  face.plane.offset = face.plane.normal.dot(frame.origin);
  face.outline = outline;
  face.area_m2 = area(outline);
  face.element = element;
  return face;
}

Polygon rectangle(double width, double height) {
  return {{{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}}, {}};
}

/// The side over the edge from a to b of a profile: normal to the right of the edge.
BimFace side_of(const BimPrism& prism, const Vector2d& a, const Vector2d& b, std::int32_t element) {
  const Vector3d from = prism.base.to_space(a);
  const Vector3d to = prism.base.to_space(b);
  const PlaneFrame frame{from, (to - from).normalized(), direction_of(prism)};
  return face_of(frame, rectangle((to - from).norm(), prism.depth_m), element);
}

/// The base seen from its back.
Polygon mirrored(const Polygon& polygon) {
  const auto turned = [](const Ring& ring) {
    Ring back;
    for (auto p = ring.rbegin(); p != ring.rend(); ++p) back.emplace_back(-p->x(), p->y());
    return back;
  };
  Polygon back{turned(polygon.outer), {}};
  for (const Ring& hole : polygon.holes) back.holes.push_back(turned(hole));
  return back;
}

std::vector<BimFace> faces_of(const BimPrism& prism, std::int32_t element) {
  std::vector<BimFace> faces;
  const PlaneFrame& base = prism.base;
  faces.push_back(face_of({base.origin, -base.u, base.v}, mirrored(prism.profile), element));
  faces.push_back(
      face_of({base.origin + prism.depth_m * direction_of(prism), base.u, base.v}, prism.profile, element));
  const auto add_sides = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      faces.push_back(side_of(prism, ring[i], ring[(i + 1) % ring.size()], element));
  };
  add_sides(prism.profile.outer);
  for (const Ring& hole : prism.profile.holes) add_sides(hole);
  return faces;
}

bool coplanar(const BimFace& a, const BimFace& b) {
  return std::abs(std::abs(a.plane.normal.dot(b.plane.normal)) - 1.0) < 1e-9 &&
         std::abs(a.plane.signed_distance(b.frame.origin)) < kTouch;
}

/// What an opening takes out of a face of its host.
std::vector<Polygon> cut_of(const BimFace& face, const BimPrism& opening) {
  const Vector3d along = direction_of(opening);
  if (std::abs(std::abs(face.plane.normal.dot(along)) - 1.0) < 1e-9) {
    const double depth = along.dot(face.frame.origin - opening.base.origin);
    if (depth < -kTouch || depth > opening.depth_m + kTouch) return {};
    return projected({opening.profile}, opening.base, face.frame);
  }
  std::vector<Polygon> cuts;
  for (const BimFace& side : faces_of(opening, -1))
    if (coplanar(side, face))
      for (Polygon& cut : projected({side.outline}, side.frame, face.frame)) cuts.push_back(std::move(cut));
  return cuts;
}

/// The sides of an opening as seen from within it; none where it breaks through the host's own faces.
std::vector<BimFace> reveals_of(const BimPrism& opening, const std::vector<BimFace>& host,
                                std::int32_t element) {
  std::vector<BimFace> reveals;
  const Ring& ring = opening.profile.outer;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const BimFace reveal = side_of(opening, ring[(i + 1) % ring.size()], ring[i], element);
    const bool open =
        std::any_of(host.begin(), host.end(), [&](const BimFace& face) { return coplanar(face, reveal); });
    if (!open) reveals.push_back(reveal);
  }
  return reveals;
}

/// The faces of one element, its openings cut out.
std::vector<BimFace> element_faces(const BimRecipe& recipe, std::size_t index) {
  const auto id = static_cast<std::int32_t>(index);
  const RecipeElement& element = recipe.elements[index];
  std::vector<BimFace> faces;
  for (std::size_t k = 0; k < element.solids.size(); ++k) {
    const std::vector<BimFace> whole = faces_of(element.solids[k], id);
    for (const BimFace& face : whole) {
      std::vector<Polygon> cuts;
      for (const RecipeOpening& opening : recipe.openings)
        if (k == 0 && opening.host == id)
          for (Polygon& cut : cut_of(face, opening.solid)) cuts.push_back(std::move(cut));
      if (cuts.empty()) {
        faces.push_back(face);
        continue;
      }
      for (const Polygon& part : difference({face.outline}, cuts))
        faces.push_back(face_of(face.frame, part, id));
    }
    for (const RecipeOpening& opening : recipe.openings)
      if (k == 0 && opening.host == id)
        for (BimFace& reveal : reveals_of(opening.solid, whole, id)) faces.push_back(std::move(reveal));
  }
  return faces;
}

/// The box of an opening in a wall; its base lies on the face with the outward normal.
BimOpening box_of(const BimRecipe& recipe, std::size_t index) {
  const RecipeOpening& opening = recipe.openings[index];
  const Box2 box = box_of(std::vector<Polygon>{opening.solid.profile});
  BimOpening stated;
  // The base looks into the wall: from outside its u runs to the left.
  stated.corners[0] = opening.solid.base.to_space({box.high.x(), box.low.y()});
  stated.corners[1] = opening.solid.base.to_space({box.low.x(), box.low.y()});
  stated.corners[2] = opening.solid.base.to_space({box.low.x(), box.high.y()});
  stated.corners[3] = opening.solid.base.to_space({box.high.x(), box.high.y()});
  stated.normal = -direction_of(opening.solid);
  stated.thickness_m = opening.solid.depth_m;
  stated.host = opening.host;
  stated.filling = opening.filling;
  stated.guid = recipe_guid(recipe, RecipePart::opening, index);
  return stated;
}

}  // namespace

std::string recipe_guid(const BimRecipe& recipe, RecipePart part, std::size_t index) {
  static constexpr char kDigits[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
  std::uint64_t name = 0;
  for (const char c : recipe.name) name = mix64(name + static_cast<unsigned char>(c));
  RandomStream random(mix64(name + static_cast<std::uint64_t>(part)), index);
  std::string guid(22, '0');
  guid[0] = kDigits[random.below(4)];
  for (std::size_t i = 1; i < guid.size(); ++i) guid[i] = kDigits[random.below(64)];
  return guid;
}

BimModel model_of(const BimRecipe& recipe) {
  BimModel model;
  model.name = recipe.name;
  model.schema = "IFC4";
  for (std::size_t i = 0; i < recipe.elements.size(); ++i) {
    const RecipeElement& element = recipe.elements[i];
    model.elements.push_back({element.kind, element.type, recipe_guid(recipe, RecipePart::element, i),
                              element.name, recipe.storeys[static_cast<std::size_t>(element.storey)].name,
                              0});
    for (BimFace& face : element_faces(recipe, i)) model.faces.push_back(std::move(face));
  }
  for (std::size_t i = 0; i < recipe.openings.size(); ++i) {
    const auto host = static_cast<std::size_t>(recipe.openings[i].host);
    if (recipe.elements[host].kind == BimKind::wall) model.openings.push_back(box_of(recipe, i));
  }
  for (std::size_t i = 0; i < recipe.spaces.size(); ++i) {
    const RecipeSpace& space = recipe.spaces[i];
    model.spaces.push_back({recipe_guid(recipe, RecipePart::space, i), space.number + " " + space.name,
                            recipe.storeys[static_cast<std::size_t>(space.storey)].name,
                            faces_of(space.solid, -1)});
  }
  model.check();
  return model;
}

}  // namespace limen
