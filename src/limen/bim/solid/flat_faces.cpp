// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "limen/base/random.h"
#include "limen/bim/solid/solid_faces.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// Pieces lower than this have no normal worth comparing: their corners decide.
constexpr double kThin_m = 0.01;
/// Narrower faces and holes are left out.
constexpr double kLeastFaceWidthM = 1e-4;

struct FacePiece {
  Vector3d area = Vector3d::Zero();  ///< normal times area
  bool thin = false;
};

/// Pieces of a mesh that lie in one plane.
struct Cluster {
  std::vector<std::size_t> pieces;
  Plane plane;

  [[nodiscard]] bool alive() const { return !pieces.empty(); }
};

double farthest(const PolygonMesh& mesh, std::size_t piece, const Plane& plane) {
  double distance = 0.0;
  for (std::uint32_t k = mesh.begin_of(piece); k < mesh.ends[piece]; ++k)
    distance = std::max(distance, std::abs(plane.signed_distance(mesh.points[mesh.corners[k]])));
  return distance;
}

Plane plane_of(const PolygonMesh& mesh, std::size_t piece, const Vector3d& area) {
  Plane plane{area.normalized(), 0.0};
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t k = mesh.begin_of(piece); k < mesh.ends[piece]; ++k) sum += mesh.points[mesh.corners[k]];
  plane.offset = plane.normal.dot(sum) / static_cast<double>(mesh.ends[piece] - mesh.begin_of(piece));
  return plane;
}

/// Polygons that are not flat become triangles.
PolygonMesh flat_pieces(const PolygonMesh& mesh) {
  PolygonMesh result;
  result.points = mesh.points;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto begin = mesh.corners.begin() + mesh.begin_of(i);
    const std::vector<std::uint32_t> ring(begin, mesh.corners.begin() + mesh.ends[i]);
    if (ring.size() == 3 || farthest(mesh, i, plane_of(mesh, i, area_vector(mesh, i))) <= kFlatFaceM) {
      result.add(ring);
      continue;
    }
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) result.add({ring[0], ring[k], ring[k + 1]});
  }
  return result;
}

std::vector<FacePiece> pieces_of(const PolygonMesh& mesh) {
  std::vector<FacePiece> pieces(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    pieces[i].area = area_vector(mesh, i);
    double longest = 0.0;
    const Vector3d& first = mesh.points[mesh.corners[mesh.begin_of(i)]];
    for (std::uint32_t k = mesh.begin_of(i); k < mesh.ends[i]; ++k)
      longest = std::max(longest, (mesh.points[mesh.corners[k]] - first).norm());
    pieces[i].thin = pieces[i].area.norm() < kThin_m * longest;
  }
  return pieces;
}

/// Gathers pieces into planes: first over shared corners, from large to small, then planes that agree.
class Gatherer {
 public:
  explicit Gatherer(const PolygonMesh& mesh)
      : mesh_(mesh), pieces_(pieces_of(mesh)), at_corner_(mesh.points.size()) {}

