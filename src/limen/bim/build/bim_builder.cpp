// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/build/bim_builder.h"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/bim/solid/solid.h"
#include "limen/bim/solid/solid_faces.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/io/table/scan_builder.h"

namespace limen {
namespace {

/// Faces nearer to the horizontal than this hold no windows or doors (cosine to the vertical).
constexpr double kSteepest = 0.9;
constexpr double kOpposite = 0.996;  // 5 degrees
constexpr double kLeastArea_m2 = 1e-3;

/// The part of a host's face that an opening takes away.
struct Passage {
  const BimFace* face = nullptr;
  std::vector<Polygon> areas;
  double area_m2 = 0.0;
};

/// Closed meshes of an opening, welded and oriented.
std::vector<PolygonMesh> solids_of(const RawOpening& opening) {
  std::vector<PolygonMesh> meshes;
  for (const Solid& shape : opening.shapes) meshes.push_back(oriented(welded(all_meshes(shape))));
  return meshes;
}

/// How much of a face counts as wall.
enum class Extent {
  outline,   ///< as far as it exists
  rectangle  ///< all within its bounding rectangle: where the file has cut the openings out already
};

Polygon rectangle_of(const Polygon& outline) {
  const Box2 box = box_of(std::vector<Polygon>{outline});
  return {{box.low, {box.high.x(), box.low.y()}, box.high, {box.low.x(), box.high.y()}}, {}};
}

Passage passage_in(const BimFace& face, const std::vector<PolygonMesh>& meshes, Extent extent) {
  Passage passage{&face, {}, 0.0};
  const std::vector<Polygon> wall{extent == Extent::outline ? face.outline : rectangle_of(face.outline)};
  for (const PolygonMesh& mesh : meshes) {
    const std::vector<Polygon> part = intersection(wall, section(mesh, face.frame, PlaneSide::behind));
    passage.areas = passage.areas.empty() ? part : merged(passage.areas, part);
  }
  passage.area_m2 = area(passage.areas);
  return passage;
}

std::vector<Passage> passages_of(const std::vector<BimFace>& faces, const std::vector<PolygonMesh>& meshes,
                                 Extent extent) {
  std::vector<Passage> passages;
  for (const BimFace& face : faces) {
    if (std::abs(face.plane.normal.z()) > kSteepest) continue;
    Passage passage = passage_in(face, meshes, extent);
    if (passage.area_m2 > kLeastArea_m2) passages.push_back(std::move(passage));
  }
  return passages;
}

/// Depth of the host's farthest face behind that looks the other way and that the opening passes.
std::optional<double> thickness_behind(const Passage& front, const std::vector<Passage>& passages) {
  std::optional<double> thickness;
  for (const Passage& other : passages) {
    if (other.face->plane.normal.dot(front.face->plane.normal) > -kOpposite) continue;
    const Vector2d middle = other.areas.front().outer.front();
    const double depth = -front.face->plane.signed_distance(other.face->frame.to_space(middle));
    if (depth > 0.0 && (!thickness || depth > *thickness)) thickness = depth;
  }
  return thickness;
}

std::optional<BimOpening> box_through(const std::vector<BimFace>& host, const RawOpening& opening,
                                      Extent extent) {
  const std::vector<PolygonMesh> meshes = solids_of(opening);
  const std::vector<Passage> passages = passages_of(host, meshes, extent);
  // The larger side speaks; where both are equal, the one that comes first.
  const Passage* front = nullptr;
  for (const Passage& passage : passages) {
    if (front == nullptr || passage.area_m2 > front->area_m2 + kLeastArea_m2) front = &passage;
  }
  if (front == nullptr) return {};
  const std::optional<double> thickness = thickness_behind(*front, passages);
  if (!thickness) return {};
  const Box2 box = box_of(front->areas);
  const PlaneFrame& frame = front->face->frame;
  BimOpening result;
  result.corners[0] = frame.to_space(box.low);
  result.corners[1] = frame.to_space({box.high.x(), box.low.y()});
  result.corners[2] = frame.to_space(box.high);
  result.corners[3] = frame.to_space({box.low.x(), box.high.y()});
  result.normal = front->face->plane.normal;
  result.thickness_m = *thickness;
  result.filling = opening.filling;
  result.guid = opening.guid;
  return result;
}

/// In the wall itself, else in the part of it that has the largest hole.
std::optional<BimOpening> box_of_opening(const RawModel& raw, const RawOpening& opening,
                                         const std::vector<std::vector<BimFace>>& uncut) {
  for (const std::int32_t host : opening.hosts) {
    std::optional<BimOpening> box;
    try {
      box = box_through(uncut[static_cast<std::size_t>(host)], opening, Extent::outline);
      if (!box) box = box_through(uncut[static_cast<std::size_t>(host)], opening, Extent::rectangle);
    } catch (const Error& error) {
      if (error.fault() != Fault::input) throw;
      continue;  // the element's warning is about its geometry
    }
    if (!box) continue;
    box->host = opening.hosts.front();
    if (raw.elements[static_cast<std::size_t>(host)].about.kind == BimKind::slab) return {};
    return box;
  }
  return {};
}

/// The openings of a model as boxes, about the same origin as the shapes are. An opening is left out where it
/// passes through no standing face (stair holes in slabs), or ends inside its host (niches).
std::vector<BimOpening> opening_boxes(const RawModel& raw) {
  std::vector<char> wanted(raw.elements.size(), 0);
  for (const RawOpening& opening : raw.openings) {
    for (const std::int32_t host : opening.hosts) wanted[static_cast<std::size_t>(host)] = 1;
  }
  std::vector<std::vector<BimFace>> uncut(raw.elements.size());
  parallel_for(uncut.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (wanted[i] == 0) continue;
      try {
        uncut[i] = solid_faces(raw.elements[i].shapes).faces;
      } catch (const Error& error) {
        if (error.fault() != Fault::input) throw;
        uncut[i].clear();  // counted where its faces are made
      }
    }
  });
  std::vector<std::optional<BimOpening>> boxes(raw.openings.size());
  parallel_for(boxes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of_opening(raw, raw.openings[i], uncut);
  });
  std::vector<BimOpening> openings;
  for (const std::optional<BimOpening>& box : boxes) {
    if (box) openings.push_back(*box);
  }
  return openings;
}

