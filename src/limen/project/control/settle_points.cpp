// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/control/settle_points.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "limen/geometry/linear.h"
#include "limen/project/control/fit_points.h"

namespace limen {
namespace {

constexpr double kSettledFixedRad = 0.01;  // the best-held node; a datum that is known less well is none
constexpr double kSettledFixedM = 0.1;
constexpr int kKnown = -1;  // in place of a sight's number: the coordinates

/// One observation that may be wrong.
struct Suspect {
  double squared = 0.0;
  std::size_t point = 0;
  int sight = kKnown;
};

class Settler {
 public:
  Settler(JointProblem& problem, const std::vector<bool>& candidates)
      : problem_(problem), candidates_(candidates) {
    settled_.verdicts.resize(problem.points.size());
    std::size_t tests = 0;
    for (const MarkedPoint& point : problem.points) {
      has_known_ = has_known_ || point.is_known();
      tests += (point.known ? 1 : 0) + (point.sights.size() > 1 ? point.sights.size() : 0);
    }
    bounds_ = point_bounds(tests);
  }

  SettledPoints run() {
    adjust();
    while (settled_.firm && leave_out()) adjust();
    if (settled_.firm && take_back()) {
      adjust();
      while (settled_.firm && leave_out()) adjust();
    }
    tell_fit();
    return std::move(settled_);
  }

 private:
  void adjust() {
    settled_.solution = adjust_jointly(problem_);
    settled_.findings.clear();
    for (std::size_t p = 0; p < problem_.points.size(); ++p)
      settled_.findings.push_back(test_point(problem_.points[p], settled_.solution.frame_from_node,
                                             settled_.solution.sight_covariance[p], bounds_.shift));
    settled_.firm = settled_.firm && held();
  }

  /// Whether known points hold the frame: some node that they hold is known in all six freedoms.
  [[nodiscard]] bool held() const {
    if (!has_known_) return true;
    double least_turn = std::numeric_limits<double>::infinity();
    double least_shift = least_turn;
    for (const MarkedPoint& point : problem_.points) {
      if (!point.is_known()) continue;
      for (const PointSight& sight : point.sights) {
        const Vector6d variances =
            settled_.solution.covariance[static_cast<std::size_t>(sight.node)].diagonal();
        least_turn = std::min(least_turn, variances.head<3>().maxCoeff());
        least_shift = std::min(least_shift, variances.tail<3>().maxCoeff());
      }
    }
    return least_turn < kSettledFixedRad * kSettledFixedRad && least_shift < kSettledFixedM * kSettledFixedM;
  }

  [[nodiscard]] std::vector<Suspect> suspects() const {
    std::vector<Suspect> list;
    for (std::size_t p = 0; p < problem_.points.size(); ++p) {
      const MarkedPoint& point = problem_.points[p];
      const PointFinding& finding = settled_.findings[p];
      if (!point.enters) continue;
      if (point.is_known()) list.push_back({finding.known.squared, p, kKnown});
      // Of a point that one scan sees, coordinates and sight cannot be distinguished.
      for (std::size_t s = 0; s < finding.sights.size() && point.sights.size() > 1; ++s)
        list.push_back({finding.sights[s].squared, p, static_cast<int>(s)});
    }
    std::sort(list.begin(), list.end(), [](const Suspect& a, const Suspect& b) {
      return std::pair(-a.squared, std::pair(a.point, a.sight)) <
             std::pair(-b.squared, std::pair(b.point, b.sight));
    });
    return list;
  }

  /// Leaves out what misses by most, if anything does; false: nothing was left out.
  bool leave_out() {
    const std::vector<Suspect> list = suspects();
    if (list.empty() || list.front().squared <= bounds_.squared) return false;
    std::set<std::size_t> points;
    for (const Suspect& suspect : list) {
      if (list.front().squared - suspect.squared < kTellingApart) points.insert(suspect.point);
    }
    const bool alone = list.size() < 2 || list[0].squared - list[1].squared >= kTellingApart;
    if (alone) {
      drop(list.front());
      return true;
    }
    for (const std::size_t p : points) {
      PointVerdict& verdict = settled_.verdicts[p];
      verdict.suspected = points.size() > 1;
      verdict.known_left_out = problem_.points[p].known.has_value();
      verdict.squared = list.front().squared;
      problem_.points[p].enters = false;
    }
    return true;
  }

  void drop(const Suspect& suspect) {
    MarkedPoint& point = problem_.points[suspect.point];
    PointVerdict& verdict = settled_.verdicts[suspect.point];
    verdict.squared = suspect.squared;
    if (suspect.sight == kKnown) {
      verdict.known_left_out = true;
      point.known_enters = false;
      return;
    }
    point.sights.erase(point.sights.begin() + suspect.sight);
  }

  /// Points that a first look left out and that agree after all; each once.
  bool take_back() {
    bool any = false;
    for (std::size_t p = 0; p < problem_.points.size(); ++p) {
      MarkedPoint& point = problem_.points[p];
      if (point.is_known() || !point.known || !candidates_[p] || point.sights.empty()) continue;
      PointVerdict& verdict = settled_.verdicts[p];
      const double squared = missed_squared(settled_.findings[p], *point.known);
      if (squared > bounds_.squared) {
        verdict.known_left_out = true;
        verdict.squared = squared;
        continue;
      }
      if (verdict.suspected) continue;
      verdict.known_left_out = false;
      verdict.squared = 0.0;
      point.enters = point.known_enters = any = true;
    }
    return any;
  }

  void tell_fit() {
    for (std::size_t p = 0; p < problem_.points.size(); ++p) {
      const MarkedPoint& point = problem_.points[p];
      if (!point.is_known()) continue;
      const PointTest& test = settled_.findings[p].known;
      settled_.chi_square += test.residual.dot(inverse_of(point.known->covariance) * test.residual);
      settled_.redundancy += test.redundancy;
    }
  }

  JointProblem& problem_;
  const std::vector<bool>& candidates_;
  PointBounds bounds_;
  SettledPoints settled_;
  bool has_known_ = false;
};

}  // namespace

SettledPoints settle_points(JointProblem& problem, const std::vector<bool>& candidates) {
  return Settler(problem, candidates).run();
}

}  // namespace limen
