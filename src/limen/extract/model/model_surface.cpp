// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/model_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "limen/base/parallel.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/cell_lists.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/model/plausible_size.h"

namespace limen {
namespace {

constexpr double kFrontM = 0.004;                // a solid this near before a face hides it
constexpr double kSamePlaneM = 0.002;            // faces of several elements within this are one plane
constexpr double kLeastPieceOfSurfaceM2 = 0.01;  // smaller pieces are left out

using Box = Eigen::AlignedBox3d;

Box box_of(const BimFace& face) {
  Box box;
  for (const Vector2d& p : face.outline.outer) box.extend(face.frame.to_space(p));
  return box;
}

/// The faces of one element.
struct Body {
  Box box;
  std::vector<const BimFace*> faces;
};

std::vector<Body> bodies_of(const BimModel& model) {
  std::vector<Body> bodies(model.elements.size());
  const BuiltElements is_built(model);
  for (const BimFace& face : model.faces) {
    const auto element = static_cast<std::size_t>(face.element);
    if (!is_built(model.elements[element])) continue;
    bodies[element].faces.push_back(&face);
    bodies[element].box.extend(box_of(face));
  }
  return bodies;
}

/// The bodies near a place, found by the cells of a grid that their boxes reach into.
class BodyGrid {
 public:
  explicit BodyGrid(const std::vector<Body>& bodies) : bodies_(bodies) {
    std::vector<std::vector<std::int64_t>> cells_of(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (bodies[k].faces.empty()) continue;
      if (cells_within(bodies[k].box) > kMostCells)
        large_.push_back(k);
      else
        each_cell(bodies[k].box, [&](std::int64_t cell) { cells_of[k].push_back(cell); });
    }
    cells_ = CellLists(std::move(cells_of));
  }

