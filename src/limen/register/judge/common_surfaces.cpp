// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/common_surfaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "limen/base/ranked.h"
#include "limen/geometry/polygon_clip.h"

namespace limen {
namespace {

constexpr double kMostApartM = 0.05;        // what lies farther apart is another surface
constexpr double kParallelCosine = 0.9986;  // 3 degrees
constexpr double kLayersM = 0.1;            // what lies so in one plane is one wall, or its layers
constexpr double kNearTileM = 0.25;         // tiles of two scans nearer than this show the same
constexpr std::size_t kLeastPairs = 4;
constexpr double kLeastLengthM = 1.2;    // a shorter plane has the direction of its plaster
constexpr double kIndependentM2 = 0.01;  // of a plane's points those so near err together
constexpr double kRelativeSlope = 0.05;  // what is known of slopes before: parallel
constexpr double kFlatTileM = 0.0005;    // scatter of a tile of many points, about
constexpr double kOutlier = 4.0;         // of the scatter
constexpr double kLeaningNormal = 0.1;

using TileCell = std::pair<int, int>;

/// How high a tile of the source lies over one of the target, at the same place.
struct TilePair {
  Vector2d at = Vector2d::Zero();  ///< along the two directions
  double apart_m = 0.0;
  double variance = 0.0;  ///< about
};

/// The tiles of one plane by place, in the plane's own grid.
class TileMap {
 public:
  TileMap(const ScanView& scan, const std::vector<const SurfaceSample*>& tiles, const PlanarPolygon& plane)
      : frame_(plane.frame), noise_m_(scan.features->noise_m) {
    for (const SurfaceSample* tile : tiles) tiles_.emplace(cell_of(tile->mean), tile);
  }

  [[nodiscard]] double noise_m() const { return noise_m_; }

  /// The one nearest along the plane, within a tile's edge; null: none.
  [[nodiscard]] const SurfaceSample* nearest(const Vector3d& x) const {
    const TileCell middle = cell_of(x);
    const SurfaceSample* found = nullptr;
    double least = kNearTileM * kNearTileM;
    for (int du = -1; du <= 1; ++du) {
      for (int dv = -1; dv <= 1; ++dv) {
        const auto it = tiles_.find({middle.first + du, middle.second + dv});
        if (it == tiles_.end()) continue;
        const double squared = (frame_.to_plane(it->second->mean) - frame_.to_plane(x)).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        found = it->second;
      }
    }
    return found;
  }

 private:
  [[nodiscard]] TileCell cell_of(const Vector3d& x) const {
    const Vector2d p = frame_.to_plane(x) / kNearTileM;
    return {static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))};
  }

  PlaneFrame frame_;
  double noise_m_;
  std::map<TileCell, const SurfaceSample*> tiles_;
};

std::vector<std::vector<const SurfaceSample*>> tiles_by_plane(const ScanView& view) {
  std::vector<std::vector<const SurfaceSample*>> tiles(view.features->planes.size());
  for (const SurfaceSample& sample : view.features->samples)
    if (sample.plane >= 0) tiles[static_cast<std::size_t>(sample.plane)].push_back(&sample);
  return tiles;
}

/// Whether a plane is the building's: large, a strip of a wall, or at one (a reveal, a column, a frame).
std::vector<bool> of_walls(const ScanView& view, const BuiltPlanes& built) {
  std::vector<bool> flags = built.flags();
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (!flags[i]) flags[i] = built.place(view.features->planes[i].centroid) == BuiltPlanes::Place::at_wall;
  return flags;
}

std::array<Vector3d, 2> directions_within(const Vector3d& normal) {
  if (std::abs(normal.z()) > kLeaningNormal) {
    const Vector3d first = (Vector3d::UnitX() - normal.x() * normal).normalized();
    return {first, normal.cross(first)};
  }
  const Vector3d level = Vector3d::UnitZ().cross(normal).normalized();
  return {level, normal.cross(level)};
}

/// Offset and two slopes by least squares, and how much scatter is left.
struct Fit {
  Vector3d value = Vector3d::Zero();
  Matrix3d covariance = Matrix3d::Identity();
  double factor = 1.0;  ///< of the variances
};

