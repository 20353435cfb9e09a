// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/match_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/project/control/fit_points.h"

namespace limen {
namespace {

constexpr double kLeastApartM = 0.3;  // of the two points that a match begins with
constexpr double kByChance = 1e-3;    // sets of three that may fit so
constexpr double kDeviations = 3.5;

class PointMatcher {
 public:
  PointMatcher(const std::vector<MeasuredPoint>& seen, const std::vector<MeasuredPoint>& known)
      : seen_(seen), known_(known) {
    for (std::size_t a = 0; a < known.size(); ++a) {
      for (std::size_t b = 0; b < known.size(); ++b) {
        if (a != b) distances_.push_back({distance(known, a, b), static_cast<int>(a), static_cast<int>(b)});
      }
    }
    std::sort(distances_.begin(), distances_.end(), [](const Distance& x, const Distance& y) {
      return std::pair(x.metres, x.a) < std::pair(y.metres, y.a);
    });
  }

  std::vector<int> run() {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      for (std::size_t j = i + 1; j < seen_.size(); ++j) begin_with(i, j);
    }
    const std::vector<int> none(seen_.size(), -1);
    if (best_.empty() || tied_ || count_of(best_) < least_count()) return none;
    return best_;
  }

 private:
  struct Distance {
    double metres = 0.0;
    int a = -1;
    int b = -1;
  };
  using Match = std::vector<int>;

  static double distance(const std::vector<MeasuredPoint>& points, std::size_t a, std::size_t b) {
    return (points[a].x - points[b].x).norm();
  }
  static std::size_t count_of(const Match& match) {
    return static_cast<std::size_t>(std::count_if(match.begin(), match.end(), [](int k) { return k >= 0; }));
  }

  /// By how much a distance between two seen points may differ from that between two known ones.
  [[nodiscard]] double tolerance(std::size_t i, std::size_t j, int a, int b) const {
    double variance = 0.0;
    for (const MeasuredPoint* point :
         {&seen_[i], &seen_[j], &known_[static_cast<std::size_t>(a)], &known_[static_cast<std::size_t>(b)]})
      variance += point->sigma_m * point->sigma_m;
    return kDeviations * std::sqrt(variance);
  }

  [[nodiscard]] bool fits(std::size_t i, std::size_t j, int a, int b) const {
    const double apart = distance(known_, static_cast<std::size_t>(a), static_cast<std::size_t>(b));
    return std::abs(distance(seen_, i, j) - apart) < tolerance(i, j, a, b);
  }

  void begin_with(std::size_t i, std::size_t j) {
    const double apart = distance(seen_, i, j);
    if (apart < kLeastApartM) return;
    const double widest =
        kDeviations * std::hypot(seen_[i].sigma_m, seen_[j].sigma_m) + 2.0 * kDeviations * worst();
    auto it = std::lower_bound(distances_.begin(), distances_.end(), apart - widest,
                               [](const Distance& d, double metres) { return d.metres < metres; });
    for (; it != distances_.end() && it->metres < apart + widest; ++it) {
      if (fits(i, j, it->a, it->b)) complete(i, j, it->a, it->b);
    }
  }

  [[nodiscard]] double worst() const {
    double most = 0.0;
    for (const MeasuredPoint& point : known_) most = std::max(most, point.sigma_m);
    return most;
  }

  /// Adds a third point, and all that the motion of the three brings to a known one.
  void complete(std::size_t i, std::size_t j, int a, int b) {
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      if (k == i || k == j) continue;
      for (int c = 0; c < static_cast<int>(known_.size()); ++c) {
        if (c == a || c == b || !fits(i, k, a, c) || !fits(j, k, b, c)) continue;
        Match match(seen_.size(), -1);
        match[i] = a;
        match[j] = b;
        match[k] = c;
        consider(grown(std::move(match)));
      }
    }
  }

  [[nodiscard]] PointFit fit_of(const Match& match) const {
    std::vector<PointPair> pairs;
    for (std::size_t k = 0; k < match.size(); ++k) {
      if (match[k] < 0) continue;
      const MeasuredPoint& known = known_[static_cast<std::size_t>(match[k])];
      const auto covariance = [](double sigma) -> Matrix3d { return sigma * sigma * Matrix3d::Identity(); };
      pairs.push_back({seen_[k].x, covariance(seen_[k].sigma_m), known.x, covariance(known.sigma_m)});
    }
    return fit_points(pairs);
  }

  /// Every seen point whose distances to all that are matched agree with those of a known one.
  [[nodiscard]] Match grown(Match match) const {
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      if (match[k] >= 0) continue;
      for (int c = 0; c < static_cast<int>(known_.size()); ++c) {
        if (std::find(match.begin(), match.end(), c) != match.end()) continue;
        bool agrees = true;
        for (std::size_t other = 0; agrees && other < match.size(); ++other)
          agrees = match[other] < 0 || fits(k, other, c, match[other]);
        if (!agrees) continue;
        match[k] = c;
        break;
      }
    }
    return match;
  }

  void consider(Match match) {
    const std::size_t count = count_of(match);
    const std::size_t most = best_.empty() ? 0 : count_of(best_);
    if (count < most || match == best_) return;
    // Distances do not distinguish a set from its mirror image, nor points on a line.
    if (std::find(refused_.begin(), refused_.end(), match) != refused_.end()) return;
    const PointFit fit = fit_of(match);
    const auto taken = static_cast<std::size_t>(std::count(fit.taken.begin(), fit.taken.end(), true));
    if (fit.state != PointFitState::fixed || taken < count) {
      refused_.push_back(std::move(match));
      return;
    }
    tied_ = count == most;
    best_ = std::move(match);
  }

  /// Three points fit by chance where there are many to choose from; a fourth hardly ever.
  [[nodiscard]] std::size_t least_count() const {
    const auto triples = [](std::size_t n) {
      const auto x = static_cast<double>(n);
      return x * (x - 1.0) * (x - 2.0);
    };
    const double width = std::max(1.0, distances_.empty() ? 1.0 : distances_.back().metres);
    const double within = 2.0 * tolerance(0, 1, 0, 1) / width;
    return triples(seen_.size()) / 6.0 * triples(known_.size()) * within * within * within < kByChance ? 3
                                                                                                       : 4;
  }

  const std::vector<MeasuredPoint>& seen_;
  const std::vector<MeasuredPoint>& known_;
  std::vector<Distance> distances_;  ///< ascending
  Match best_;
  bool tied_ = false;
  std::vector<Match> refused_;
};

}  // namespace

std::vector<int> match_points(const std::vector<MeasuredPoint>& seen,
                              const std::vector<MeasuredPoint>& known) {
  if (seen.size() < 3 || known.size() < 3) return std::vector<int>(seen.size(), -1);
  return PointMatcher(seen, known).run();
}

}  // namespace limen
