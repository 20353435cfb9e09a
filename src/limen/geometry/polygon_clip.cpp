// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/polygon_clip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <polyclipping/clipper.hpp>

#include "limen/base/error.h"
#include "limen/base/progress.h"

namespace limen {
namespace {

using ClipperLib::cInt;
using ClipperLib::Clipper;
using ClipperLib::Path;
using ClipperLib::Paths;
using ClipperLib::PolyNode;
using ClipperLib::PolyTree;

constexpr double kGrid_m = 1e-5;
constexpr double kMaxClipped_m = 1e9;
constexpr std::size_t kMostCrossings = 1000000;  // they take Clipper about a second

/// Conversion between metres about an origin and Clipper's integers.
class Grid {
 public:
  /// The origin is the middle of the polygons' box, so that the integers stay small.
  explicit Grid(const Box2& box) {
    if (!box.empty()) origin_ = 0.5 * (box.low + box.high);
  }

  [[nodiscard]] Paths paths(const std::vector<Polygon>& polygons) const {
    Paths result;
    for (const Polygon& polygon : polygons) {
      add(polygon.outer, true, result);
      for (const Ring& hole : polygon.holes) add(hole, false, result);
    }
    return result;
  }

  [[nodiscard]] Ring ring(const Path& path, bool counter_clockwise) const {
    Ring result;
    result.reserve(path.size());
    for (const auto& p : path) {
      result.push_back(origin_ + kGrid_m * Vector2d(static_cast<double>(p.X), static_cast<double>(p.Y)));
    }
    if ((ClipperLib::Area(path) > 0.0) != counter_clockwise) std::reverse(result.begin(), result.end());
    return result;
  }

 private:
  void add(const Ring& ring, bool counter_clockwise, Paths& paths) const {
    if (ring.size() < 3) return;
    Path path;
    path.reserve(ring.size());
    for (const Vector2d& p : ring)
      path.emplace_back(to_grid(p.x() - origin_.x()), to_grid(p.y() - origin_.y()));
    if (ClipperLib::Orientation(path) != counter_clockwise) ClipperLib::ReversePath(path);
    paths.push_back(std::move(path));
  }

  static cInt to_grid(double metres) { return static_cast<cInt>(std::llround(metres / kGrid_m)); }

  Vector2d origin_ = Vector2d::Zero();
};

void check(const Ring& ring) {
  for (const Vector2d& p : ring) {
    if (std::abs(p.x()) <= kMaxClipped_m && std::abs(p.y()) <= kMaxClipped_m) continue;
    throw Error("a polygon has a coordinate that is not finite or beyond 1e9 m", "polygon operation",
                "give coordinates about a local origin");
  }
}

Box2 checked_box(const std::vector<Polygon>& polygons) {
  for (const Polygon& polygon : polygons) {
    check(polygon.outer);
    for (const Ring& hole : polygon.holes) check(hole);
  }
  return box_of(polygons);
}

Box2 joined(Box2 a, const Box2& b) {
  a.low = a.low.cwiseMin(b.low);
  a.high = a.high.cwiseMax(b.high);
  return a;
}

/// An outer ring, its holes, and what lies in the holes again.
void collect(const PolyNode& node, const Grid& grid, std::vector<Polygon>& polygons) {
  Polygon polygon;
  polygon.outer = grid.ring(node.Contour, true);
  for (const PolyNode* hole : node.Childs) {
    polygon.holes.push_back(grid.ring(hole->Contour, false));
    for (const PolyNode* island : hole->Childs) collect(*island, grid, polygons);
  }
  polygons.push_back(std::move(polygon));
}

std::vector<Polygon> from_tree(const PolyTree& tree, const Grid& grid) {
  std::vector<Polygon> polygons;
  for (const PolyNode* node : tree.Childs) collect(*node, grid, polygons);
  std::stable_sort(polygons.begin(), polygons.end(),
                   [](const Polygon& a, const Polygon& b) { return area(a) > area(b); });
  return polygons;
}

/// A side of a ring, its lower end first.
struct ClippedSide {
  Vector2d low;
  Vector2d high;
};

std::size_t side_count(const std::vector<Polygon>& polygons) {
  std::size_t count = 0;
  for (const Polygon& polygon : polygons) {
    count += polygon.outer.size();
    for (const Ring& hole : polygon.holes) count += hole.size();
  }
  return count;
}

std::vector<ClippedSide> sides_upwards(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  std::vector<ClippedSide> sides;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d& from = ring[i];
      const Vector2d& to = ring[i + 1 == ring.size() ? 0 : i + 1];
      sides.push_back(from.y() < to.y() ? ClippedSide{from, to} : ClippedSide{to, from});
    }
  };
  for (const std::vector<Polygon>* polygons : {&a, &b}) {
    for (const Polygon& polygon : *polygons) {
      add(polygon.outer);
      for (const Ring& hole : polygon.holes) add(hole);
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const ClippedSide& p, const ClippedSide& q) { return p.low.y() < q.low.y(); });
  return sides;
}

