// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limen/extract/targets/fit_targets.h"
#include "limen/geometry/linear.h"
#include "limen/geometry/plane.h"

namespace limen {
namespace {

constexpr double kFace = 0.8;        // of the radius: farther out, beams mix with what is behind
constexpr double kInnerFace = 0.55;  // halves the face
constexpr std::size_t kSectors = 6;  // of the face and of its inner half
constexpr std::size_t kLeastPoints = 30;
constexpr double kLeastRangeNoiseM = 0.0005;
constexpr double kUnevenM = 0.0007;  // deviation of a part of the face beside its noise
constexpr double kRadiusM = 0.0015;  // the radius that the points have by themselves
constexpr double kMostUneven = 0.1;  // root mean square of the residuals, of the radius: a wall's are 0.115
constexpr double kMostFreeSigma = 0.045;

/// What one ray says of a sphere: how far from the centre it passes, and by how much its range differs from
/// that to the sphere.
struct SphereRay {
  double aside = 0.0;                 ///< of the radius; at 1 and beyond the ray passes beside the sphere
  double beyond_m = 0.0;              ///< behind the face, or behind the centre where it passes
  Vector3d slope = Vector3d::Zero();  ///< of the range to the face by the centre
  double radius_slope = 0.0;
  Vector3d way = Vector3d::Zero();  ///< across the ray, from the centre
};

SphereRay ray_at(const Vector3d& point, const Vector3d& centre, double radius_m) {
  SphereRay ray;
  const double range = point.norm();
  const Vector3d direction = point / range;
  const double along = centre.dot(direction);
  ray.way = along * direction - centre;
  const double off = ray.way.squaredNorm();
  ray.aside = std::sqrt(off) / radius_m;
  ray.beyond_m = range - along;
  if (ray.aside >= kFace) return ray;
  const double half_chord = std::sqrt(radius_m * radius_m - off);
  ray.beyond_m += half_chord;
  const Vector3d normal = (ray.way - half_chord * direction) / radius_m;
  ray.slope = -normal * (radius_m / half_chord);
  ray.radius_slope = -radius_m / half_chord;
  return ray;
}

struct SphereFit {
  Vector3d centre = Vector3d::Zero();
  Matrix4d normal = Matrix4d::Zero();  ///< centre and radius
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  std::size_t points = 0;
  double rms_m = 0.0;
};

/// Sums over the face's points that are off by less than `within_m`.
SphereFit sums_at(const Vector3d& centre, std::span<const Vector3d> points, double radius_m,
                  double within_m) {
  SphereFit fit;
  fit.centre = centre;
  double squares = 0.0;
  for (const Vector3d& point : points) {
    const SphereRay ray = ray_at(point, centre, radius_m);
    if (ray.aside >= kFace || std::abs(ray.beyond_m) > within_m) continue;
    Eigen::Vector4d row;
    row << ray.slope, ray.radius_slope;
    fit.normal += row * row.transpose();
    fit.right += ray.beyond_m * row;
    squares += ray.beyond_m * ray.beyond_m;
    ++fit.points;
  }
  if (fit.points > 0) fit.rms_m = std::sqrt(squares / static_cast<double>(fit.points));
  return fit;
}

/// Least squares with fixed radius, within bounds that narrow.
std::optional<SphereFit> settled(Vector3d centre, std::span<const Vector3d> points, double radius_m,
                                 std::size_t least) {
  double within_m = 0.4 * radius_m;
  for (int step = 0; step < 12; ++step) {
    const SphereFit fit = sums_at(centre, points, radius_m, within_m);
    if (fit.points < least || (step > 2 && fit.rms_m > kMostUneven * radius_m)) return std::nullopt;
    const Vector3d move =
        solve_symmetric(Matrix3d(fit.normal.topLeftCorner<3, 3>()), Vector3d(fit.right.head<3>()));
    if (!(move.norm() < radius_m)) return std::nullopt;
    centre += move;
    const double bound = std::max(3.5 * fit.rms_m, 3.5 * kLeastRangeNoiseM);
    if (step > 3 && move.norm() < 1e-6 && bound >= within_m) break;
    within_m = std::min(within_m, bound);
  }
  const SphereFit fit = sums_at(centre, points, radius_m, within_m);
  if (fit.points < least || fit.rms_m > kMostUneven * radius_m) return std::nullopt;
  return fit;
}

/// What is seen in the parts of a sphere's face and beside it.
class SphereFace {
 public:
  SphereFace(const SphereFit& fit, std::span<const Vector3d> points, double radius_m)
      : rms_m_(std::max(fit.rms_m, kLeastRangeNoiseM)) {
    const Vector3d across = fit.centre.unitOrthogonal();
    const Vector3d other = fit.centre.normalized().cross(across);
    for (const Vector3d& point : points) {
      const SphereRay ray = ray_at(point, fit.centre, radius_m);
      if (ray.aside >= kFace) {
        if (ray.aside > 1.15 && ray.aside < 1.4) beside(ray.beyond_m, radius_m);
        continue;
      }
      if (std::abs(ray.beyond_m) > 4.0 * rms_m_) {
        if (ray.beyond_m > -radius_m) ++(ray.beyond_m > 0.0 ? through_ : before_);
        continue;  // else it is hidden there
      }
      const double turn = std::atan2(ray.way.dot(other), ray.way.dot(across)) / (2.0 * std::numbers::pi);
      const auto sector = std::min<std::size_t>(
          kSectors - 1, static_cast<std::size_t>((turn + 0.5) * static_cast<double>(kSectors)));
      Part& part = parts_[sector + (ray.aside < kInnerFace ? 0 : kSectors)];
      ++part.count;
      part.sum_m += ray.beyond_m;
      ++on_;
    }
  }

