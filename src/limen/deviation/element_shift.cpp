// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/element_shift.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kBinM = 0.001;
constexpr std::ptrdiff_t kSmooth = 4;   // bins either way
constexpr double kLeastWidthM = 0.006;  // of the peak, either way
constexpr int kRounds = 6;
constexpr double kFaceSigmaM = 0.003;     // flatness of built surfaces: a face is known no better
constexpr double kContestedWeight = 0.1;  // (3 mm / 10 mm)^2: it may be another face's surface
constexpr double kRobustM = 0.008;        // faces that differ by more from the shift count less
constexpr double kMostPoints = 2000.0;    // more points do not make a face more certain
constexpr double kAcross = 0.5;           // cosine: a face across a direction
constexpr double kNear = 0.95;            // cosine: a face across the direction itself
constexpr double kSmallFace = 0.2;        // of the largest one's weight: it does not tell the direction
constexpr double kMostNoise = 1.8;        // of a typical face's: one that scatters more is no plane
constexpr double kHeldShare = 0.02;       // of the points' evidence that must hold a direction of a shift
constexpr std::size_t kHeldPoints = 300;  // and so many points on faces across it
constexpr double kMostSigmaM = 0.004;     // a direction known less well is open

/// Start of the peak: middle of the fullest window.
double peak_of(const std::vector<float>& distances, double most) {
  const auto half = static_cast<std::ptrdiff_t>(std::ceil(most / kBinM));
  const std::ptrdiff_t size = 2 * half + 1;
  std::vector<int> bins(static_cast<std::size_t>(size), 0);
  for (const float d : distances) {
    const auto bin = static_cast<std::ptrdiff_t>(std::lround(static_cast<double>(d) / kBinM)) + half;
    ++bins[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(bin, 0, size - 1))];
  }
  std::ptrdiff_t best = half;
  int fullest = -1;
  int sum = 0;
  for (std::ptrdiff_t k = -kSmooth; k < size; ++k) {
    // The window about k: one bin enters, one leaves. Of equally full ones the nearest to the face counts.
    if (k + kSmooth < size) sum += bins[static_cast<std::size_t>(k + kSmooth)];
    if (k - kSmooth - 1 >= 0) sum -= bins[static_cast<std::size_t>(k - kSmooth - 1)];
    const bool nearer = sum == fullest && std::abs(k - half) < std::abs(best - half);
    if (k < 0 || (sum <= fullest && !nearer)) continue;
    fullest = sum;
    best = k;
  }
  return static_cast<double>(best - half) * kBinM;
}

double weight_of(const FaceOffset& face) {
  const double points = std::min(static_cast<double>(face.points), kMostPoints);
  return face.contested ? kContestedWeight * points : points;
}

/// The same of one scan's view: its pose errs as well as the face.
double weight_in_frame(const FaceOffset& face) {
  const double pose = face.pose_sigma_m / kFaceSigmaM;
  return weight_of(face) / (1.0 + pose * pose);
}

double tukey(double residual, double width) {
  const double x = residual / width;
  return std::abs(x) >= 1.0 ? 0.0 : (1.0 - x * x) * (1.0 - x * x);
}

/// Where half of the weight is reached.
double weighted_median(const std::vector<FaceOffset>& faces) {
  std::vector<std::pair<double, double>> sorted;
  double total = 0.0;
  for (const FaceOffset& face : faces) {
    sorted.emplace_back(face.offset_m, weight_in_frame(face));
    total += sorted.back().second;
  }
  std::sort(sorted.begin(), sorted.end());
  double passed = 0.0;
  for (const auto& [offset, weight] : sorted) {
    passed += weight;
    if (2.0 * passed >= total) return offset;
  }
  return 0.0;
}

/// Normal equations of a shift.
struct Sums {
  Matrix3d information = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double squares = 0.0;
  double weight = 0.0;
};