  /// Numbers, ascending, of the bodies whose boxes meet `box`.
  [[nodiscard]] std::vector<std::size_t> meeting(const Box& box) const {
    std::vector<std::size_t> found;
    const auto add = [&](std::size_t k) {
      if (bodies_[k].box.intersects(box)) found.push_back(k);
    };
    for (const std::size_t k : large_) add(k);
    if (cells_within(box) > kMostCells) {
      for (std::size_t k = 0; k < bodies_.size(); ++k) add(k);
    } else {
      each_cell(box, [&](std::int64_t cell) {
        for (const std::int32_t k : cells_.at(cell)) add(static_cast<std::size_t>(k));
      });
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  static constexpr double kCellM = 4.0;
  static constexpr double kMostCells = 512.0;

  static double cells_within(const Box& box) { return (box.sizes().array() / kCellM + 1.0).prod(); }

  template <typename Take>
  static void each_cell(const Box& box, const Take& take) {
    const Vector3d low = cell_of(box.min(), kCellM);
    const Vector3d high = cell_of(box.max(), kCellM);
    for (double x = low.x(); x <= high.x(); ++x) {
      for (double y = low.y(); y <= high.y(); ++y) {
        for (double z = low.z(); z <= high.z(); ++z) take(cell_key({x, y, z}));
      }
    }
  }

  const std::vector<Body>& bodies_;
  std::vector<std::size_t> large_;
  CellLists cells_;
};

/// Where other elements touch the face, in the face's coordinates.
std::vector<Polygon> bodies_before(const BimFace& face, const std::vector<Body>& bodies,
                                   const BodyGrid& grid) {
  Box box = box_of(face);
  box.min().array() -= 2.0 * kFrontM;
  box.max().array() += 2.0 * kFrontM;
  PlaneFrame front = face.frame;
  front.origin += kFrontM * face.plane.normal;
  std::vector<Polygon> covered;
  for (const std::size_t k : grid.meeting(box)) {
    if (static_cast<std::int32_t>(k) == face.element) continue;
    const std::vector<Polygon> section = cross_section(bodies[k].faces, front);
    covered.insert(covered.end(), section.begin(), section.end());
  }
  return covered;
}

/// What is left of one face.
struct Rest {
  const BimFace* face = nullptr;
  std::vector<Polygon> parts;
};

std::vector<Rest> uncovered(const BimModel& model) {
  const std::vector<Body> bodies = bodies_of(model);
  const BodyGrid grid(bodies);
  std::vector<Rest> rests(model.faces.size());
  parallel_for(model.faces.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const BimFace& face = model.faces[i];
      if (bodies[static_cast<std::size_t>(face.element)].faces.empty()) continue;
      const std::vector<Polygon> covered = bodies_before(face, bodies, grid);
      rests[i].face = &face;
      rests[i].parts =
          covered.empty() ? std::vector<Polygon>{face.outline} : difference({face.outline}, covered);
    }
  });
  std::erase_if(rests, [](const Rest& rest) { return rest.parts.empty(); });
  return rests;
}

/// Faces that lie in one plane and look the same way.
struct Sheet {
  Plane plane;
  PlaneFrame frame;
  std::vector<const Rest*> rests;
};

/// Groups faces by plane: found by the cells of normal and offset around.
class SheetMaker {
 public:
  void add(const Rest& rest) {
    const BimFace& face = *rest.face;
    const auto [x, y, z] = cell_of(face.plane.normal);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          if (join({x + dx, y + dy, z + dz}, rest)) return;
        }
      }
    }
    sheets_.push_back({face.plane, face.frame, {&rest}});
    by_cell_[{x, y, z}].emplace(face.plane.offset, sheets_.size() - 1);
  }

  [[nodiscard]] const std::vector<Sheet>& sheets() const { return sheets_; }

 private:
  using Cell = std::tuple<int, int, int>;
  static constexpr double kCell = 0.01;
  static constexpr double kOffsetReachM =
      0.05;  // of planes whose normals differ a little, far from the origin

  static Cell cell_of(const Vector3d& normal) {
    const auto part = [](double x) { return static_cast<int>(std::floor(x / kCell)); };
    return {part(normal.x()), part(normal.y()), part(normal.z())};
  }

  [[nodiscard]] bool lies_in(const BimFace& face, const Sheet& sheet) const {
    if (face.plane.normal.dot(sheet.plane.normal) < 0.9999) return false;
    return std::all_of(face.outline.outer.begin(), face.outline.outer.end(), [&](const Vector2d& p) {
      return std::abs(sheet.plane.signed_distance(face.frame.to_space(p))) <= kSamePlaneM;
    });
  }

  bool join(const Cell& cell, const Rest& rest) {
    const auto found = by_cell_.find(cell);
    if (found == by_cell_.end()) return false;
    const double offset = rest.face->plane.offset;
    for (auto it = found->second.lower_bound(offset - kOffsetReachM);
         it != found->second.end() && it->first <= offset + kOffsetReachM; ++it) {
      Sheet& sheet = sheets_[it->second];
      if (!lies_in(*rest.face, sheet)) continue;
      sheet.rests.push_back(&rest);
      return true;
    }
    return false;
  }

  std::vector<Sheet> sheets_;
  std::map<Cell, std::multimap<double, std::size_t>> by_cell_;
};

PlanarPolygon polygon_of(const Sheet& sheet, Polygon part) {
  PlanarPolygon polygon;
  polygon.plane = sheet.plane;
  polygon.frame = sheet.frame;
  polygon.area_m2 = area(part);
  const Box2 box = box_of(std::vector<Polygon>{part});
  polygon.centroid = sheet.frame.to_space(0.5 * (box.low + box.high));
  polygon.oriented = true;
  polygon.parts.push_back(std::move(part));
  return polygon;
}

/// Parts of a sheet that one face gave, in the sheet's frame.
struct MovedRest {
  std::vector<Polygon> parts;
  Box2 box;
};

