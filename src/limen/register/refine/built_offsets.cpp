// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/refine/built_offsets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace limen {
namespace {

constexpr double kBuilderErrsM = 0.003;      // how far a wall is from the drawing, beforehand: 1 sigma
constexpr double kMostBuilderErrsM = 0.006;  // what is off by more was moved
constexpr double kBuildersStrength = 4.0;    // in planes
constexpr double kMovedShare = 0.1;          // of planes, presumed
constexpr double kMovedM = 0.03;             // by so much, 1 sigma
constexpr double kOtherSlope = 0.02;         // of what is another surface; there are as many of these
constexpr std::size_t kStarts = 16;          // planes that may be right against the others, the largest
constexpr int kMostRounds = 60;
constexpr double kStepDone = 1e-7;  // m and radians

/// One error of a plane, integrated out.
struct Integrated {
  Matrix3d gain = Matrix3d::Zero();
  double log_determinant = 0.0;

  Integrated(const PlaneSums& plane, const PlaneErrors& errors, double factor) {
    const Vector3d sizes(errors.offset_m, errors.slope, errors.slope);
    const Matrix3d scaled =
        Matrix3d::Identity() + Matrix3d(sizes.asDiagonal() * plane.common * sizes.asDiagonal() / factor);
    gain = sizes.asDiagonal() * inverse_of(scaled) * sizes.asDiagonal() / (factor * factor);
    log_determinant = std::log(std::max(1e-300, scaled.determinant()));
  }
};

/// A local maximum of the likelihood.
struct Mode {
  Vector6d step = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
  std::vector<double> moved;
  double log_likelihood = 0.0;
};

class Settling {
 public:
  Settling(const std::vector<PlaneSums>& planes, double slope, double factor, const Matrix6d& stay)
      : planes_(planes), slope_(slope), factor_(factor), stay_(stay) {
    for (const PlaneSums& plane : planes)
      moved_.push_back(
          {Integrated(plane, {kMovedM, slope}, factor), Integrated(plane, {kMovedM, kOtherSlope}, factor)});
  }

  [[nodiscard]] Mode from(const Vector6d& start) const {
    Mode mode;
    mode.step = start;
    mode.moved.assign(planes_.size(), 0.0);
    double err_m = kBuilderErrsM;
    for (int round = 0; round < kMostRounds; ++round) {
      const Vector6d before = mode.step;
      err_m = improve(err_m, mode);
      if ((mode.step - before).lpNorm<Eigen::Infinity>() < kStepDone) break;
    }
    return mode;
  }

 private:
  /// What a plane is, at one pose.
  struct Answer {
    Matrix3d gain = Matrix3d::Zero();  ///< mean of all kinds
    double moved = 0.0;                ///< probability of the kinds but the first
    double log_likelihood = 0.0;
  };

  [[nodiscard]] Answer answer_of(std::size_t k, const Vector3d& residuals, double err_m) const {
    const std::array<Integrated, 3> kinds{Integrated(planes_[k], {err_m, slope_}, factor_), moved_[k][0],
                                          moved_[k][1]};
    std::array<double, 3> nats{std::log(1.0 - 2.0 * kMovedShare), std::log(kMovedShare),
                               std::log(kMovedShare)};
    for (std::size_t i = 0; i < kinds.size(); ++i)
      nats[i] += 0.5 * residuals.dot(kinds[i].gain * residuals) - 0.5 * kinds[i].log_determinant;
    const double most = *std::max_element(nats.begin(), nats.end());
    double sum = 0.0;
    for (const double one : nats) sum += std::exp(one - most);
    Answer answer;
    answer.log_likelihood = most + std::log(sum);
    for (std::size_t i = 0; i < kinds.size(); ++i)
      answer.gain += std::exp(nats[i] - answer.log_likelihood) * kinds[i].gain;
    answer.moved = 1.0 - std::exp(nats[0] - answer.log_likelihood);
    return answer;
  }

