// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/model_edges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kSharpRad = radians(25.0);  // faces that meet at less make no edge: a curved wall's facets
constexpr double kSameLineM = 0.003;         // edges of two faces within this are one
constexpr double kCellM = 0.5;
constexpr double kSameDirection = 0.9998;  // cosine: about 1.1 degrees
constexpr double kStraightM = 0.0005;      // corners that stand out less are none
constexpr double kBridgeM = 0.005;

/// One side of a polygon.
struct EdgeSide {
  Vector3d a;
  Vector3d b;
  Vector3d normal;  // of its polygon
  [[nodiscard]] double length() const { return (b - a).norm(); }
};

std::vector<EdgeSide> sides_of(const std::vector<PlanarPolygon>& surface) {
  std::vector<EdgeSide> sides;
  const auto add = [&](const PlanarPolygon& polygon, const Ring& outline) {
    const Ring ring = simplify_ring(outline, kStraightM);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      sides.push_back({polygon.frame.to_space(ring[i]), polygon.frame.to_space(ring[(i + 1) % ring.size()]),
                       polygon.plane.normal});
    }
  };
  for (const PlanarPolygon& polygon : surface) {
    for (const Polygon& part : polygon.parts) {
      add(polygon, part.outer);
      for (const Ring& hole : part.holes) add(polygon, hole);
    }
  }
  std::erase_if(sides, [](const EdgeSide& side) { return side.length() < kBridgeM; });
  std::stable_sort(sides.begin(), sides.end(),
                   [](const EdgeSide& a, const EdgeSide& b) { return a.length() > b.length(); });
  return sides;
}

/// A stretch of a line that one polygon's outline runs along.
struct Stretch {
  double from = 0.0;
  double to = 0.0;
  Vector3d normal;
};

struct EdgeLine {
  Vector3d point;
  Vector3d direction;
  std::vector<Stretch> stretches;
};

/// Sides that run along one line, found by the cells they pass.
class LineMaker {
 public:
  void add(const EdgeSide& side) {
    std::size_t line = find(side);
    if (line == lines_.size()) lines_.push_back({side.a, (side.b - side.a).normalized(), {}});
    EdgeLine& own = lines_[line];
    double from = own.direction.dot(side.a - own.point);
    double to = own.direction.dot(side.b - own.point);
    if (from > to) std::swap(from, to);
    own.stretches.push_back({from, to, side.normal});
    const auto steps = 1 + static_cast<std::int64_t>(side.length() / (0.5 * kCellM));
    for (std::int64_t k = 0; k <= steps; ++k) {
      const Vector3d x = side.a + (side.b - side.a) * (static_cast<double>(k) / static_cast<double>(steps));
      std::vector<std::size_t>& cell = cells_[cell_key(cell_of(x, kCellM))];
      if (cell.empty() || cell.back() != line) cell.push_back(line);
    }
  }

  [[nodiscard]] std::vector<EdgeLine>& lines() { return lines_; }

 private:
  [[nodiscard]] bool on_line(const EdgeSide& side, const EdgeLine& line) const {
    if (std::abs((side.b - side.a).dot(line.direction)) < kSameDirection * side.length()) return false;
    const auto off = [&](const Vector3d& x) { return (x - line.point).cross(line.direction).norm(); };
    return off(side.a) <= kSameLineM && off(side.b) <= kSameLineM;
  }

  [[nodiscard]] std::size_t find(const EdgeSide& side) const {
    for (const Vector3d& x : {Vector3d(0.5 * (side.a + side.b)), side.a, side.b}) {
      for (int k = 0; k < 27; ++k) {
        const auto found = cells_.find(cell_key(cell_of(x, kCellM) + way_to_cell(k)));
        if (found == cells_.end()) continue;
        for (const std::size_t line : found->second) {
          if (on_line(side, lines_[line])) return line;
        }
      }
    }
    return lines_.size();
  }

  std::vector<EdgeLine> lines_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

/// Whether the outlines that run along [from, to] make an edge there.
bool sharp(const EdgeLine& line, double from, double to, double min_angle_rad) {
  const double middle = 0.5 * (from + to);
  std::vector<Vector3d> normals;
  for (const Stretch& stretch : line.stretches) {
    if (stretch.from <= middle && middle <= stretch.to) normals.push_back(stretch.normal);
  }
  if (normals.size() < 2) return !normals.empty();
  const double smooth = std::cos(min_angle_rad);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      if (normals[i].dot(normals[j]) < smooth) return true;
    }
  }
  return false;
}

void add_segments(const EdgeLine& line, double min_length_m, std::vector<Segment>& segments) {
  std::vector<double> cuts;
  for (const Stretch& stretch : line.stretches) {
    cuts.push_back(stretch.from);
    cuts.push_back(stretch.to);
  }
  std::sort(cuts.begin(), cuts.end());
  double from = 0.0;
  double to = -1.0;
  const auto flush = [&] {
    if (to - from >= min_length_m)
      segments.push_back({line.point + from * line.direction, line.point + to * line.direction});
    to = from - 1.0;
  };
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k + 1] - cuts[k] < 1e-9) continue;
    if (!sharp(line, cuts[k], cuts[k + 1], kSharpRad)) continue;
    if (to >= from && cuts[k] - to <= kBridgeM) {
      to = cuts[k + 1];
      continue;
    }
    flush();
    from = cuts[k];
    to = cuts[k + 1];
  }
  flush();
}

}  // namespace

std::vector<Segment> sharp_edges(const std::vector<PlanarPolygon>& surface, double min_length_m) {
  if (!(min_length_m > 0)) throw_bad_option("min_length_m", min_length_m, "more than 0");
  LineMaker maker;
  for (const EdgeSide& side : sides_of(surface)) {
    CancelScope::check();
    maker.add(side);
  }
  std::vector<Segment> segments;
  for (const EdgeLine& line : maker.lines()) {
    CancelScope::check();
    add_segments(line, min_length_m, segments);
  }
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Segment& a, const Segment& b) { return a.length() > b.length(); });
  return segments;
}

}  // namespace limen
