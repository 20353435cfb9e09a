// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/uneven_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "limen/base/angles.h"
#include "limen/geometry/linear.h"
#include "limen/register/judge/share_belief.h"

namespace limen {
namespace {

constexpr double kLeastLengthM = 1.2;    // a shorter one has the direction of its plaster
constexpr double kLeastOverlapM2 = 1.0;  // seen by both
constexpr double kMostApartM = 0.03;     // what lies farther apart is another surface: a niche, a panel
constexpr double kOnePlaneM = 0.1;       // what lies so in one plane is one wall, or its two layers
constexpr double kOnePlaneCosine = 0.9986;
constexpr double kIndependentM2 = 0.01;  // of a plane's points those so near err together
constexpr double kBendLengthM = 3.0;     // for which bends are told
constexpr double kReplicated = 0.05;     // of buildings that repeat, those that repeat their flaws
constexpr double kMostAskewDeg = 1.5;    // what stands off the square by more was drawn so
constexpr double kUprightNormal = 0.1;   // sine of a wall's lean, at most
constexpr std::size_t kLeastPlanes = 3;  // one turn fits two
constexpr std::size_t kMostPlanes = 10;  // the largest
constexpr double kThings = 0.2;  // of the planes, those of things that were put up, askew alike in twins
constexpr int kMostThings = 3;
const double kMostAskewRad = radians(kMostAskewDeg);
const double kThingApartRad = radians(0.5);  // by hand

/// A heading's distance from a direction of the square, within 45 degrees.
double off_square(double heading_rad, double square_rad) {
  return std::remainder(heading_rad - square_rad, 0.5 * std::numbers::pi);
}

double heading_of(const Vector3d& normal) {
  return std::atan2(normal.y(), normal.x());
}

bool is_wall(const Vector3d& normal) {
  return std::abs(normal.z()) < kUprightNormal;
}

/// The heading of the square that most walls follow; none where there is no wall.
std::optional<double> square_of(std::span<const CommonPlane> planes) {
  std::optional<double> square;
  double most_m = 0.0;
  for (const CommonPlane& first : planes) {
    if (!is_wall(first.target_normal)) continue;
    const double heading = heading_of(first.target_normal);
    double along_m = 0.0;
    for (const CommonPlane& other : planes) {
      const bool along = is_wall(other.target_normal) &&
                         std::abs(off_square(heading_of(other.target_normal), heading)) < kMostAskewRad;
      if (along) along_m += other.length_m[0];
    }
    if (along_m <= most_m) continue;
    most_m = along_m;
    square = heading;
  }
  return square;
}

/// Of one plane: by how much its normals lie apart, and off what was drawn, along two directions; and what a
/// small turn does to these.
struct Deviation {
  Vector2d apart;
  Vector2d askew;
  Vector2d measured;  ///< variance that the points' scatter leaves of `apart`
  Vector2d bend;      ///< a bend of one radian in 3 m does so much
  std::array<Vector3d, 2> of_turn;
};

Deviation deviation_of(const CommonPlane& plane, const Vector3d& drawn,
                       const std::array<Vector3d, 2>& along) {
  Deviation deviation;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double source = plane.source_sigma_rad[k];
    const double target = plane.target_sigma_rad[k];
    deviation.apart[row] = along[k].dot(plane.target_normal - plane.source_normal);
    deviation.askew[row] = 0.5 * along[k].dot(plane.target_normal + plane.source_normal);
    deviation.measured[row] = source * source + target * target;
    deviation.bend[row] = std::max(1.0, kBendLengthM / plane.length_m[k]);
    deviation.of_turn[k] = drawn.cross(along[k]);
  }
  return deviation;
}

/// Those of the planes that were drawn square and plumb.
std::vector<Deviation> deviations_of(std::span<const CommonPlane> planes, double square_rad) {
  const Vector3d x(std::cos(square_rad), std::sin(square_rad), 0.0);
  const std::array<Vector3d, 3> axes = {x, Vector3d::UnitZ().cross(x), Vector3d::UnitZ()};
  std::vector<Deviation> deviations;
  for (const CommonPlane& plane : planes) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double cosine = plane.target_normal.dot(axes[k]);
      if (std::abs(cosine) < std::cos(kMostAskewRad)) continue;
      const Vector3d drawn = cosine < 0.0 ? Vector3d(-axes[k]) : axes[k];
      const std::array<Vector3d, 2> along = {axes[k == 0 ? 1 : 0], axes[k == 2 ? 1 : 2]};
      deviations.push_back(deviation_of(plane, drawn, along));
    }
  }
  return deviations;
}