constexpr double kLargestBuilding_m = 1000.0;
constexpr double kSmallestBuilding_m = 1.0;

void question_size(const Box3& box, BimModel& model) {
  const double side = (box.high - box.low).maxCoeff();
  if (side >= kSmallestBuilding_m && side <= kLargestBuilding_m) return;
  model.warnings.push_back(fmt::format(
      "the model measures {:.4g} m from end to end, {} for a building: the length unit in the file "
      "(1 unit = {:.6g} m) is questionable",
      side, side > kLargestBuilding_m ? "much" : "little", model.metres_per_unit));
}

/// One box of all shapes of all elements.
Box3 box_of(const std::vector<RawElement>& elements) {
  Box3 box;
  for (const RawElement& element : elements) {
    for (const Solid& shape : element.shapes) {
      const Box3 part = limen::box_of(shape);
      if (part.empty()) continue;
      box.add(part.low);
      box.add(part.high);
    }
  }
  return box;
}

void move_all(RawModel& raw, const Vector3d& shift) {
  const auto move_shapes = [&](std::vector<Solid>& shapes) {
    for (Solid& shape : shapes) move(shape, 1.0, shift);
  };
  for (RawElement& element : raw.elements) move_shapes(element.shapes);
  for (RawOpening& opening : raw.openings) move_shapes(opening.shapes);
  for (RawSpace& space : raw.spaces) move_shapes(space.shapes);
}

/// The openings' solids, by the element they are cut out of.
std::vector<std::vector<const Solid*>> cutters_of(const RawModel& raw) {
  std::vector<std::vector<const Solid*>> cutters(raw.elements.size());
  for (const RawOpening& opening : raw.openings) {
    for (const std::int32_t host : opening.hosts) {
      for (const Solid& shape : opening.shapes) cutters[static_cast<std::size_t>(host)].push_back(&shape);
    }
  }
  return cutters;
}

/// What became of one element or room.
struct BuiltElement {
  std::vector<BimFace> faces;
  std::string warning;
};

BuiltElement outcome_of(const std::vector<Solid>& shapes, const std::vector<const Solid*>& cutters) {
  BuiltElement outcome;
  try {
    SolidFaces made = solid_faces(shapes, cutters);
    outcome.faces = std::move(made.faces);
    if (made.open_cutters > 0)
      outcome.warning =
          fmt::format("{} of its solids are not closed: sides of openings may be missing", made.open_cutters);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    outcome.warning = fmt::format("its surface could not be made ({})", error.problem());
  }
  return outcome;
}

/// Makes all faces, elements on all threads, and takes them in the elements' order.
template <typename Raw, typename Cutters, typename Take>
void make_faces(const std::vector<Raw>& raw, const Cutters& cutters, Monitor& monitor, const Take& take) {
  std::vector<BuiltElement> outcomes(raw.size());
  parallel_for(raw.size(), 1, [&](std::size_t begin, std::size_t end) {
    monitor.throw_if_cancelled();
    for (std::size_t i = begin; i < end; ++i) outcomes[i] = outcome_of(raw[i].shapes, cutters(i));
  });
  for (std::size_t i = 0; i < raw.size(); ++i) take(i, outcomes[i]);
}

std::string name_of(const BimElement& element) {
  return fmt::format("#{} {}{}", element.file_id, element.type,
                     element.name.empty() ? "" : " " + element.name);
}

}  // namespace

BimModel built(RawModel raw, Monitor& monitor) {
  BimModel model = std::move(raw.head);
  const Box3 box = box_of(raw.elements);
  const auto why = [&] { return model.warnings.empty() ? "" : ": " + model.warnings.front(); };
  if (box.empty()) {
    throw Error("the model has no surface" + why(), model.name,
                "export it with its geometry (IFC with shape representations, OBJ or PLY with faces)");
  }
  question_size(box, model);
  model.local_origin = round_origin_near(0.5 * (box.low + box.high));
  move_all(raw, model.local_origin);

  for (const RawElement& element : raw.elements) model.elements.push_back(element.about);
  const auto cutters = cutters_of(raw);
  make_faces(
      raw.elements, [&](std::size_t i) { return cutters[i]; }, monitor,
      [&](std::size_t i, BuiltElement& outcome) {
        for (BimFace& face : outcome.faces) {
          face.element = static_cast<std::int32_t>(i);
          model.faces.push_back(std::move(face));
        }
        if (!outcome.warning.empty())
          model.warnings.push_back(name_of(model.elements[i]) + ": " + outcome.warning);
      });
  make_faces(
      raw.spaces, [](std::size_t) { return std::vector<const Solid*>{}; }, monitor,
      [&](std::size_t i, BuiltElement& outcome) {
        model.spaces.push_back(std::move(raw.spaces[i].about));
        model.spaces.back().faces = std::move(outcome.faces);
      });
  if (model.faces.empty())
    throw Error("the model's faces have no area" + why(), model.name, "check how it was exported");
  model.openings = opening_boxes(raw);
  model.check();
  return model;
}

}  // namespace limen
