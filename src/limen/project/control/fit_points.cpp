// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/fit_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr std::size_t kMostTriples = 600;
constexpr double kLeastRootM = 0.05;   // of a triple: the second largest spread, else it is nearly a line
constexpr double kFitFixedRad = 0.01;  // a turn that is known less well is open
constexpr double kFitFixedM = 0.1;     // a shift likewise
constexpr int kSteps = 8;

using Taken = std::vector<bool>;

/// A pose, what it fits, and how well.
struct Candidate {
  Rigid3 pose;
  Matrix6d covariance = Matrix6d::Identity();  ///< turn about `centre`, shift; target axes
  Vector3d centre = Vector3d::Zero();
  Taken taken;
  std::size_t count = 0;
  double chi_square = 0.0;
};

class PointFitter {
 public:
  explicit PointFitter(const std::vector<PointPair>& pairs) : pairs_(pairs) {}

  PointFit run() {
    PointFit fit;
    fit.taken.assign(pairs_.size(), false);
    const std::vector<Candidate> all = candidates();
    if (all.empty()) return fit;
    const Candidate* best = &all.front();
    for (const Candidate& other : all) {
      if (better(other, *best)) best = &other;
    }
    fit.suspects = suspects(all, *best);
    Candidate kept = *best;
    if (!fit.suspects.empty()) {
      // What remains without them must hold on its own.
      for (const std::size_t k : fit.suspects) kept.taken[k] = false;
      const std::optional<Candidate> rest = best->count < 3 ? std::optional<Candidate>() : fitted(kept.taken);
      if (!rest || rest->count <= 3 || !agrees(*rest)) {
        fit.state = PointFitState::contradictory;
        if (best->count >= 3) {
          fit.taken = best->taken;
          fit.pose = {best->pose, best->covariance, best->centre, 0.0};
        }
        return fit;
      }
      kept = *rest;
    }
    fit.chi_square = kept.chi_square;
    fit.redundancy = 3 * static_cast<int>(kept.count) - 6;
    fit.taken = kept.taken;
    fit.pose = {kept.pose, kept.covariance, kept.centre, 0.0};
    const Vector6d variances = kept.covariance.diagonal();
    const bool turns = variances.head<3>().maxCoeff() < kFitFixedRad * kFitFixedRad;
    if (turns && variances.tail<3>().maxCoeff() < kFitFixedM * kFitFixedM) fit.state = PointFitState::fixed;
    return fit;
  }

 private:
  static bool better(const Candidate& a, const Candidate& b) {
    return a.count != b.count ? a.count > b.count : a.chi_square < b.chi_square;
  }

