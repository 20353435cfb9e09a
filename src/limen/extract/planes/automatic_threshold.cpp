// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/automatic_threshold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "limen/base/drawn_steps.h"

namespace limen {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double to_log10(double natural) {
  return natural / std::log(10.0);
}

/// Equation 5 for an area of a plane: the share of the cloud's box that its slab takes, clamped to [0, 1].
double slab_share(const CloudSize& cloud, double area_m2, double threshold_m) {
  // A cloud thinner than the slab has at least the slab's thickness.
  const Vector3d sides = cloud.extent_m.cwiseMax(2.0 * threshold_m);
  return std::clamp(2.0 * threshold_m * area_m2 / sides.prod(), 0.0, 1.0);
}

/// Natural logarithm of P[B(n, p) >= k], exact sum. n is the number of possible planes: thousands at most.
double log_binomial_tail(std::size_t n, std::size_t k, double p) {
  if (k > n) return -kInfinity;
  if (k == 0 || p >= 1.0) return 0.0;
  if (p <= 0.0) return -kInfinity;
  const double odds = std::log(p) - std::log1p(-p);
  double log_choose = 0.0;
  double largest = -kInfinity;
  std::vector<double> terms;
  for (std::size_t j = 0; j <= n; ++j) {
    if (j > 0) log_choose += std::log(static_cast<double>(n - j + 1)) - std::log(static_cast<double>(j));
    if (j < k) continue;
    terms.push_back(log_choose + static_cast<double>(j) * odds + static_cast<double>(n) * std::log1p(-p));
    largest = std::max(largest, terms.back());
  }
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - largest);
  return std::min(0.0, largest + std::log(sum));
}

/// Upper bound of the same for large n: exp(-n KL(k/n || p)) where k exceeds the expectation, else 1.
double log_tail_bound(double n, double k, double p) {
  const double share = std::min(1.0, k / n);
  if (share <= p) return 0.0;
  if (p <= 0.0) return -kInfinity;
  const double rest = share < 1.0 ? (1.0 - share) * std::log((1.0 - share) / (1.0 - p)) : 0.0;
  return -n * (share * std::log(share / p) + rest);
}

double log_tests(const CloudSize& cloud, const ThresholdOptions& options) {
  const auto n = static_cast<double>(cloud.points);
  return std::log(static_cast<double>(options.thresholds_m.size())) +
         std::log(n * (n - 1.0) * (n - 2.0) / 6.0);
}

double score_of(const CloudSize& cloud, const std::vector<DetectedPlane>& planes, double threshold_m,
                const ThresholdOptions& options) {
  if (options.criterion == ThresholdCriterion::published) {
    return published_log10_nfa(cloud, planes.size(), threshold_m, options);
  }
  // Planes that chance would give as well neither help nor harm.
  double total = 0.0;
  for (const DetectedPlane& plane : planes) {
    total += std::min(0.0, plane_log10_nfa(cloud, plane, threshold_m, options));
  }
  return total;
}

bool better(const ThresholdScore& a, const ThresholdScore& b, ThresholdCriterion criterion) {
  if (a.log10_nfa != b.log10_nfa) return a.log10_nfa < b.log10_nfa;
  return criterion == ThresholdCriterion::published && a.planes > b.planes;
}

}  // namespace

double published_log10_nfa(const CloudSize& cloud, std::size_t planes, double threshold_m,
                           const ThresholdOptions& options) {
  const std::size_t possible = cloud.points / options.min_inliers;                    // (3), floor
  const std::size_t missed = possible > planes ? possible - planes : 0;               // K = R - F
  const double share = slab_share(cloud, cloud.extent_m.squaredNorm(), threshold_m);  // (5)
  const double log_probability = log_binomial_tail(missed, planes, share);            // (6)
  return to_log10(std::log(static_cast<double>(options.thresholds_m.size())) + log_probability);  // (4)
}

double plane_log10_nfa(const CloudSize& cloud, const DetectedPlane& plane, double threshold_m,
                       const ThresholdOptions& options) {
  if (cloud.points < 3 || plane.inliers < 3) return 0.0;
  const double area_m2 = plane.area_m2 > 0.0 ? plane.area_m2 : cloud.extent_m.squaredNorm();
  const double share = slab_share(cloud, area_m2, threshold_m);
  // Three of the points made the plane: they prove nothing.
  const double n = std::max(1.0, static_cast<double>(cloud.points) - 3.0);
  const double k = std::min(n, static_cast<double>(plane.inliers) - 3.0);
  return to_log10(log_tests(cloud, options) + log_tail_bound(n, k, share));
}