/// Whether both ends of each lie on different sides of the other; what only touches does not cross.
bool cross(const ClippedSide& p, const ClippedSide& q) {
  const auto turn = [](const ClippedSide& side, const Vector2d& x) {
    const Vector2d along = side.high - side.low;
    return along.x() * (x.y() - side.low.y()) - along.y() * (x.x() - side.low.x());
  };
  return turn(p, q.low) * turn(p, q.high) < 0.0 && turn(q, p.low) * turn(q, p.high) < 0.0;
}

/// Throws Error where sides cross so often that Clipper, which cannot be stopped, would take minutes: its
/// work grows with their number.
void require_few_crossings(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  const std::size_t count = side_count(a) + side_count(b);
  if (count * count <= 2 * kMostCrossings) return;
  const std::vector<ClippedSide> sides = sides_upwards(a, b);
  std::size_t crossings = 0;
  std::vector<const ClippedSide*> open;
  for (const ClippedSide& side : sides) {
    CancelScope::check();
    std::erase_if(open, [&](const ClippedSide* other) { return other->high.y() < side.low.y(); });
    const auto [left, right] = std::minmax(side.low.x(), side.high.x());
    for (const ClippedSide* other : open) {
      if (std::max(other->low.x(), other->high.x()) < left ||
          std::min(other->low.x(), other->high.x()) > right)
        continue;
      crossings += cross(side, *other) ? 1 : 0;
    }
    if (crossings > kMostCrossings) {
      throw Error(fmt::format("outlines of {} sides cross one another more than {} times", sides.size(),
                              kMostCrossings),
                  "polygon operation", "correct the outlines");
    }
    open.push_back(&side);
  }
}

/// One run of Clipper over both arguments, into Paths or a PolyTree (which must not be copied, so it is not
/// returned).
template <typename Result>
void run(ClipperLib::ClipType type, const Grid& grid, const std::vector<Polygon>& a,
         const std::vector<Polygon>& b, Result& result) {
  CancelScope::check();
  require_few_crossings(a, b);
  Clipper clipper;
  const bool any_a = clipper.AddPaths(grid.paths(a), ClipperLib::ptSubject, true);
  const bool any_b = clipper.AddPaths(grid.paths(b), ClipperLib::ptClip, true);
  // Clipper calls it a failure when no ring has an area.
  if (!any_a && !any_b) return;
  if (!clipper.Execute(type, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero)) {
    throw Error("a polygon operation failed", "polygon operation", "please report this", Fault::internal);
  }
}

std::vector<Polygon> combine(ClipperLib::ClipType type, const std::vector<Polygon>& a,
                             const std::vector<Polygon>& b) {
  const Grid grid(joined(checked_box(a), checked_box(b)));
  PolyTree tree;
  run(type, grid, a, b, tree);
  return from_tree(tree, grid);
}

double area_of(ClipperLib::ClipType type, const Grid& grid, const std::vector<Polygon>& a,
               const std::vector<Polygon>& b) {
  Paths paths;
  run(type, grid, a, b, paths);
  double total = 0.0;
  for (const Path& path : paths) total += ClipperLib::Area(path);
  return std::max(0.0, total * kGrid_m * kGrid_m);
}

/// Marks the points of ring[first..last] (indices modulo the size) that the simplified chain keeps.
void keep_farthest(const Ring& ring, std::size_t first, std::size_t last, double tolerance_m,
                   std::vector<char>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> chains{{first, last}};
  while (!chains.empty()) {
    CancelScope::check();
    const auto [begin, end] = chains.back();
    chains.pop_back();
    const Vector2d& a = ring[begin % ring.size()];
    const Vector2d along = ring[end % ring.size()] - a;
    double farthest = tolerance_m;
    std::size_t at = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const Vector2d p = ring[i % ring.size()] - a;
      const double t =
          along.squaredNorm() > 0.0 ? std::clamp(p.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
      const double distance = (p - t * along).norm();
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
    }
    if (at == begin) continue;
    keep[at % ring.size()] = 1;
    chains.emplace_back(begin, at);
    chains.emplace_back(at, end);
  }
}

