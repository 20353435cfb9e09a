// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/opening_evidence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::size_t kRaysPerBlock = 128;  // consecutive rays that are rejected together
constexpr std::size_t kBlocksPerPiece = 128;
constexpr double kMinStandOff_m = 0.05;   // of the scanner before a wall that it sees
constexpr double kMinBeside_m = 0.3;      // of wall beside an opening; reveals one above the other have less
constexpr double kMaxExtension_m = 0.5;   // of a ray beyond a point before the wall
constexpr double kMobileRelief_m = 0.12;  // plinths, bands and cornices of façades
constexpr double kStaticRelief_m = 0.05;  // linings; farther before an inner wall hang curtains
constexpr double kSurelyWall_m2 = 6.0;    // a lower wall of a low room; no furniture is that large
constexpr double kParallel = 0.9962;      // cosine of 5 degrees
constexpr double kSameWall_m = 0.03;      // planes this near to each other, facing one way, are one wall
constexpr double kCurtainGap_m = 0.3;     // what hangs this near before the wall may be a curtain

const Vector3d& centre_of(const Scan& scan, const OpeningOptions& options, std::size_t i) {
  return scan.centre_known() ? scan.centre(i) : *options.centre;
}

/// The polygon's plane with its normal towards the scanner; the sign is unknown where `seen` is false.
struct FacingPlane {
  Plane plane;
  bool seen = false;
};

FacingPlane facing(const PlanarPolygon& polygon, const Scan& scan, const OpeningOptions& options) {
  if (polygon.oriented) return {polygon.plane, true};
  if (scan.mobile()) return {};
  const Vector3d& centre = scan.centre_known() ? scan.centre(0) : *options.centre;
  const double side = polygon.plane.signed_distance(centre);
  if (std::abs(side) < kMinStandOff_m) return {};
  return {side > 0.0 ? polygon.plane : polygon.plane.flipped(), true};
}

Box2 box_in(const PlaneFrame& frame, const PlanarPolygon& polygon) {
  Box2 box;
  for (const Polygon& part : polygon.parts) {
    for (const Vector2d& p : part.outer) box.add(frame.to_plane(polygon.frame.to_space(p)));
  }
  return box;
}

/// Distance between two boxes along the axis where they are farthest apart; negative where they overlap.
double gap_between(const Box2& a, const Box2& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).maxCoeff();
}

OpeningWall make_wall(int base, const Plane& plane, const Vector3d& centroid, const Vector3d& up) {
  OpeningWall wall;
  wall.base = base;
  wall.plane = plane;
  wall.frame.origin = plane.project(centroid);
  wall.frame.v = (up - up.dot(plane.normal) * plane.normal).normalized();
  wall.frame.u = wall.frame.v.cross(plane.normal);
  return wall;
}

/// Adds to the wall all planes in its plane that are near to what it has, until none is left.
void add_members(OpeningWall& wall, const std::vector<PlanarPolygon>& polygons,
                 const std::vector<FacingPlane>& planes, const std::vector<char>& taken,
                 const OpeningOptions& options) {
  const double reach_m = std::max(options.max_width_m, options.max_height_m);
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t k = 0; k < polygons.size(); ++k) {
      if (wall.planes[k] == static_cast<char>(PlaneRole::member) || taken[k] != 0 || !planes[k].seen)
        continue;
      if (planes[k].plane.normal.dot(wall.plane.normal) < kParallel) continue;
      const Vector3d& centroid = polygons[k].centroid;
      if (std::abs(wall.plane.signed_distance(centroid)) > kSameWall_m) continue;
      const Box2 box = box_in(wall.frame, polygons[k]);
      if (box.empty() || (!wall.box.empty() && gap_between(wall.box, box) > reach_m)) continue;
      wall.box.add(box.low);
      wall.box.add(box.high);
      wall.planes[k] = static_cast<char>(PlaneRole::member);
      grown = true;
    }
  }
}

/// Of the planes that are the wall's own.
double area_of(const OpeningWall& wall, const std::vector<PlanarPolygon>& polygons) {
  double area_m2 = 0.0;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (wall.planes[k] == static_cast<char>(PlaneRole::member)) area_m2 += polygons[k].area_m2;
  }
  return area_m2;
}