  /// Whether it is a ball: round in every part that is seen, in sight by a half, with air beside it.
  [[nodiscard]] bool ball() const {
    if (through_ > 0.03 * on_ || before_ > 0.1 * on_) return false;
    if (beside_ < 6.0 || level_ > 0.5 * beside_) return false;
    return round() && parts_in_sight() >= kSectors;
  }

 private:
  struct Part {
    double count = 0.0;
    double sum_m = 0.0;
  };

  void beside(double beyond_m, double radius_m) {
    ++beside_;
    if (beyond_m < 0.5 * radius_m && beyond_m > -1.2 * radius_m) ++level_;
  }

  /// The means of the parts scatter as noise makes them: chi square of nine freedoms.
  [[nodiscard]] bool round() const {
    constexpr double kChiSquareBound = 27.9;  // exceeded once in a thousand
    double chi_square = 0.0;
    for (const Part& part : parts_) {
      if (part.count == 0.0) continue;
      const double mean = part.sum_m / part.count;
      chi_square += mean * mean / (rms_m_ * rms_m_ / part.count + kUnevenM * kUnevenM);
    }
    return chi_square < kChiSquareBound;
  }

  [[nodiscard]] std::size_t parts_in_sight() const {
    std::array<double, 2 * kSectors> counts{};
    for (std::size_t k = 0; k < parts_.size(); ++k) counts[k] = parts_[k].count;
    std::sort(counts.begin(), counts.end());
    const double usual = counts[counts.size() * 3 / 4];
    return static_cast<std::size_t>(
        std::count_if(counts.begin(), counts.end(), [&](double count) { return count >= 0.4 * usual; }));
  }

  double rms_m_;
  std::array<Part, 2 * kSectors> parts_{};
  double on_ = 0.0, through_ = 0.0, before_ = 0.0, beside_ = 0.0, level_ = 0.0;
};

/// Whether the points have the radius by themselves.
bool has_radius(const SphereFit& fit, double radius_m) {
  const double noise_m = std::max(fit.rms_m, kLeastRangeNoiseM);
  const double off_m = solve_symmetric(fit.normal, fit.right)[3];
  const double sigma_m = noise_m * std::sqrt(std::max(0.0, inverse_of(fit.normal)(3, 3)));
  return sigma_m < kMostFreeSigma * radius_m && std::abs(off_m) < kRadiusM + 3.0 * sigma_m;
}

/// Whether the surface about a point is flat: a sphere's leaves its plane by 0.117 radii, root mean square.
bool flat_about(const Vector3d& point, std::span<const Vector3d> about, double radius_m) {
  constexpr double kFlat = 0.07;
  const double within = 0.81 * radius_m * radius_m;
  PointMoments moments;
  for (const Vector3d& other : about) {
    const Vector3d off = other - point;
    if (off.squaredNorm() < within) moments.add(off);
  }
  if (moments.count < 6.0) return true;
  return spectrum_of(moments.covariance()).values[0] < kFlat * kFlat * radius_m * radius_m;
}

}  // namespace

std::optional<SphereGuess> guess_sphere(const Vector3d& front, std::span<const Vector3d> about,
                                        double radius_m) {
  constexpr std::size_t kLeast = 10;
  if (flat_about(front, about, radius_m)) return std::nullopt;
  const std::optional<SphereFit> fit =
      settled(front + radius_m * front.normalized(), about, radius_m, kLeast);
  if (!fit) return std::nullopt;
  return SphereGuess{fit->centre, fit->rms_m, fit->points};
}

std::optional<FoundTarget> fit_sphere(const Vector3d& start, std::span<const Vector3d> points,
                                      double radius_m) {
  const std::optional<SphereFit> fit = settled(start, points, radius_m, kLeastPoints);
  if (!fit) return std::nullopt;
  if (!has_radius(*fit, radius_m) || !SphereFace(*fit, points, radius_m).ball()) return std::nullopt;
  const double noise_m = std::max(fit->rms_m, kLeastRangeNoiseM);
  const Matrix3d covariance = inverse_of(Matrix3d(fit->normal.topLeftCorner<3, 3>()));
  const double sigma_m = std::hypot(noise_m * std::sqrt(spectrum_of(covariance).values[2]), kTargetMakeM);
  if (!(sigma_m <= kMostTargetSigmaM)) return std::nullopt;
  return FoundTarget{TargetKind::sphere, fit->centre, sigma_m, fit->points};
}

}  // namespace limen