  std::vector<Cluster> gather() {
    std::vector<std::size_t> order(mesh_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return pieces_[a].area.squaredNorm() > pieces_[b].area.squaredNorm();
    });
    for (const std::size_t piece : order) {
      if (pieces_[piece].area.norm() > 0.0) place(piece);
    }
    join_equal_planes();
    std::erase_if(clusters_, [](const Cluster& cluster) { return !cluster.alive(); });
    return std::move(clusters_);
  }

 private:
  [[nodiscard]] bool belongs(std::size_t piece, const Cluster& cluster) const {
    const double cosine = pieces_[piece].area.dot(cluster.plane.normal) / pieces_[piece].area.norm();
    if (cosine < (pieces_[piece].thin ? 0.5 : std::cos(kFlatFaceRad))) return false;
    return farthest(mesh_, piece, cluster.plane) <= kFlatFaceM;
  }

  void place(std::size_t piece) {
    std::size_t home = clusters_.size();
    for (std::uint32_t k = mesh_.begin_of(piece); k < mesh_.ends[piece] && home == clusters_.size(); ++k) {
      for (const std::uint32_t cluster : at_corner_[mesh_.corners[k]]) {
        if (!belongs(piece, clusters_[cluster])) continue;
        home = cluster;
        break;
      }
    }
    if (home == clusters_.size()) clusters_.push_back({{}, plane_of(mesh_, piece, pieces_[piece].area)});
    clusters_[home].pieces.push_back(piece);
    for (std::uint32_t k = mesh_.begin_of(piece); k < mesh_.ends[piece]; ++k) {
      std::vector<std::uint32_t>& here = at_corner_[mesh_.corners[k]];
      if (std::find(here.begin(), here.end(), home) == here.end())
        here.push_back(static_cast<std::uint32_t>(home));
    }
  }

  using Cell = std::array<std::int64_t, 4>;
  /// A plane's cell by normal and offset, and the next one in each direction, whose border is nearest.
  struct Place {
    Cell cell;
    Cell towards;  ///< -1 or 1 each
  };
  [[nodiscard]] Place place_of(const Plane& plane) const {
    constexpr double kOffsetCell_m = 0.05;
    Place place{};
    for (std::size_t k = 0; k < 4; ++k) {
      const double value = k < 3 ? plane.normal[static_cast<Eigen::Index>(k)] / (2.0 * kFlatFaceRad)
                                 : plane.signed_distance(centre_) / kOffsetCell_m;
      const double floor = std::floor(value);
      place.cell[k] = static_cast<std::int64_t>(floor);
      place.towards[k] = value - floor < 0.5 ? -1 : 1;
    }
    return place;
  }
  static std::uint64_t key_of(const Cell& cell) {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) hash = mix64(hash ^ static_cast<std::uint64_t>(k));
    return hash;
  }

  void join_equal_planes() {
    if (!mesh_.points.empty()) centre_ = mesh_.points.front();
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> by_cell;
    for (std::uint32_t i = 0; i < clusters_.size(); ++i) {
      const Place place = place_of(clusters_[i].plane);
      const std::uint32_t home = joined_into(i, place, by_cell);
      if (home == i) {
        by_cell[key_of(place.cell)].push_back(i);
        continue;
      }
      std::vector<std::size_t>& pieces = clusters_[home].pieces;
      pieces.insert(pieces.end(), clusters_[i].pieces.begin(), clusters_[i].pieces.end());
      clusters_[i].pieces.clear();
    }
  }

  /// The earlier (larger) cluster that takes cluster i, or i.
  [[nodiscard]] std::uint32_t joined_into(
      std::uint32_t i, const Place& place,
      const std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>& by_cell) const {
    for (unsigned step = 0; step < 16; ++step) {
      Cell cell = place.cell;
      for (std::size_t k = 0; k < 4; ++k) cell[k] += (step >> k & 1U) != 0 ? place.towards[k] : 0;
      const auto found = by_cell.find(key_of(cell));
      if (found == by_cell.end()) continue;
      for (const std::uint32_t other : found->second) {
        const auto& pieces = clusters_[i].pieces;
        if (std::all_of(pieces.begin(), pieces.end(),
                        [&](std::size_t piece) { return belongs(piece, clusters_[other]); }))
          return other;
      }
    }
    return i;
  }

  const PolygonMesh& mesh_;
  std::vector<FacePiece> pieces_;
  std::vector<std::vector<std::uint32_t>> at_corner_;
  std::vector<Cluster> clusters_;
  Vector3d centre_ = Vector3d::Zero();
};

double length_of(const Ring& ring) {
  double length = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) length += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return length;
}

/// Width of a narrow ring, or more of a wide one.
double width_of(const Ring& ring) {
  const double length = length_of(ring);
  return length > 0.0 ? 2.0 * std::abs(signed_area(ring)) / length : 0.0;
}

/// Without corners on straight lines and without holes that rounding made.
Polygon tidy(const Polygon& polygon) {
  constexpr double kStraight_m = 5e-5;
  Polygon result;
  result.outer = simplify_ring(polygon.outer, kStraight_m);
  for (const Ring& hole : polygon.holes) {
    if (width_of(hole) < kLeastFaceWidthM) continue;
    Ring simple = simplify_ring(hole, kStraight_m);
    if (!simple.empty()) result.holes.push_back(std::move(simple));
  }
  return result;
}

Polygon outline_of(const PolygonMesh& mesh, std::size_t piece, const PlaneFrame& frame) {
  Polygon polygon;
  for (std::uint32_t k = mesh.begin_of(piece); k < mesh.ends[piece]; ++k)
    polygon.outer.push_back(frame.to_plane(mesh.points[mesh.corners[k]]));
  return polygon;
}

}  // namespace

std::vector<BimFace> faces_in_plane(const Plane& plane, const PlaneFrame& frame,
                                    const std::vector<Polygon>& areas) {
  std::vector<BimFace> faces;
  for (const Polygon& part : areas) {
    if (width_of(part.outer) < kLeastFaceWidthM) continue;
    BimFace face;
    face.plane = plane;
    face.frame = frame;
    face.outline = tidy(part);
    if (face.outline.outer.size() < 3) continue;
    face.area_m2 = area(face.outline);
    if (face.area_m2 > 0.0) faces.push_back(std::move(face));
  }
  return faces;
}

std::vector<BimFace> flat_faces(const PolygonMesh& mesh, std::int32_t element) {
  const PolygonMesh whole = oriented(flat_pieces(welded(mesh)));
  std::vector<BimFace> faces;
  for (const Cluster& cluster : Gatherer(whole).gather()) {
    const std::size_t largest = cluster.pieces.front();
    const PlaneFrame frame = make_frame(cluster.plane, whole.points[whole.corners[whole.begin_of(largest)]]);
    std::vector<Polygon> pieces;
    for (const std::size_t piece : cluster.pieces) pieces.push_back(outline_of(whole, piece, frame));
    // A lone triangle, as curved surfaces have many, is united already.
    const bool united = pieces.size() == 1 && pieces.front().outer.size() == 3;
    for (BimFace& face : faces_in_plane(cluster.plane, frame, united ? pieces : merged(pieces))) {
      face.element = element;
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

}  // namespace limen