void mark_relief(OpeningWall& wall, const std::vector<PlanarPolygon>& polygons, double max_relief_m) {
  const double area_m2 = area_of(wall, polygons);
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (wall.planes[k] != static_cast<char>(PlaneRole::other)) continue;
    if (std::abs(polygons[k].plane.normal.dot(wall.plane.normal)) < kParallel) continue;
    // The larger of two is the wall; before frames and blinds it is not their ornament.
    if (polygons[k].area_m2 > area_m2) continue;
    const double before_m = wall.plane.signed_distance(polygons[k].centroid);
    if (before_m > 0.0 && before_m <= max_relief_m) wall.planes[k] = static_cast<char>(PlaneRole::relief);
  }
}

void set_spacing(OpeningWall& wall, const std::vector<PlanarPolygon>& polygons) {
  double area_m2 = 0.0;
  double points = 0.0;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (wall.planes[k] != static_cast<char>(PlaneRole::member)) continue;
    area_m2 += polygons[k].area_m2;
    points += static_cast<double>(polygons[k].inliers);
  }
  wall.spacing_m = std::sqrt(std::max(area_m2, 1e-4) / std::max(points, 1.0));
}

/// A wall made ready for many rays.
struct WallTarget {
  const OpeningWall* wall = nullptr;
  Extent box;  ///< of the wall in space
};

WallTarget make_target(const OpeningWall& wall) {
  const auto at = [&](double u, double v) { return wall.frame.to_space({u, v}); };
  const Box2& b = wall.box;
  Extent box{at(b.low.x(), b.low.y()), at(b.low.x(), b.low.y())};
  for (const Vector3d& corner :
       {at(b.high.x(), b.low.y()), at(b.high.x(), b.high.y()), at(b.low.x(), b.high.y())}) {
    box.low = box.low.cwiseMin(corner);
    box.high = box.high.cwiseMax(corner);
  }
  box.low.array() -= kMaxExtension_m;
  box.high.array() += kMaxExtension_m;
  return {&wall, box};
}

/// Where the ray from the centre to a point meets the wall's plane.
Vector2d crossing(const OpeningWall& wall, const Vector3d& centre, const Vector3d& x) {
  const double off_m = wall.plane.signed_distance(centre);
  const double share = off_m / (off_m - wall.plane.signed_distance(x));
  return wall.frame.to_plane(centre + share * (x - centre));
}

/// Traces the rays of a scan to its walls.
class Tracer {
 public:
  Tracer(const Scan& scan, const ExtractedFeatures& extracted, const std::vector<OpeningWall>& walls,
         const OpeningOptions& options)
      : scan_(scan), labels_(extracted.labels), options_(options) {
    for (const OpeningWall& wall : walls) targets_.push_back(make_target(wall));
    on_wall_m_ = extracted.features.inlier_threshold_m;
    side_m_ = std::min(on_wall_m_, std::max(0.004, 2.0 * extracted.features.noise_m));
    behind_m_ = std::max({options.min_depth_m, 4.0 * extracted.features.noise_m, on_wall_m_ + 0.002});
  }

  using Samples = std::vector<std::pair<std::uint32_t, WallSample>>;  // wall, sample

  [[nodiscard]] Samples trace(std::size_t begin, std::size_t end) const {
    Samples found;
    std::vector<std::uint32_t> near;
    for (std::size_t at = begin; at < end; at += kRaysPerBlock) {
      const std::size_t stop = std::min(at + kRaysPerBlock, end);
      near.clear();
      const Extent centres = bounds(at, stop, [&](std::size_t i) { return centre_of(scan_, options_, i); });
      const Extent points = bounds(at, stop, [&](std::size_t i) { return scan_.points[i]; });
      for (std::size_t w = 0; w < targets_.size(); ++w) {
        if (may_meet(centres, points, targets_[w])) near.push_back(static_cast<std::uint32_t>(w));
      }
      for (std::size_t i = at; i < stop && !near.empty(); ++i) {
        for (const std::uint32_t w : near) add_sample(i, w, found);
      }
    }
    return found;
  }

 private:
  template <typename At>
  [[nodiscard]] Extent bounds(std::size_t begin, std::size_t end, const At& at) const {
    Extent box{at(begin), at(begin)};
    for (std::size_t i = begin + 1; i < end; ++i) {
      box.low = box.low.cwiseMin(at(i));
      box.high = box.high.cwiseMax(at(i));
    }
    return box;
  }

