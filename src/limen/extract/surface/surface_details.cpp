// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/surface/surface_details.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "limen/geometry/linear.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

/// Edge of the cubes whose points make one piece; twice that where they are few.
constexpr double kDetailM = 0.10;
constexpr std::size_t kLeastOfDetail = 8;   // points of a piece
constexpr std::size_t kMostDetails = 4000;  // of a scan, evenly chosen
constexpr double kBuiltLengthM = 2.1;
constexpr double kBuiltArea_m2 = 3.0;
constexpr double kFlatter = 2.0;  // a piece is wider, both ways, than so many times its scatter
constexpr double kLeastWidthM = 0.012;

/// A point and the cube, or tile of its plane, that it belongs to: pieces do not mix planes.
struct Placed {
  std::int64_t cube = 0;
  std::int32_t plane = -1;
  std::uint32_t point = 0;

  bool operator<(const Placed& other) const {
    return std::tie(cube, plane, point) < std::tie(other.cube, other.plane, other.point);
  }
};

std::int64_t cube_of(const Vector3d& p, double edge_m) {
  const auto part = [&](double x) { return static_cast<std::int64_t>(std::floor(x / edge_m)) & 0x1fffff; };
  return (part(p.z()) << 42) | (part(p.y()) << 21) | part(p.x());
}

/// Of a point on a plane: cubes would cut a plane that runs along their faces in two.
std::int64_t tile_of(const PlanarPolygon& plane, const Vector3d& p, double edge_m) {
  const Vector2d at = plane.frame.to_plane(p);
  return cube_of({at.x(), at.y(), 0.0}, edge_m);
}

/// Points on no plane of the building.
std::vector<std::uint32_t> points_of_things(const std::vector<std::int32_t>& labels,
                                            const std::vector<PlanarPolygon>& planes) {
  std::vector<bool> building(planes.size());
  for (std::size_t k = 0; k < planes.size(); ++k) building[k] = of_building(planes[k]);
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < labels.size(); ++i)
    if (labels[i] < 0 || !building[static_cast<std::size_t>(labels[i])]) points.push_back(i);
  return points;
}

std::vector<Placed> placed_points(const Scan& scan, const std::vector<std::uint32_t>& points,
                                  const std::vector<std::int32_t>& labels,
                                  const std::vector<PlanarPolygon>& planes, double edge_m) {
  std::vector<Placed> placed;
  placed.reserve(points.size());
  for (const std::uint32_t i : points) {
    const std::int32_t label = labels[i];
    const std::int64_t cube = label < 0
                                  ? cube_of(scan.points[i], edge_m)
                                  : tile_of(planes[static_cast<std::size_t>(label)], scan.points[i], edge_m);
    placed.push_back({cube, label, i});
  }
  std::sort(placed.begin(), placed.end());
  return placed;
}

/// The piece that the points [first, last) make.
SurfaceDetail piece_of(const Scan& scan, const std::vector<PlanarPolygon>& planes, const Placed* first,
                       const Placed* last, double edge_m, double max_scatter_m) {
  const auto count = static_cast<double>(last - first);
  Vector3d mean = Vector3d::Zero();
  for (const Placed* it = first; it != last; ++it) mean += scan.points[it->point];
  mean /= count;
  Matrix3d spread = Matrix3d::Zero();
  for (const Placed* it = first; it != last; ++it) {
    const Vector3d d = scan.points[it->point] - mean;
    spread += d * d.transpose();
  }
  const Spectrum3 spectrum = spectrum_of(Matrix3d(spread / count));
  const Vector3d deviation = spectrum.values.cwiseMax(0.0).cwiseSqrt();
  SurfaceDetail piece;
  piece.mean = mean;
  // Of an even square of edge w the deviations are w / sqrt(12).
  const double cell_m2 = edge_m * edge_m;
  piece.area_m2 =
      static_cast<float>(std::clamp(12.0 * deviation[1] * deviation[2], 0.1 * cell_m2, 2.0 * cell_m2));
  const bool flat =
      deviation[0] <= max_scatter_m && deviation[1] >= std::max(kLeastWidthM, kFlatter * deviation[0]);
  if (!flat) return piece;
  // All points of a plane together know its normal better.
  piece.normal = first->plane < 0 ? Vector3d(spectrum.vectors.col(0))
                                  : planes[static_cast<std::size_t>(first->plane)].plane.normal;
  if (scan.centre_known() && piece.normal.dot(scan.centre(first->point) - mean) < 0) piece.normal *= -1.0;
  piece.sigma_m = static_cast<float>(deviation[0] / std::sqrt(count));
  return piece;
}

}  // namespace

bool of_building(const PlanarPolygon& plane) {
  const Box2 box = box_of(plane.parts);
  if (box.empty()) return false;
  return (box.high - box.low).maxCoeff() > kBuiltLengthM || plane.area_m2 > kBuiltArea_m2;
}

std::vector<SurfaceDetail> find_surface_details(const Scan& scan, const std::vector<std::int32_t>& labels,
                                                const std::vector<PlanarPolygon>& planes,
                                                double max_scatter_m) {
  std::vector<SurfaceDetail> pieces;
  std::vector<std::uint32_t> points = points_of_things(labels, planes);
  for (const double edge_m : {kDetailM, 2.0 * kDetailM}) {
    const std::vector<Placed> placed = placed_points(scan, points, labels, planes, edge_m);
    points.clear();
    for (std::size_t first = 0; first < placed.size();) {
      std::size_t last = first;
      while (last < placed.size() && placed[last].cube == placed[first].cube &&
             placed[last].plane == placed[first].plane)
        ++last;
      if (last - first >= kLeastOfDetail) {
        pieces.push_back(
            piece_of(scan, planes, placed.data() + first, placed.data() + last, edge_m, max_scatter_m));
      } else {
        for (std::size_t k = first; k < last; ++k) points.push_back(placed[k].point);
      }
      first = last;
    }
  }
  if (pieces.empty()) return pieces;
  const std::size_t stride = 1 + (pieces.size() - 1) / kMostDetails;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); i += stride) pieces[kept++] = pieces[i];
  pieces.resize(kept);
  return pieces;
}

}  // namespace limen