Fit fit_of(const std::vector<TilePair>& pairs) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const TilePair& pair : pairs) {
    const Vector3d row(1.0, pair.at.x(), pair.at.y());
    normal += row * row.transpose() / pair.variance;
    right += row * (pair.apart_m / pair.variance);
  }
  normal(1, 1) += 1.0 / (kRelativeSlope * kRelativeSlope);
  normal(2, 2) += 1.0 / (kRelativeSlope * kRelativeSlope);
  Fit fit;
  fit.covariance = inverse_of(normal);
  fit.value = fit.covariance * right;
  double squares = 0.0;
  for (const TilePair& pair : pairs) {
    const double left = pair.apart_m - fit.value.dot(Vector3d(1.0, pair.at.x(), pair.at.y()));
    squares += left * left / pair.variance;
  }
  // Of few tiles the scatter is known by what their points' number lets expect as well.
  constexpr double kPresumed = 3.0;
  fit.factor = (squares + kPresumed) / (static_cast<double>(pairs.size()) - 3.0 + kPresumed);
  return fit;
}

/// Without what hangs on a wall or protrudes from it.
std::vector<TilePair> without_outliers(const std::vector<TilePair>& pairs) {
  std::vector<double> values;
  for (const TilePair& pair : pairs) values.push_back(pair.apart_m);
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  const double gate = std::max(0.004, kOutlier * 1.5 * median(values));
  std::vector<TilePair> kept;
  for (const TilePair& pair : pairs)
    if (std::abs(pair.apart_m - middle) <= gate) kept.push_back(pair);
  return kept;
}

double length_along(const PlanarPolygon& plane, const Vector3d& direction) {
  double low = 1e300;
  double high = -1e300;
  for (const Polygon& part : plane.parts) {
    for (const Vector2d& corner : part.outer) {
      const double at = direction.dot(plane.frame.to_space(corner));
      low = std::min(low, at);
      high = std::max(high, at);
    }
  }
  return std::max(0.01, high - low);
}

/// What the points' scatter leaves of a plane's normal along a direction in it.
double normal_sigma(const PlanarPolygon& plane, double length_m) {
  const double independent =
      std::clamp(plane.area_m2 / kIndependentM2, 4.0, std::max(4.0, static_cast<double>(plane.inliers)));
  return plane.rms_m / std::sqrt(independent) / (length_m / std::sqrt(12.0));
}

/// What is known of two planes as wholes.
void add_direction(const PlanarPolygon& from, const PlanarPolygon& to, const Matrix3d& rotation,
                   CommonSurface& surface) {
  surface.mean_normal = (rotation * from.plane.normal + to.plane.normal).normalized();
  surface.long_enough = true;
  for (std::size_t k = 0; k < 2; ++k) {
    const double source_m = length_along(from, rotation.transpose() * surface.along[k]);
    const double target_m = length_along(to, surface.along[k]);
    if (k == 0 && std::min(source_m, target_m) < kLeastLengthM) surface.long_enough = false;
    surface.normal_sigma_rad[k] = 0.5 * std::hypot(normal_sigma(from, source_m), normal_sigma(to, target_m));
  }
}

/// One pair of planes, and how much of it both saw.
struct Candidate {
  CommonSurface surface;
  std::size_t tiles = 0;
  double scatter_m = 0.0;
};

class Finder {
 public:
  Finder(const ScanView& source, const Rigid3& target_from_source)
      : source_(source), pose_(target_from_source) {}

  /// The source's tiles over the target's; `to`, `map`: of one plane.
  [[nodiscard]] std::optional<Candidate> ask(const PlanarPolygon& from,
                                             const std::vector<const SurfaceSample*>& tiles,
                                             const PlanarPolygon& to, const TileMap& map) const {
    const std::array<Vector3d, 2> along = directions_within(to.plane.normal);
    std::vector<TilePair> pairs;
    for (const SurfaceSample* tile : tiles) {
      const Vector3d x = pose_ * tile->mean;
      const double height = to.plane.signed_distance(x);
      if (std::abs(height) > 2.0 * kMostApartM) continue;
      const SurfaceSample* other = map.nearest(x);
      if (other == nullptr) continue;
      TilePair pair;
      pair.at = {along[0].dot(x), along[1].dot(x)};
      pair.apart_m = height - to.plane.signed_distance(other->mean);
      if (std::abs(pair.apart_m) > kMostApartM) continue;
      pair.variance = variance_of(*tile, source_.features->noise_m) + variance_of(*other, map.noise_m());
      pairs.push_back(pair);
    }
    if (pairs.size() >= kLeastPairs) pairs = without_outliers(pairs);
    if (pairs.size() < kLeastPairs) return std::nullopt;
    return candidate_of(from, to, along, pairs);
  }

 private:
  static double variance_of(const SurfaceSample& tile, double noise_m) {
    return noise_m * noise_m / std::max(1.0, static_cast<double>(tile.count)) + kFlatTileM * kFlatTileM;
  }