  [[nodiscard]] bool may_meet(const Extent& centres, const Extent& points, const WallTarget& target) const {
    const Vector3d low = centres.low.cwiseMin(points.low);
    const Vector3d high = centres.high.cwiseMax(points.high);
    if ((low.array() > target.box.high.array()).any() || (high.array() < target.box.low.array()).any())
      return false;
    if (signed_distances(target.wall->plane, centres).second < kMinStandOff_m) return false;
    return signed_distances(target.wall->plane, points).first <= std::max(kCurtainGap_m, kMobileRelief_m);
  }

  /// What a point says that lies `before` the wall's plane (negative: behind), if anything.
  [[nodiscard]] bool kind_of(std::size_t point, const OpeningWall& wall, double before_m,
                             SampleKind& kind) const {
    const std::int32_t label = labels_[point];
    const auto role =
        label < 0 ? PlaneRole::other : static_cast<PlaneRole>(wall.planes[static_cast<std::size_t>(label)]);
    if (role == PlaneRole::member || role == PlaneRole::relief) {
      kind = SampleKind::wall;
      return true;
    }
    if (before_m > on_wall_m_) {
      kind = SampleKind::cover;
      return before_m <= kCurtainGap_m;
    }
    if (before_m > -side_m_) {
      kind = SampleKind::wall;
      return label < 0;
    }
    kind = -before_m >= behind_m_ ? SampleKind::open : SampleKind::shallow;
    // Where points within the threshold belong to no other plane they may as well be wall.
    return -before_m > on_wall_m_ || label >= 0;
  }

  void add_sample(std::size_t point, std::uint32_t w, Samples& found) const {
    const OpeningWall& wall = *targets_[w].wall;
    const Vector3d& x = scan_.points[point];
    const double before_m = wall.plane.signed_distance(x);
    if (before_m > std::max(kCurtainGap_m, kMobileRelief_m)) return;
    const Vector3d& centre = centre_of(scan_, options_, point);
    const double off_m = wall.plane.signed_distance(centre);
    if (off_m < kMinStandOff_m || off_m <= before_m) return;
    const Vector3d ray = x - centre;
    const double share = off_m / (off_m - before_m);
    const Vector2d at = wall.frame.to_plane(centre + share * ray);
    if (!wall.box.contains(at)) return;
    if (before_m > 0.0 &&
        (share - 1.0) * (share - 1.0) * ray.squaredNorm() > kMaxExtension_m * kMaxExtension_m)
      return;
    WallSample sample{static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(-before_m),
                      static_cast<std::uint32_t>(point), SampleKind::wall};
    if (!kind_of(point, wall, before_m, sample.kind)) return;
    if (sample.kind == SampleKind::wall) {
      // The wall is where the point lies: a grazing ray meets the plane decimetres away.
      const Vector2d own = wall.frame.to_plane(x);
      sample.u = static_cast<float>(own.x());
      sample.v = static_cast<float>(own.y());
    }
    found.emplace_back(w, sample);
  }

  const Scan& scan_;
  const std::vector<std::int32_t>& labels_;
  const OpeningOptions& options_;
  std::vector<WallTarget> targets_;
  double on_wall_m_ = 0.0;  // no farther from the plane a point in no plane is wall
  double side_m_ = 0.0;     // farther behind it a point of another plane is not
  double behind_m_ = 0.0;   // farther behind it a point lies in an opening
};