  /// One step of expectation and maximisation; returns what builders err, as these planes show it.
  double improve(double err_m, Mode& mode) const {
    const Vector6d x = mode.step;
    mode.information = stay_;
    mode.log_likelihood = -0.5 * x.dot(stay_ * x);
    Vector6d right = Vector6d::Zero();
    double squares = kBuildersStrength * kBuilderErrsM * kBuilderErrsM;
    double count = kBuildersStrength;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const PlaneSums& plane = planes_[k];
      const Vector3d residuals = plane.residuals - plane.shared.transpose() * x;
      const Answer answer = answer_of(k, residuals, err_m);
      mode.moved[k] = answer.moved;
      mode.information += plane.counts * (plane.information / factor_ -
                                          plane.shared * answer.gain * plane.shared.transpose());
      right += plane.counts * (plane.right / factor_ - plane.shared * answer.gain * plane.residuals);
      mode.log_likelihood +=
          plane.counts *
          (answer.log_likelihood -
           0.5 * (plane.squares - 2.0 * plane.right.dot(x) + x.dot(plane.information * x)) / factor_);
      // What is expected of the square of its offset, by how well the offset is known.
      const double offset_m = residuals[0] / plane.weight;
      const double known = err_m * err_m / (err_m * err_m + factor_ / plane.weight);
      squares += plane.counts * (1.0 - answer.moved) *
                 (known * known * offset_m * offset_m + (1.0 - known) * err_m * err_m);
      count += plane.counts * (1.0 - answer.moved);
    }
    mode.step = solve_symmetric(mode.information, right);
    return std::clamp(std::sqrt(squares / std::max(1.0, count - 3.0)), kLeastBuilderErrsM, kMostBuilderErrsM);
  }

  const std::vector<PlaneSums>& planes_;
  double slope_;
  double factor_;
  Matrix6d stay_;
  std::vector<std::array<Integrated, 2>> moved_;  ///< of each plane: moved, another surface
};

/// Planes that were moved under a mode, the largest first.
std::vector<std::size_t> moved_planes(const std::vector<PlaneSums>& planes, const Mode& mode) {
  std::vector<std::size_t> moved;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const double offset_m =
        std::abs(planes[k].mean_m() - planes[k].shared.col(0).dot(mode.step) / planes[k].weight);
    if (offset_m > kMostBuilderErrsM) moved.push_back(k);
  }
  std::stable_sort(moved.begin(), moved.end(),
                   [&](std::size_t a, std::size_t b) { return planes[a].weight > planes[b].weight; });
  moved.resize(std::min(moved.size(), kStarts));
  return moved;
}

}  // namespace

Matrix6d damped_inverse(const Matrix6d& information) {
  return inverse_of(Matrix6d(information + 1e-6 * Matrix6d::Identity()));
}

Matrix6d information_of(const PlaneSums& plane, const PlaneErrors& errors, double factor) {
  return plane.information / factor -
         plane.shared * Integrated(plane, errors, factor).gain * plane.shared.transpose();
}

SettledPose settle_among_moved(const std::vector<PlaneSums>& planes, double slope, double factor,
                               const Matrix6d& stay) {
  const Settling settling(planes, slope, factor, stay);
  std::vector<Mode> modes{settling.from(Vector6d::Zero())};
  for (const std::size_t k : moved_planes(planes, modes.front())) {
    // As if this plane, of all that are off, were right: shifted along its normal.
    Vector6d start = modes.front().step;
    const Vector6d row = planes[k].shared.col(0) / planes[k].weight;
    start.tail<3>() += (planes[k].mean_m() - row.dot(start)) * row.tail<3>();
    Mode mode = settling.from(start);
    const bool known = std::any_of(modes.begin(), modes.end(), [&](const Mode& other) {
      return (other.step - mode.step).lpNorm<Eigen::Infinity>() < 0.1 * kLeastBuilderErrsM;
    });
    if (!known) modes.push_back(std::move(mode));
  }
  std::vector<Matrix6d> covariances;
  std::vector<double> weights;
  for (const Mode& mode : modes) {
    covariances.push_back(damped_inverse(mode.information));
    weights.push_back(mode.log_likelihood + 0.5 * log_determinant_of(covariances.back()));
  }
  const std::size_t best =
      static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  const double most = weights[best];
  for (double& weight : weights) weight = std::exp(weight - most);
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  Matrix6d covariance = Matrix6d::Zero();
  Matrix6d spread = Matrix6d::Zero();
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const Vector6d off = modes[k].step - modes[best].step;
    covariance += weights[k] / all * (covariances[k] + off * off.transpose());
    const Vector6d off_first = modes[k].step - modes.front().step;
    spread += weights[k] / all * off_first * off_first.transpose();
  }
  const Matrix6d information = modes.size() == 1 ? modes[best].information : inverse_of(covariance);
  return {modes[best].step, information, modes[best].moved, spread};
}

}  // namespace limen