  [[nodiscard]] Candidate candidate_of(const PlanarPolygon& from, const PlanarPolygon& to,
                                       const std::array<Vector3d, 2>& along,
                                       std::vector<TilePair>& pairs) const {
    Candidate candidate;
    candidate.tiles = pairs.size();
    Vector2d middle = Vector2d::Zero();
    Box2 box;
    double variance = 0.0;
    for (const TilePair& pair : pairs) {
      middle += pair.at;
      box.add(pair.at);
      variance += pair.variance;
    }
    const auto count = static_cast<double>(pairs.size());
    middle /= count;
    for (TilePair& pair : pairs) pair.at -= middle;
    const Fit fit = fit_of(pairs);
    CommonSurface& surface = candidate.surface;
    surface.normal = to.plane.normal;
    surface.along = along;
    surface.at = to.plane.offset * to.plane.normal + middle.x() * along[0] + middle.y() * along[1];
    surface.deviation = fit.value;
    surface.measured = fit.factor * fit.covariance;
    for (Eigen::Index k = 0; k < 2; ++k)
      surface.length_m[static_cast<std::size_t>(k)] = box.high[k] - box.low[k] + kNearTileM;
    candidate.scatter_m = std::sqrt(0.5 * fit.factor * variance / count);
    add_direction(from, to, pose_.rotation, surface);
    return candidate;
  }

  const ScanView& source_;
  const Rigid3& pose_;
};

/// Keeps one candidate for each wall, the one with the most tiles.
CommonSurfaces chosen(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.tiles > b.tiles; });
  CommonSurfaces surfaces;
  std::vector<std::pair<double, std::size_t>> scatter;
  std::size_t tiles = 0;
  for (const Candidate& candidate : candidates) {
    const CommonSurface& one = candidate.surface;
    const bool known = std::any_of(surfaces.all.begin(), surfaces.all.end(), [&](const CommonSurface& other) {
      return std::abs(other.normal.dot(one.normal)) > kParallelCosine &&
             std::abs(other.normal.dot(one.at - other.at)) < kLayersM;
    });
    if (known) continue;
    surfaces.all.push_back(one);
    scatter.emplace_back(candidate.scatter_m, candidate.tiles);
    tiles += candidate.tiles;
  }
  std::sort(scatter.begin(), scatter.end());
  std::size_t passed = 0;
  for (const auto& [scatter_m, count] : scatter) {
    passed += count;
    if (2 * passed < tiles) continue;
    surfaces.scatter_m = scatter_m;
    break;
  }
  return surfaces;
}

}  // namespace

struct CommonSurfaceFinder::Walls {
  /// Of the source: a wall with its tiles.
  struct From {
    const PlanarPolygon* plane;
    std::vector<const SurfaceSample*> tiles;
  };
  /// Of the target.
  struct To {
    const PlanarPolygon* plane;
    TileMap tiles;
  };

  ScanView source;
  std::vector<From> from;
  std::vector<To> to;
};

CommonSurfaceFinder::CommonSurfaceFinder(const ScanView& source, const BuiltPlanes& built_source,
                                         const ScanView& target, const BuiltPlanes& built_target)
    : walls_(new Walls{source, {}, {}}) {
  const std::vector<bool> from_walls = of_walls(source, built_source);
  auto from_tiles = tiles_by_plane(source);
  for (std::size_t i = 0; i < from_walls.size(); ++i) {
    if (from_walls[i] && from_tiles[i].size() >= kLeastPairs)
      walls_->from.push_back({&source.features->planes[i], std::move(from_tiles[i])});
  }
  const std::vector<bool> to_walls = of_walls(target, built_target);
  const auto to_tiles = tiles_by_plane(target);
  for (std::size_t j = 0; j < to_walls.size(); ++j) {
    const PlanarPolygon& to = target.features->planes[j];
    if (to_walls[j] && to_tiles[j].size() >= kLeastPairs)
      walls_->to.push_back({&to, TileMap(target, to_tiles[j], to)});
  }
}

CommonSurfaceFinder::~CommonSurfaceFinder() = default;

CommonSurfaces CommonSurfaceFinder::operator()(const Rigid3& target_from_source) const {
  const Finder finder(walls_->source, target_from_source);
  std::vector<Candidate> candidates;
  for (const Walls::To& to : walls_->to) {
    for (const Walls::From& from : walls_->from) {
      if ((target_from_source.rotation * from.plane->plane.normal).dot(to.plane->plane.normal) <
          kParallelCosine)
        continue;
      const std::optional<Candidate> candidate = finder.ask(*from.plane, from.tiles, *to.plane, to.tiles);
      if (candidate) candidates.push_back(*candidate);
    }
  }
  return chosen(std::move(candidates));
}

}  // namespace limen