/// Points that count as wall but lie a little behind what is wall around them are the sides of openings: with
/// a threshold of 2.5 cm they reach that far into the opening. Walls bulge: what is wall is decided locally.
void part_sides(const Scan& scan, const OpeningOptions& options, double noise_m, WallEvidence& evidence) {
  constexpr double kTile_m = 0.5;
  constexpr double kMinBehind_m = 0.004;
  const Vector2d size = evidence.wall.box.high - evidence.wall.box.low;
  const auto columns = static_cast<std::size_t>(size.x() / kTile_m) + 1;
  const auto rows = static_cast<std::size_t>(size.y() / kTile_m) + 1;
  const auto tile_of = [&](const WallSample& sample) {
    const Vector2d at = (Vector2d(sample.u, sample.v) - evidence.wall.box.low).cwiseMax(0.0) / kTile_m;
    return std::min(rows - 1, static_cast<std::size_t>(at.y())) * columns +
           std::min(columns - 1, static_cast<std::size_t>(at.x()));
  };
  // Means of the front half: two passes, the second without what lies behind the first's mean.
  std::vector<double> depth(columns * rows, 1e9);
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<double> sum(depth.size(), 0.0);
    std::vector<double> count(depth.size(), 0.0);
    for (const WallSample& sample : evidence.samples) {
      if (sample.kind != SampleKind::wall) continue;
      const std::size_t tile = tile_of(sample);
      if (sample.depth_m > depth[tile] + 2.0 * noise_m) continue;
      sum[tile] += sample.depth_m;
      count[tile] += 1.0;
    }
    for (std::size_t t = 0; t < depth.size(); ++t) depth[t] = count[t] > 0.0 ? sum[t] / count[t] : 1e9;
  }
  const double behind_m = std::max(kMinBehind_m, 2.0 * noise_m);
  for (WallSample& sample : evidence.samples) {
    if (sample.kind != SampleKind::wall || !(sample.depth_m > depth[tile_of(sample)] + behind_m)) continue;
    sample.kind = SampleKind::shallow;
    const Vector2d at =
        crossing(evidence.wall, centre_of(scan, options, sample.point), scan.points[sample.point]);
    sample.u = static_cast<float>(at.x());
    sample.v = static_cast<float>(at.y());
  }
}

}  // namespace

std::vector<OpeningWall> opening_walls(const Scan& scan, const ExtractedFeatures& extracted,
                                       const Vector3d& up, const OpeningOptions& options) {
  const std::vector<PlanarPolygon>& polygons = extracted.features.planes;
  std::vector<FacingPlane> planes;
  for (const PlanarPolygon& polygon : polygons) {
    planes.push_back(polygon.interior ? FacingPlane{} : facing(polygon, scan, options));
  }
  std::vector<int> bases = find_facades(polygons, up, options.walls);
  std::sort(bases.begin(), bases.end());  // most points first
  std::vector<char> taken(polygons.size(), 0);
  std::vector<OpeningWall> walls;
  for (const int base : bases) {
    const auto k = static_cast<std::size_t>(base);
    if (taken[k] != 0 || !planes[k].seen) continue;
    OpeningWall wall = make_wall(base, planes[k].plane, polygons[k].centroid, up);
    wall.planes.assign(polygons.size(), static_cast<char>(PlaneRole::other));
    wall.planes[k] = static_cast<char>(PlaneRole::member);
    wall.box = box_in(wall.frame, polygons[k]);
    add_members(wall, polygons, planes, taken, options);
    for (std::size_t j = 0; j < polygons.size(); ++j) {
      if (wall.planes[j] == static_cast<char>(PlaneRole::member)) taken[j] = 1;
    }
    const Vector2d size = wall.box.high - wall.box.low;
    if (size.x() < options.min_width_m + kMinBeside_m) continue;
    if (size.y() < options.min_wall_m && area_of(wall, polygons) < kSurelyWall_m2) continue;
    mark_relief(wall, polygons, scan.mobile() ? kMobileRelief_m : kStaticRelief_m);
    set_spacing(wall, polygons);
    walls.push_back(std::move(wall));
  }
  return walls;
}

std::vector<WallEvidence> opening_evidence(const Scan& scan, const ExtractedFeatures& extracted,
                                           const std::vector<OpeningWall>& walls,
                                           const OpeningOptions& options, Monitor& monitor) {
  const Tracer tracer(scan, extracted, walls, options);
  constexpr std::size_t kPiece = kRaysPerBlock * kBlocksPerPiece;
  std::vector<Tracer::Samples> pieces((scan.size() + kPiece - 1) / kPiece);
  parallel_for(scan.size(), kPiece, [&](std::size_t begin, std::size_t end) {
    monitor.throw_if_cancelled();
    pieces[begin / kPiece] = tracer.trace(begin, end);
  });
  std::vector<std::size_t> counts(walls.size(), 0);
  for (const Tracer::Samples& piece : pieces) {
    for (const auto& [wall, sample] : piece) ++counts[wall];
  }
  std::vector<WallEvidence> evidence(walls.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    evidence[w].wall = walls[w];
    evidence[w].samples.reserve(counts[w]);
  }
  for (Tracer::Samples& piece : pieces) {
    for (const auto& [wall, sample] : piece) evidence[wall].samples.push_back(sample);
    piece = {};
  }
  parallel_for(evidence.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w)
      part_sides(scan, options, extracted.features.noise_m, evidence[w]);
  });
  return evidence;
}

}  // namespace limen
