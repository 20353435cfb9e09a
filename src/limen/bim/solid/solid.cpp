// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/solid/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kInPlane_m = 1e-4;
constexpr double kOff_m = 2e-4;
/// Ends of two pieces of one outline are as near as this.
constexpr double kJoin_m = 2e-5;

/// A directed piece of an outline: the solid is on its left.
struct SectionPiece {
  Vector2d from;
  Vector2d to;
};

/// Distances of all corners to the plane, with the plane moved aside where corners lie in it.
std::vector<double> heights_of(const PolygonMesh& mesh, const PlaneFrame& frame, PlaneSide side) {
  const Vector3d normal = frame.u.cross(frame.v);
  std::vector<double> heights(mesh.points.size());
  bool touches = false;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = normal.dot(mesh.points[i] - frame.origin);
    touches = touches || std::abs(heights[i]) < kInPlane_m;
  }
  const double shift = side == PlaneSide::before ? kOff_m : -kOff_m;
  if (touches) {
    for (double& height : heights) height -= shift;
  }
  return heights;
}

/// The point where an edge meets the plane, the same from both sides of the edge.
Vector2d crossing(const PolygonMesh& mesh, const std::vector<double>& heights, const PlaneFrame& frame,
                  std::uint32_t a, std::uint32_t b) {
  if (a > b) std::swap(a, b);
  const double t = heights[a] / (heights[a] - heights[b]);
  return frame.to_plane(mesh.points[a] + t * (mesh.points[b] - mesh.points[a]));
}

/// The piece of outline in one triangle; corner on the plane count as above it.
std::optional<SectionPiece> piece_in(const PolygonMesh& mesh, const std::vector<double>& heights,
                                     const PlaneFrame& frame, const std::array<std::uint32_t, 3>& triangle) {
  std::optional<Vector2d> up;
  std::optional<Vector2d> down;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = triangle[k];
    const std::uint32_t b = triangle[(k + 1) % 3];
    if ((heights[a] >= 0.0) == (heights[b] >= 0.0)) continue;
    (heights[a] < 0.0 ? up : down) = crossing(mesh, heights, frame, a, b);
  }
  if (!up || !down) return {};
  // Seen from outside the corners run counter-clockwise: the outline enters where they come down.
  return SectionPiece{*down, *up};
}

std::vector<SectionPiece> pieces_of(const PolygonMesh& mesh, const std::vector<double>& heights,
                                    const PlaneFrame& frame) {
  std::vector<SectionPiece> pieces;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::uint32_t begin = mesh.begin_of(i);
    // A fan covers the polygon with signs, and so do the pieces of outline from it.
    for (std::uint32_t k = begin + 1; k + 1 < mesh.ends[i]; ++k) {
      const auto piece =
          piece_in(mesh, heights, frame, {mesh.corners[begin], mesh.corners[k], mesh.corners[k + 1]});
      if (piece && (piece->to - piece->from).squaredNorm() > 0.0) pieces.push_back(*piece);
    }
  }
  return pieces;
}

/// Looks pieces up by the place they begin at.
class Beginnings {
 public:
  explicit Beginnings(const std::vector<SectionPiece>& pieces) : pieces_(pieces), used_(pieces.size(), 0) {
    for (std::size_t i = 0; i < pieces.size(); ++i) order_.emplace_back(pieces[i].from.x(), i);
    std::sort(order_.begin(), order_.end());
  }

  [[nodiscard]] bool used(std::size_t piece) const { return used_[piece] != 0; }
  void use(std::size_t piece) { used_[piece] = 1; }

  /// The unused piece that begins nearest to `p`, if one is near.
  [[nodiscard]] std::optional<std::size_t> next_at(const Vector2d& p) const {
    std::optional<std::size_t> best;
    double nearest = kJoin_m * kJoin_m;
    auto entry =
        std::lower_bound(order_.begin(), order_.end(), std::make_pair(p.x() - kJoin_m, std::size_t{0}));
    for (; entry != order_.end() && entry->first <= p.x() + kJoin_m; ++entry) {
      const double distance = (pieces_[entry->second].from - p).squaredNorm();
      if (used_[entry->second] != 0 || distance > nearest || (best && distance == nearest)) continue;
      nearest = distance;
      best = entry->second;
    }
    return best;
  }

 private:
  const std::vector<SectionPiece>& pieces_;
  std::vector<char> used_;
  std::vector<std::pair<double, std::size_t>> order_;
};

std::vector<Ring> chained(const std::vector<SectionPiece>& pieces) {
  Beginnings beginnings(pieces);
  std::vector<Ring> rings;
  for (std::size_t first = 0; first < pieces.size(); ++first) {
    if (beginnings.used(first)) continue;
    Ring ring;
    std::optional<std::size_t> piece = first;
    while (piece) {
      beginnings.use(*piece);
      ring.push_back(pieces[*piece].from);
      piece = beginnings.next_at(pieces[*piece].to);
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

}  // namespace

std::vector<Polygon> section(const PolygonMesh& mesh, const PlaneFrame& frame, PlaneSide side) {
  const std::vector<double> heights = heights_of(mesh, frame, side);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  if (heights.empty() || *low >= 0.0 || *high < 0.0) return {};
  std::vector<Polygon> areas;
  Polygon holes;
  for (Ring& ring : chained(pieces_of(mesh, heights, frame))) {
    if (signed_area(ring) > 0.0) {
      areas.push_back({std::move(ring), {}});
    } else {
      holes.holes.push_back(std::move(ring));
    }
  }
  if (areas.empty()) return {};
  std::move(holes.holes.begin(), holes.holes.end(), std::back_inserter(areas.front().holes));
  return merged(areas);
}

Box3 box_of(const PolygonMesh& mesh) {
  constexpr double kFarthestOfBox_m = 1e9;
  Box3 box;
  for (const std::uint32_t corner : mesh.corners) {
    if ((mesh.points[corner].array().abs() < kFarthestOfBox_m).all()) box.add(mesh.points[corner]);
  }
  return box;
}

Box3 box_of(const Solid& solid) {
  Box3 box = box_of(solid.mesh);
  for (const Solid& child : solid.children) {
    const Box3 of_child = box_of(child);
    if (of_child.empty()) continue;
    box.add(of_child.low);
    box.add(of_child.high);
    if (solid.operation == SolidOperation::subtract) break;
  }
  return box;
}

void move(Solid& solid, double scale, const Vector3d& shift) {
  for (Vector3d& point : solid.mesh.points) point = scale * point - shift;
  for (Solid& child : solid.children) move(child, scale, shift);
}

}  // namespace limen