Sums sums_at(const std::vector<FaceOffset>& faces, const Vector3d& shift, double width) {
  Sums sums;
  for (const FaceOffset& face : faces) {
    const double residual = face.offset_m - face.normal.dot(shift);
    const double weight = weight_of(face) * tukey(residual, width);
    sums.information += weight * face.normal * face.normal.transpose();
    sums.right += weight * residual * face.normal;
    sums.squares += weight * residual * residual;
    sums.weight += weight;
  }
  return sums;
}

/// The normal of the faces that stand across a direction, near it. A direction between that of large faces
/// and that of small ones would tell a part of a movement that only the small ones could.
Vector3d normal_near(const std::vector<FaceOffset>& faces, const Vector3d& direction) {
  Vector3d sum = Vector3d::Zero();
  double largest = 0.0;
  for (const FaceOffset& face : faces) {
    if (std::abs(face.normal.dot(direction)) > kNear) largest = std::max(largest, weight_of(face));
  }
  for (const FaceOffset& face : faces) {
    const double along = face.normal.dot(direction);
    if (std::abs(along) <= kNear || weight_of(face) < kSmallFace * largest) continue;
    sum += weight_of(face) * (along < 0.0 ? Vector3d(-face.normal) : face.normal);
  }
  return sum.norm() > 0.0 ? Vector3d(sum.normalized()) : direction;
}

/// What is left of a vector across others of unit length.
Vector3d across(Vector3d vector, const std::vector<Vector3d>& others) {
  for (const Vector3d& other : others) vector -= other.dot(vector) * other;
  return vector.normalized();
}

/// Directions that enough points hold, as an orthonormal basis; the others go to `open`.
std::vector<Vector3d> held_directions(const std::vector<FaceOffset>& faces, std::vector<Vector3d>& open) {
  Matrix3d information = Matrix3d::Zero();
  for (const FaceOffset& face : faces) information += weight_of(face) * face.normal * face.normal.transpose();
  const Spectrum3 spectrum = spectrum_of(information);
  std::vector<Vector3d> held;
  for (Eigen::Index k = 2; k >= 0; --k) {
    Vector3d direction = spectrum.vectors.col(k);
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    if (direction[largest] < 0.0) direction = -direction;
    std::size_t points = 0;
    for (const FaceOffset& face : faces)
      points += std::abs(face.normal.dot(direction)) > kAcross ? face.points : 0;
    const bool enough = spectrum.values[k] > kHeldShare * information.trace() && points >= kHeldPoints;
    if (enough) {
      held.push_back(across(normal_near(faces, direction), held));
    } else {
      open.push_back(direction);
    }
  }
  std::vector<Vector3d> all = held;
  for (Vector3d& direction : open) {
    direction = across(direction, all);
    all.push_back(direction);
  }
  return held;
}

}  // namespace

FaceOffset face_offset(const Vector3d& normal, const std::vector<float>& distances_m, double max_distance_m) {
  FaceOffset face;
  face.normal = normal;
  if (distances_m.empty()) return face;
  double middle = peak_of(distances_m, max_distance_m);
  double width = 2.0 * kLeastWidthM;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    double squares = 0.0;
    std::size_t count = 0;
    for (const float d : distances_m) {
      const double off = static_cast<double>(d) - middle;
      if (std::abs(off) > width) continue;
      sum += off;
      squares += off * off;
      ++count;
    }
    if (count == 0) break;
    const double mean = sum / static_cast<double>(count);
    middle += mean;
    face.sigma_m = std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean * mean));
    face.points = count;
    width = std::max(kLeastWidthM, 3.0 * face.sigma_m);
  }
  face.offset_m = middle;
  return face;
}