/// Normal values after a turn of which nothing is known: sums from which their density follows.
struct TurnedValues {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double logs = 0.0;
  double squares = 0.0;

  TurnedValues() = default;
  TurnedValues(const Deviation& plane, const Vector2d& values, const Vector2d& variances) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      normal += plane.of_turn[k] * plane.of_turn[k].transpose() / variances[row];
      right += plane.of_turn[k] * (values[row] / variances[row]);
      logs += std::log(variances[row]);
      squares += values[row] * values[row] / variances[row];
    }
  }
  void add(const TurnedValues& other, double sign) {
    normal += sign * other.normal;
    right += sign * other.right;
    logs += sign * other.logs;
    squares += sign * other.squares;
  }
  [[nodiscard]] double log_density() const {
    const Matrix3d known =
        normal + Matrix3d::Identity();  // a turn of one radian: nothing beside what planes say
    return -0.5 * (logs + std::log(known.determinant()) + squares - right.dot(inverse_of(known) * right));
  }
};

/// A plane's part in the density of all: as a wall, of either explanation, and as a thing that was put up
/// askew alike, of which either explanation says the same.
struct PlaneTerms {
  TurnedValues wall;
  TurnedValues thing;
};

/// log densities of all planes, up to `kMostThings` of which may be things: one for each choice.
void add_choices(const std::vector<std::array<PlaneTerms, 2>>& planes, double log_prior,
                 std::vector<double>& logs) {
  std::array<TurnedValues, 2> all;
  for (const auto& plane : planes) {
    for (std::size_t k = 0; k < 2; ++k) all[k].add(plane[k].wall, 1.0);
  }
  const auto with_things = [&](auto&& self, std::size_t first, int things, double prior) -> void {
    logs.push_back(prior + all[0].log_density() + all[1].log_density());
    if (things == kMostThings) return;
    for (std::size_t i = first; i < planes.size(); ++i) {
      for (const double sign : {1.0, -1.0}) {
        for (std::size_t k = 0; k < 2; ++k) {
          all[k].add(planes[i][k].wall, -sign);
          all[k].add(planes[i][k].thing, sign);
        }
        if (sign > 0.0) self(self, i + 1, things + 1, prior + std::log(kThings / (1.0 - kThings)));
      }
    }
  };
  with_things(with_things, 0, 0, log_prior);
}

/// What these planes say against a twin, natural logarithm.
double nats_of(const std::vector<Deviation>& seen) {
  // How askew walls are built, and how much they bend, nobody knows beforehand.
  constexpr std::array<double, 8> kAskewDeg = {0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8};
  constexpr std::array<double, 4> kBendDeg = {0.02, 0.05, 0.1, 0.2};
  std::vector<double> same_logs;
  std::vector<double> twin_logs;
  for (const double bend_deg : kBendDeg) {
    for (const double askew_deg : kAskewDeg) {
      const Vector2d built = Vector2d::Constant(std::pow(radians(askew_deg), 2));
      std::vector<std::array<PlaneTerms, 2>> same;
      std::vector<std::array<PlaneTerms, 2>> twin;
      for (const Deviation& plane : seen) {
        const Vector2d apart = plane.measured + (radians(bend_deg) * plane.bend).array().square().matrix();
        const TurnedValues thing_apart(plane, plane.apart,
                                       apart + Vector2d::Constant(kThingApartRad * kThingApartRad));
        const TurnedValues thing_askew(plane, plane.askew,
                                       apart + Vector2d::Constant(kMostAskewRad * kMostAskewRad));
        same.push_back({PlaneTerms{TurnedValues(plane, plane.apart, apart), thing_apart},
                        PlaneTerms{TurnedValues(plane, plane.askew, 0.25 * apart + built), thing_askew}});
        // A twin's walls are askew in their own way: the two lie apart, and their mean is less askew.
        twin.push_back(
            {PlaneTerms{TurnedValues(plane, plane.apart, apart + 2.0 * built), thing_apart},
             PlaneTerms{TurnedValues(plane, plane.askew, 0.25 * apart + 0.5 * built), thing_askew}});
      }
      add_choices(same, 0.0, same_logs);
      add_choices(twin, 0.0, twin_logs);
    }
  }
  const double same = log_sum_exp(same_logs);
  const double twin =
      log_sum_exp({std::log(1.0 - kReplicated) + log_sum_exp(twin_logs), std::log(kReplicated) + same});
  return same - twin;
}

