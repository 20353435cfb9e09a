// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/alpha_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "limen/base/disjoint_sets.h"
#include "limen/base/error.h"
#include "limen/geometry/delaunay.h"
#include "limen/geometry/thinning.h"

namespace limen {
namespace {

constexpr double kShapeGrid_m = 1e-5;

/// The points on the integer grid, distinct, in lexicographic order, and the way back to metres.
struct GridPoints {
  std::vector<GridPoint> points;
  Vector2d origin = Vector2d::Zero();
  double unit_m = kShapeGrid_m;

  [[nodiscard]] Vector2d metres(std::size_t i) const {
    return origin + unit_m * Vector2d(points[i].x, points[i].y);
  }
};

GridPoints on_grid(const std::vector<Vector2d>& points, double alpha_m) {
  GridPoints grid;
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = -low;
  for (const Vector2d& p : points) {
    if (!usable(p)) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!(low.x() <= high.x())) return grid;
  grid.origin = 0.5 * low + 0.5 * high;
  // Half the extent, and alpha, within what the triangulation takes.
  constexpr double kMost = kMostGrid - 1;
  grid.unit_m = std::max({kShapeGrid_m, 0.5 * (high - low).maxCoeff() / kMost, alpha_m / kMost});
  grid.points.reserve(points.size());
  for (const Vector2d& p : points) {
    if (!usable(p)) continue;
    const Vector2d scaled = (p - grid.origin) / grid.unit_m;
    grid.points.push_back({static_cast<std::int32_t>(std::lround(scaled.x())),
                           static_cast<std::int32_t>(std::lround(scaled.y()))});
  }
  std::sort(grid.points.begin(), grid.points.end());
  grid.points.erase(std::unique(grid.points.begin(), grid.points.end()), grid.points.end());
  return grid;
}

/// A directed edge of the shape's outline, its inside on the left; `part` is the root of that inside.
struct OutlineEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  std::size_t part = 0;
};

/// The edges with a face of the shape on one side only, that side on their left.
std::vector<OutlineEdge> outline_edges(const std::vector<DelaunayFace>& faces) {
  DisjointSets sets(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const std::int32_t across : faces[f].across) {
      if (across != DelaunayFace::kNone) sets.join(f, static_cast<std::size_t>(across));
    }
  }
  std::vector<OutlineEdge> outline;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (faces[f].across[k] != DelaunayFace::kNone) continue;
      outline.push_back({static_cast<std::size_t>(faces[f].corners[(k + 1) % 3]),
                         static_cast<std::size_t>(faces[f].corners[(k + 2) % 3]), sets.find(f)});
    }
  }
  // Sites are in lexicographic order: the outline does not depend on the order of the faces.
  std::sort(outline.begin(), outline.end(), [](const OutlineEdge& a, const OutlineEdge& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  return outline;
}

/// Which outgoing edge bounds the same wedge of the inside as the edge u -> v: the first one met when turning
/// clockwise from the way back to u. So parts that touch in a point come apart there.
class RingTracer {
 public:
  RingTracer(const GridPoints& grid, std::vector<OutlineEdge> outline)
      : grid_(grid), outline_(std::move(outline)), used_(outline_.size(), 0) {}

  /// Closed walks over site indices, each with the root of its part.
  struct Walk {
    std::vector<std::size_t> sites;
    std::size_t part = 0;
  };

  std::vector<Walk> walks() {
    std::vector<Walk> all;
    for (std::size_t start = 0; start < outline_.size(); ++start) {
      if (used_[start] != 0) continue;
      Walk walk;
      walk.part = outline_[start].part;
      for (std::size_t edge = start; used_[edge] == 0; edge = successor(edge)) {
        used_[edge] = 1;
        walk.sites.push_back(outline_[edge].from);
      }
      all.push_back(std::move(walk));
    }
    return all;
  }

 private:
  [[nodiscard]] std::size_t successor(std::size_t edge) const {
    const std::size_t from = outline_[edge].from;
    const std::size_t at = outline_[edge].to;
    const auto candidate =
        std::lower_bound(outline_.begin(), outline_.end(), at,
                         [](const OutlineEdge& e, std::size_t site) { return e.from < site; });
    std::size_t best = edge;
    double best_turn = std::numeric_limits<double>::infinity();
    for (auto i = static_cast<std::size_t>(candidate - outline_.begin());
         i < outline_.size() && outline_[i].from == at; ++i) {
      const double turn = clockwise_turn(at, from, outline_[i].to);
      if (turn < best_turn) {
        best_turn = turn;
        best = i;
      }
    }
    return best;
  }

  /// Angle from at->a clockwise to at->b, in (0, 2 pi].
  [[nodiscard]] double clockwise_turn(std::size_t at, std::size_t a, std::size_t b) const {
    const auto towards = [&](std::size_t site) {
      return Vector2d(static_cast<double>(grid_.points[site].x) - grid_.points[at].x,
                      static_cast<double>(grid_.points[site].y) - grid_.points[at].y);
    };
    const Vector2d u = towards(a);
    const Vector2d w = towards(b);
    const double turn = -std::atan2(u.x() * w.y() - u.y() * w.x(), u.dot(w));
    return turn > 0.0 ? turn : turn + 2.0 * std::numbers::pi;
  }

  const GridPoints& grid_;
  std::vector<OutlineEdge> outline_;
  std::vector<char> used_;
};

/// Cuts a closed walk at every site it visits twice: simple loops are left.
std::vector<std::vector<std::size_t>> simple_loops(const std::vector<std::size_t>& walk) {
  std::vector<std::vector<std::size_t>> loops;
  std::vector<std::size_t> path;
  std::map<std::size_t, std::size_t> place;  // site -> its index in path
  for (const std::size_t site : walk) {
    const auto seen = place.find(site);
    if (seen != place.end()) {
      const auto begin = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
      loops.emplace_back(begin, path.end());
      for (auto it = begin + 1; it != path.end(); ++it) place.erase(*it);
      path.erase(begin + 1, path.end());
      continue;
    }
    place.emplace(site, path.size());
    path.push_back(site);
  }
  loops.push_back(std::move(path));
  return loops;
}

Ring to_ring(const GridPoints& grid, const std::vector<std::size_t>& loop) {
  Ring ring;
  ring.reserve(loop.size());
  for (const std::size_t site : loop) ring.push_back(grid.metres(site));
  return ring;
}

void sort_largest_first(std::vector<Polygon>& polygons) {
  std::stable_sort(polygons.begin(), polygons.end(),
                   [](const Polygon& a, const Polygon& b) { return area(a) > area(b); });
}

/// Every part has one ring that runs counter-clockwise, its outer one; all others are its holes.
std::vector<Polygon> assemble(const GridPoints& grid, const std::vector<RingTracer::Walk>& walks,
                              const AlphaShapeOptions& options) {
  std::map<std::size_t, Polygon> parts;
  for (const RingTracer::Walk& walk : walks) {
    Polygon& part = parts[walk.part];
    for (const auto& loop : simple_loops(walk.sites)) {
      Ring ring = to_ring(grid, loop);
      const double ring_area = signed_area(ring);
      if (ring_area > 0.0) {
        part.outer = std::move(ring);
      } else if (-ring_area >= options.min_hole_m2) {
        part.holes.push_back(std::move(ring));
      }
    }
  }
  std::vector<Polygon> polygons;
  for (auto& [root, part] : parts) {
    if (part.outer.empty() || area(part) < options.min_part_m2) continue;
    polygons.push_back(std::move(part));
  }
  sort_largest_first(polygons);
  return polygons;
}

}  // namespace

void AlphaShapeOptions::check() const {
  if (!(alpha_m > 0.0)) throw_bad_option("alpha_m", alpha_m, "greater than 0");
  if (!(min_part_m2 >= 0.0)) throw_bad_option("min_part_m2", min_part_m2, "at least 0");
  if (!(min_hole_m2 >= 0.0)) throw_bad_option("min_hole_m2", min_hole_m2, "at least 0");
}

std::vector<Polygon> alpha_shape(const std::vector<Vector2d>& points, const AlphaShapeOptions& options) {
  options.check();
  GridPoints grid;
  if (options.thin) {
    std::vector<Vector2d> few;
    for (const std::uint32_t i : thinned(points, 0.25 * options.alpha_m)) few.push_back(points[i]);
    grid = on_grid(few, options.alpha_m);
  } else {
    grid = on_grid(points, options.alpha_m);
  }
  if (grid.points.size() < 3) return {};
  RingTracer tracer(grid, outline_edges(delaunay_faces(grid.points, options.alpha_m / grid.unit_m)));
  return assemble(grid, tracer.walks(), options);
}

}  // namespace limen