ThresholdChoice choose_threshold(const CloudSize& cloud, const ThresholdTrial& detector,
                                 const ThresholdOptions& options) {
  ThresholdChoice choice;
  std::size_t best = 0;
  for (const double threshold_m : options.thresholds_m) {
    const std::vector<DetectedPlane> planes = detector(threshold_m);
    choice.scores.push_back({threshold_m, planes.size(), score_of(cloud, planes, threshold_m, options)});
    if (better(choice.scores.back(), choice.scores[best], options.criterion))
      best = choice.scores.size() - 1;
    else if (options.until_worse && choice.scores.size() > 1)
      break;
  }
  choice.threshold_m = choice.scores[best].threshold_m;
  return choice;
}

namespace {

constexpr std::size_t kSubset = 40000;  // about so many points
/// Thresholds tried, as multiples of the one that the noise within small cubes asks for.
constexpr std::array kFactors = {1.0, 1.6, 2.5, 4.0};
constexpr double kMostThresholdM = 0.04;

/// What planes of the subset are grown with.
GrowOptions for_subset(GrowOptions grow) {
  grow.min_inliers = std::max(50, grow.min_inliers / 2);
  return grow;
}

Scan even_subset(const Scan& scan) {
  Scan part;
  part.local_origin = scan.local_origin;
  part.points.reserve(std::min(scan.size(), kSubset));
  for_drawn_steps(scan.size(), kSubset, [&](std::size_t i) { part.points.push_back(scan.points[i]); });
  return part;
}

std::vector<DetectedPlane> detected(const GrownPlanes& grown) {
  std::vector<DetectedPlane> planes(grown.planes.fits.size());
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Vector3d& variances = grown.planes.fits[k].variances;
    planes[k].area_m2 = 12.0 * std::sqrt(variances[1] * variances[2]);
  }
  for (const std::int32_t label : grown.planes.labels) {
    if (label >= 0) ++planes[static_cast<std::size_t>(label)].inliers;
  }
  return planes;
}

}  // namespace

double noise_threshold(const Scan& scan, const GrowOptions& grow, Monitor& monitor) {
  return PlaneGround(even_subset(scan), for_subset(grow)).grow(0.0, monitor).inlier_threshold_m;
}

double automatic_threshold(const Scan& scan, const GrowOptions& grow, Monitor& monitor) {
  const Scan part = even_subset(scan);
  const GrowOptions trial = for_subset(grow);
  const PlaneGround ground(part, trial);
  constexpr double kTrials = 1.0 + static_cast<double>(kFactors.size());
  StagePart first_part(monitor, 0.0, 1.0 / kTrials);
  const GrownPlanes first = ground.grow(0.0, first_part);
  ThresholdOptions choice;
  choice.min_inliers = static_cast<std::size_t>(trial.min_inliers);
  choice.thresholds_m.clear();
  choice.until_worse = true;
  for (const double factor : kFactors) {
    const double threshold = std::min(kMostThresholdM, factor * first.inlier_threshold_m);
    if (choice.thresholds_m.empty() || threshold > choice.thresholds_m.back())
      choice.thresholds_m.push_back(threshold);
  }
  if (choice.thresholds_m.size() < 2 || first.planes.fits.empty()) return first.inlier_threshold_m;
  const Extent extent = extent_of(part.points);
  double tried = 0.0;
  const auto detector = [&](double threshold_m) {
    if (threshold_m == first.inlier_threshold_m) return detected(first);
    tried = std::min(tried + 1.0, kTrials - 1.0);
    StagePart next_part(monitor, tried / kTrials, (tried + 1.0) / kTrials);
    return detected(ground.grow(threshold_m, next_part));
  };
  return choose_threshold({part.size(), extent.high - extent.low}, detector, choice).threshold_m;
}

double a_contrario_threshold(const Scan& scan, const GrowOptions& grow, const ThresholdOptions& choice,
                             Monitor& monitor) {
  const Scan part = even_subset(scan);
  const GrowOptions trial = for_subset(grow);
  ThresholdOptions among = choice;
  among.min_inliers = static_cast<std::size_t>(trial.min_inliers);
  const Extent extent = extent_of(part.points);
  const PlaneGround ground(part, trial);
  const auto detector = [&](double threshold_m) { return detected(ground.grow(threshold_m, monitor)); };
  return choose_threshold({part.size(), extent.high - extent.low}, detector, among).threshold_m;
}

}  // namespace limen