FaceOffset joined_offset(const std::vector<FaceOffset>& by_scan) {
  FaceOffset all;
  if (by_scan.empty()) return all;
  all.normal = by_scan.front().normal;
  all.offset_m = weighted_median(by_scan);
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    double squares = 0.0;
    double weights = 0.0;
    double contested = 0.0;
    all.points = 0;
    for (const FaceOffset& face : by_scan) {
      const double off = face.offset_m - all.offset_m;
      // A pose that is known worse may be off by more.
      const double weight = weight_in_frame(face) * tukey(off, std::hypot(kRobustM, 3.0 * face.pose_sigma_m));
      if (weight <= 0.0) continue;
      all.points += face.points;
      sum += weight * off;
      squares += weight * face.sigma_m * face.sigma_m;
      weights += weight;
      contested += face.contested ? weight : 0.0;
    }
    if (weights <= 0.0) break;
    all.offset_m += sum / weights;
    all.sigma_m = std::sqrt(squares / weights);
    all.contested = 2.0 * contested > weights;
  }
  return all;
}

void contest_scattered(std::vector<FaceOffset>& faces) {
  std::vector<std::pair<double, std::size_t>> sigmas;
  std::size_t total = 0;
  for (const FaceOffset& face : faces) {
    if (face.points == 0) continue;
    sigmas.emplace_back(face.sigma_m, face.points);
    total += face.points;
  }
  std::sort(sigmas.begin(), sigmas.end());
  std::size_t passed = 0;
  double typical = 0.0;
  for (const auto& [sigma, points] : sigmas) {
    passed += points;
    if (2 * passed < total) continue;
    typical = sigma;
    break;
  }
  for (FaceOffset& face : faces) face.contested = face.contested || face.sigma_m > kMostNoise * typical;
}

namespace {

using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// The shift within some directions, and its covariance in them.
struct ShiftFit {
  Vector3d shift = Vector3d::Zero();
  Eigen::MatrixXd covariance;
};

ShiftFit fit_within(const Basis& basis, const std::vector<FaceOffset>& faces, double widest) {
  ShiftFit fit;
  // From wide to narrow: the first round is plain least squares over all faces within reach.
  double width = widest;
  Sums sums;
  Eigen::MatrixXd small;
  for (int round = 0; round < 2 * kRounds; ++round) {
    sums = sums_at(faces, fit.shift, width);
    small = basis.transpose() * sums.information * basis;
    small.diagonal().array() += 1e-9 * sums.information.trace() + 1e-12;
    fit.shift += basis * solve_symmetric(small, Eigen::VectorXd(basis.transpose() * sums.right));
    width = std::max(kRobustM, 0.6 * width);
  }
  // A face is one observation, good to its flatness, or to how the faces disagree.
  const double scatter = sums.weight > 0.0 ? sums.squares / sums.weight : 0.0;
  double largest = 0.0;
  for (const FaceOffset& face : faces)
    largest = std::max(largest, std::min(static_cast<double>(face.points), kMostPoints));
  fit.covariance = (scatter + kFaceSigmaM * kFaceSigmaM) * largest * inverse_of(small);
  return fit;
}

Basis basis_of(const std::vector<Vector3d>& directions) {
  Basis basis(3, static_cast<Eigen::Index>(directions.size()));
  for (std::size_t k = 0; k < directions.size(); ++k) basis.col(static_cast<Eigen::Index>(k)) = directions[k];
  return basis;
}

}  // namespace

ElementShift shift_of(const std::vector<FaceOffset>& faces, const DeviationOptions& options) {
  ElementShift result;
  std::vector<Vector3d> held = held_directions(faces, result.open);
  // Directions that the faces hold too loosely are open too, the loosest first.
  while (!held.empty()) {
    const Basis basis = basis_of(held);
    const ShiftFit fit = fit_within(basis, faces, 3.0 * options.max_distance_m);
    Eigen::Index loosest = 0;
    const double variance = fit.covariance.diagonal().maxCoeff(&loosest);
    if (variance <= kMostSigmaM * kMostSigmaM) {
      result.shift_m = fit.shift;
      result.sigma_m = (basis * fit.covariance * basis.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
      break;
    }
    result.open.push_back(held[static_cast<std::size_t>(loosest)]);
    held.erase(held.begin() + loosest);
  }
  result.held = static_cast<int>(held.size());
  return result;
}

}  // namespace limen