/// What of a plane is told of both scans, along two directions within it.
struct Measured {
  std::array<double, 2> length_m = {0.0, 0.0};
  std::array<double, 2> sigma_rad = {0.0, 0.0};
};

Measured measured_of(const PlanarPolygon& plane, const std::array<Vector3d, 2>& along) {
  Measured measured;
  const double independent =
      std::clamp(plane.area_m2 / kIndependentM2, 4.0, std::max(4.0, static_cast<double>(plane.inliers)));
  for (std::size_t k = 0; k < 2; ++k) {
    double low = 1e300;
    double high = -1e300;
    for (const Polygon& part : plane.parts) {
      for (const Vector2d& corner : part.outer) {
        const double at = along[k].dot(plane.frame.to_space(corner));
        low = std::min(low, at);
        high = std::max(high, at);
      }
    }
    measured.length_m[k] = std::max(0.01, high - low);
    measured.sigma_rad[k] = plane.rms_m / std::sqrt(independent) / (measured.length_m[k] / std::sqrt(12.0));
  }
  return measured;
}

std::array<Vector3d, 2> directions_within(const Vector3d& normal) {
  if (!is_wall(normal)) return {Vector3d::UnitX(), Vector3d::UnitY()};
  const Vector3d level = Vector3d::UnitZ().cross(normal).normalized();
  return {level, Vector3d::UnitZ()};
}

CommonPlane common_plane(const PlanarPolygon& from, const PlanarPolygon& to,
                         const Matrix3d& target_from_source) {
  const std::array<Vector3d, 2> along = directions_within(to.plane.normal);
  const Matrix3d back = target_from_source.transpose();
  const Measured source = measured_of(from, {back * along[0], back * along[1]});
  const Measured target = measured_of(to, along);
  CommonPlane plane;
  plane.source_normal = target_from_source * from.plane.normal;
  plane.target_normal = to.plane.normal;
  if (plane.source_normal.dot(plane.target_normal) < 0.0) plane.source_normal = -plane.source_normal;
  for (std::size_t k = 0; k < 2; ++k) plane.length_m[k] = std::min(source.length_m[k], target.length_m[k]);
  plane.source_sigma_rad = source.sigma_rad;
  plane.target_sigma_rad = target.sigma_rad;
  return plane;
}

}  // namespace

std::vector<CommonPlane> common_planes(const RefinedPose& pose, const ScanView& source,
                                       const ScanView& target) {
  std::vector<PlaneMatch> matches = pose.matches;
  std::stable_sort(matches.begin(), matches.end(),
                   [](const PlaneMatch& a, const PlaneMatch& b) { return a.overlap_m2 > b.overlap_m2; });
  std::vector<CommonPlane> planes;
  std::vector<const PlanarPolygon*> taken;
  for (const PlaneMatch& match : matches) {
    if (match.overlap_m2 < kLeastOverlapM2) break;
    if (std::abs(match.distance_m) > kMostApartM) continue;
    const PlanarPolygon& from = source.features->planes[static_cast<std::size_t>(match.source)];
    const PlanarPolygon& to = target.features->planes[static_cast<std::size_t>(match.target)];
    const bool told = std::any_of(taken.begin(), taken.end(), [&](const PlanarPolygon* other) {
      return std::abs(other->plane.normal.dot(to.plane.normal)) > kOnePlaneCosine &&
             std::abs(other->plane.normal.dot(to.centroid - other->centroid)) < kOnePlaneM;
    });
    if (told) continue;
    const CommonPlane plane = common_plane(from, to, pose.target_from_source.rotation);
    if (plane.length_m[0] < kLeastLengthM) continue;
    taken.push_back(&to);
    planes.push_back(plane);
    if (planes.size() == kMostPlanes) break;
  }
  return planes;
}

double unevenness_nats(std::span<const CommonPlane> planes) {
  const std::optional<double> square = square_of(planes);
  if (!square) return 0.0;
  const std::vector<Deviation> seen = deviations_of(planes, *square);
  return seen.size() < kLeastPlanes ? 0.0 : std::max(0.0, nats_of(seen));
}

}  // namespace limen