  /// Every set of pairs that some three of them lead to, once.
  [[nodiscard]] std::vector<Candidate> candidates() const {
    std::vector<Candidate> all;
    const std::size_t n = pairs_.size();
    const std::size_t triples = n < 3 ? 0 : n * (n - 1) * (n - 2) / 6;
    const std::size_t stride = std::max<std::size_t>(1, triples / kMostTriples);
    std::size_t number = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) {
          if (number++ % stride != 0) continue;
          std::optional<Candidate> found = from_triple({i, j, k});
          if (!found) continue;
          const bool known = std::any_of(all.begin(), all.end(),
                                         [&](const Candidate& other) { return other.taken == found->taken; });
          if (!known) all.push_back(std::move(*found));
        }
      }
    }
    return all;
  }

  [[nodiscard]] std::optional<Candidate> from_triple(const std::vector<std::size_t>& three) const {
    Taken taken(pairs_.size(), false);
    for (const std::size_t k : three) taken[k] = true;
    std::optional<Candidate> fit = fitted(taken);
    if (!fit) return {};
    // What agrees joins, and the fit is made anew, until nothing changes.
    for (int round = 0; round < 4; ++round) {
      const Taken agreeing = agreeing_with(*fit);
      if (agreeing == fit->taken) break;
      std::optional<Candidate> next = fitted(agreeing);
      if (!next) break;
      fit = std::move(next);
    }
    if (!agrees(*fit)) fit->count = 0;
    return fit;
  }

  /// The set agrees as a whole: chi square's bound, once in a thousand, nearly.
  [[nodiscard]] static bool agrees(const Candidate& fit) {
    const double freedoms = 3.0 * static_cast<double>(fit.count) - 6.0;
    return fit.chi_square <= freedoms + 3.1 * std::sqrt(2.0 * freedoms) + 6.0;
  }

  [[nodiscard]] Taken agreeing_with(const Candidate& fit) const {
    Taken agreeing(pairs_.size(), false);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const PointPair& pair = pairs_[k];
      const Vector3d miss = fit.pose * pair.x_in_source - pair.x_in_target;
      Matrix3d sum = covariance_of(pair, fit.pose.rotation);
      if (!fit.taken[k]) sum += of_pose(fit, pair);
      agreeing[k] = miss.dot(solve_symmetric(sum, miss)) <= kPointChiSquareBound;
    }
    return agreeing;
  }

  [[nodiscard]] static Matrix3d of_pose(const Candidate& fit, const PointPair& pair) {
    Eigen::Matrix<double, 3, 6> j;
    j << -skew(fit.pose * pair.x_in_source - fit.centre), Matrix3d::Identity();
    return j * fit.covariance * j.transpose();
  }

  static Matrix3d covariance_of(const PointPair& pair, const Matrix3d& rotation) {
    return pair.target_covariance + rotation * pair.source_covariance * rotation.transpose();
  }

  /// Least squares over some pairs; empty where they lie on a line.
  [[nodiscard]] std::optional<Candidate> fitted(const Taken& taken) const {
    Candidate fit;
    fit.taken = taken;
    fit.count = static_cast<std::size_t>(std::count(taken.begin(), taken.end(), true));
    if (fit.count < 3 || !start(fit)) return {};
    for (int step = 0; step < kSteps; ++step) {
      Matrix6d normal = Matrix6d::Zero();
      Vector6d right = Vector6d::Zero();
      fit.chi_square = 0.0;
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        if (!taken[k]) continue;
        const PointPair& pair = pairs_[k];
        const Matrix3d weight = inverse_of(covariance_of(pair, fit.pose.rotation));
        const Vector3d at = fit.pose * pair.x_in_source;
        const Vector3d miss = at - pair.x_in_target;
        Eigen::Matrix<double, 3, 6> j;
        j << -skew(at - fit.centre), Matrix3d::Identity();
        normal += j.transpose() * weight * j;
        right -= j.transpose() * weight * miss;
        fit.chi_square += miss.dot(weight * miss);
      }
      fit.covariance = inverse_of(normal);
      const Vector6d move = fit.covariance * right;
      const Matrix3d turn = rotation_exp(move.head<3>());
      fit.pose.translation = turn * (fit.pose.translation - fit.centre) + fit.centre + move.tail<3>();
      fit.pose.rotation = nearest_rotation(turn * fit.pose.rotation);
    }
    if (!fit.covariance.allFinite()) return {};
    return fit;
  }

  /// The unweighted fit (Umeyama 1991, eq. 40-42 without scale).
  [[nodiscard]] bool start(Candidate& fit) const {
    Vector3d source = Vector3d::Zero();
    Vector3d target = Vector3d::Zero();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!fit.taken[k]) continue;
      source += pairs_[k].x_in_source / static_cast<double>(fit.count);
      target += pairs_[k].x_in_target / static_cast<double>(fit.count);
    }
    Matrix3d mixed = Matrix3d::Zero();
    Matrix3d spread = Matrix3d::Zero();
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!fit.taken[k]) continue;
      const Vector3d a = pairs_[k].x_in_source - source;
      mixed += (pairs_[k].x_in_target - target) * a.transpose();
      spread += a * a.transpose() / static_cast<double>(fit.count);
    }
    if (spectrum_of(spread).values[1] < kLeastRootM * kLeastRootM) return false;
    fit.pose.rotation = nearest_rotation(mixed);
    fit.pose.translation = target - fit.pose.rotation * source;
    fit.centre = target;
    return true;
  }

  /// What one set takes and another, as large and nearly as good, does not.
  [[nodiscard]] std::vector<std::size_t> suspects(const std::vector<Candidate>& all,
                                                  const Candidate& best) const {
    Taken doubtful(pairs_.size(), best.count < 3);
    for (const Candidate& other : all) {
      if (other.count < best.count || other.count < 3 || other.chi_square - best.chi_square > kTellingApart)
        continue;
      for (std::size_t k = 0; k < pairs_.size(); ++k) {
        if (other.taken[k] != best.taken[k]) doubtful[k] = true;
      }
    }
    std::vector<std::size_t> list;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (doubtful[k]) list.push_back(k);
    }
    return list;
  }

  const std::vector<PointPair>& pairs_;
};

}  // namespace

PointFit fit_points(const std::vector<PointPair>& pairs) {
  return PointFitter(pairs).run();
}

}  // namespace limen