/// The element that gives most of a polygon: that whose rest overlaps it most.
std::int32_t owner_of(const Polygon& part, const std::vector<MovedRest>& moved, const Sheet& sheet) {
  const Box2 box = box_of(std::vector<Polygon>{part});
  std::map<std::int32_t, double> shares;
  for (std::size_t k = 0; k < moved.size(); ++k) {
    if (!box.apart(moved[k].box))
      shares[sheet.rests[k]->face->element] += intersection_area({part}, moved[k].parts);
  }
  std::int32_t owner = sheet.rests.front()->face->element;
  for (const auto& [element, share] : shares) {
    if (share > shares[owner]) owner = element;
  }
  return owner;
}

ModelSurface surface_of_sheet(const Sheet& sheet) {
  ModelSurface surface;
  std::vector<MovedRest> moved;
  std::vector<Polygon> all;
  for (const Rest* rest : sheet.rests) {
    std::vector<Polygon> parts = projected(rest->parts, rest->face->frame, sheet.frame);
    all.insert(all.end(), parts.begin(), parts.end());
    const Box2 box = box_of(parts);
    moved.push_back({std::move(parts), box});
  }
  if (sheet.rests.size() > 1 || all.size() > 1) all = merged(all);
  for (Polygon& part : all) {
    if (area(part) < kLeastPieceOfSurfaceM2) continue;
    const bool alone = sheet.rests.size() == 1;
    surface.elements.push_back(alone ? sheet.rests.front()->face->element : owner_of(part, moved, sheet));
    surface.polygons.push_back(polygon_of(sheet, std::move(part)));
  }
  return surface;
}

}  // namespace

BuiltElements::BuiltElements(const BimModel& model)
    : no_kinds_(std::all_of(model.elements.begin(), model.elements.end(),
                            [](const BimElement& e) { return e.kind == BimKind::other; })) {}

bool BuiltElements::operator()(const BimElement& element) const {
  switch (element.kind) {
    case BimKind::wall:
    case BimKind::slab:
    case BimKind::roof:
    case BimKind::column:
    case BimKind::beam:
    case BimKind::stair:
    case BimKind::covering:
    case BimKind::terrain:
      return true;
    case BimKind::other:
      return no_kinds_;
    default:
      return false;
  }
}

ModelSurface visible_surface(const BimModel& model) {
  require_plausible_size(model);
  const std::vector<Rest> rests = uncovered(model);
  std::vector<const Rest*> order;
  for (const Rest& rest : rests) order.push_back(&rest);
  std::stable_sort(order.begin(), order.end(),
                   [](const Rest* a, const Rest* b) { return a->face->area_m2 > b->face->area_m2; });
  SheetMaker maker;
  for (const Rest* rest : order) maker.add(*rest);
  const std::vector<Sheet>& sheets = maker.sheets();
  std::vector<ModelSurface> of_sheets(sheets.size());
  parallel_for(sheets.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) of_sheets[i] = surface_of_sheet(sheets[i]);
  });
  ModelSurface all;
  for (ModelSurface& of_sheet : of_sheets) {
    std::move(of_sheet.polygons.begin(), of_sheet.polygons.end(), std::back_inserter(all.polygons));
    all.elements.insert(all.elements.end(), of_sheet.elements.begin(), of_sheet.elements.end());
  }
  std::vector<std::size_t> by_area(all.polygons.size());
  for (std::size_t i = 0; i < by_area.size(); ++i) by_area[i] = i;
  std::stable_sort(by_area.begin(), by_area.end(), [&](std::size_t a, std::size_t b) {
    return all.polygons[a].area_m2 > all.polygons[b].area_m2;
  });
  ModelSurface sorted;
  for (const std::size_t i : by_area) {
    sorted.polygons.push_back(std::move(all.polygons[i]));
    sorted.elements.push_back(all.elements[i]);
  }
  return sorted;
}

}  // namespace limen