std::size_t farthest_from(const Ring& ring, const Vector2d& p) {
  const auto further = [&](const Vector2d& a, const Vector2d& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  };
  return static_cast<std::size_t>(std::max_element(ring.begin(), ring.end(), further) - ring.begin());
}

}  // namespace

std::vector<Polygon> intersection(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  if (checked_box(a).apart(checked_box(b))) return {};
  return combine(ClipperLib::ctIntersection, a, b);
}

std::vector<Polygon> difference(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  return combine(ClipperLib::ctDifference, a, b);
}

std::vector<Polygon> merged(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  return combine(ClipperLib::ctUnion, a, b);
}

double intersection_area(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  const Box2 box_a = checked_box(a);
  const Box2 box_b = checked_box(b);
  if (box_a.apart(box_b)) return 0.0;
  return area_of(ClipperLib::ctIntersection, Grid(joined(box_a, box_b)), a, b);
}

double union_area(const std::vector<Polygon>& polygons) {
  return area_of(ClipperLib::ctUnion, Grid(checked_box(polygons)), polygons, {});
}

std::vector<Polygon> filled(const std::vector<Polygon>& polygons) {
  std::vector<Polygon> outers;
  outers.reserve(polygons.size());
  for (const Polygon& polygon : polygons) outers.push_back({polygon.outer, {}});
  return merged(outers);
}

std::vector<Polygon> grown(const std::vector<Polygon>& polygons, double distance_m) {
  const Grid grid(checked_box(polygons));
  // The offset needs disjoint rings; so the union comes first.
  Paths paths;
  run(ClipperLib::ctUnion, grid, polygons, {}, paths);
  ClipperLib::ClipperOffset offset;
  offset.AddPaths(paths, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  PolyTree tree;
  offset.Execute(tree, distance_m / kGrid_m);
  return from_tree(tree, grid);
}

Ring simplify_ring(const Ring& ring, double tolerance_m) {
  if (!(tolerance_m >= 0.0)) throw_bad_option("tolerance_m", tolerance_m, "at least 0");
  if (ring.size() < 3) return {};
  // Two points far apart certainly stay; the ring is two chains between them.
  const std::size_t first = farthest_from(ring, ring.front());
  std::size_t last = farthest_from(ring, ring[first]);
  if (last == first) return {};
  std::vector<char> keep(ring.size(), 0);
  keep[first] = keep[last] = 1;
  if (last < first) last += ring.size();
  keep_farthest(ring, first, last, tolerance_m, keep);
  keep_farthest(ring, last, first + ring.size(), tolerance_m, keep);
  Ring simple;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (keep[i] != 0) simple.push_back(ring[i]);
  }
  return simple.size() < 3 ? Ring{} : simple;
}

std::vector<Polygon> simplified(const std::vector<Polygon>& polygons, double tolerance_m) {
  std::vector<Polygon> result;
  for (const Polygon& polygon : polygons) {
    Polygon simple;
    simple.outer = simplify_ring(polygon.outer, tolerance_m);
    if (simple.outer.empty()) continue;
    for (const Ring& hole : polygon.holes) {
      Ring ring = simplify_ring(hole, tolerance_m);
      if (!ring.empty()) simple.holes.push_back(std::move(ring));
    }
    result.push_back(std::move(simple));
  }
  return result;
}

std::vector<Polygon> projected(const std::vector<Polygon>& polygons, const PlaneFrame& from,
                               const PlaneFrame& to, const Rigid3& b_from_a) {
  // One affine map of the plane: its value at the origin and its two columns.
  const Vector2d origin = to.to_plane(b_from_a * from.origin);
  const Vector3d u = b_from_a.rotation * from.u;
  const Vector3d v = b_from_a.rotation * from.v;
  const Vector2d along_u(to.u.dot(u), to.v.dot(u));
  const Vector2d along_v(to.u.dot(v), to.v.dot(v));
  std::vector<Polygon> result = polygons;
  const auto map = [&](Ring& ring) {
    for (Vector2d& p : ring) p = (origin + p.x() * along_u + p.y() * along_v).eval();
  };
  for (Polygon& polygon : result) {
    map(polygon.outer);
    for (Ring& hole : polygon.holes) map(hole);
  }
  return result;
}

Box2 box_of(const Ring& ring) {
  Box2 box;
  for (const Vector2d& p : ring) box.add(p);
  return box;
}

Box2 box_of(const std::vector<Polygon>& polygons) {
  Box2 box;
  for (const Polygon& polygon : polygons) {
    for (const Vector2d& p : polygon.outer) box.add(p);
  }
  return box;
}

}  // namespace limen
