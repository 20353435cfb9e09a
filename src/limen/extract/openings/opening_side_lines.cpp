// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kSideDepthBin_m = 0.015;
constexpr double kSideSlopeStep = 0.05;
constexpr double kSplayGain = 1.3;  // a splayed side must fit that much better than a straight one
constexpr double kMinGraze = 0.08;  // tangent between ray and side: beams that touch an edge run along it

/// Different depths among the points with `across - slope * depth` in a window that starts at the k-th.
class WindowScore {
 public:
  void add(double depth) { score_ += ++count_[bin(depth)] <= kPerDepth ? 1.0 : 0.0; }
  void remove(double depth) { score_ -= --count_[bin(depth)] < kPerDepth ? 1.0 : 0.0; }
  [[nodiscard]] double score() const { return score_; }

 private:
  static std::size_t bin(double depth) {
    return std::min(kBins - 1, static_cast<std::size_t>(depth / kSideDepthBin_m));
  }
  static constexpr std::size_t kBins = 70;
  static constexpr int kPerDepth = 3;  // more points at one depth say no more
  std::array<int, kBins> count_{};
  double score_ = 0.0;
};

SideLine best_line(const std::vector<SidePoint>& points, double slope, double width) {
  std::vector<std::pair<double, double>> sorted;  // place, depth
  for (const SidePoint& p : points) {
    if (p.graze(slope) >= kMinGraze) sorted.emplace_back(p.across - slope * p.depth, p.depth);
  }
  std::sort(sorted.begin(), sorted.end());
  WindowScore window;
  SideLine best{0.0, slope, 0.0};
  std::size_t begin = 0;
  for (std::size_t end = 0; end < sorted.size(); ++end) {
    window.add(sorted[end].second);
    while (sorted[end].first - sorted[begin].first > width) window.remove(sorted[begin++].second);
    const double score = window.score();
    if (score > best.score) best = {0.5 * (sorted[begin].first + sorted[end].first), slope, score};
  }
  return best;
}

/// What no line through the points exceeds.
double most_score(const std::vector<SidePoint>& points) {
  WindowScore all;
  for (const SidePoint& p : points) all.add(p.depth);
  return all.score();
}

}  // namespace

SideLine find_side_line(const std::vector<SidePoint>& points, double width_m, bool splayed) {
  SideLine best = best_line(points, 0.0, width_m);
  best.score *= kSplayGain;
  if (!splayed || best.score >= most_score(points)) return best;
  for (double slope = kSideSlopeStep; slope < kSideMaxSlope; slope += kSideSlopeStep) {
    for (const double signed_slope : {slope, -slope}) {
      const SideLine line = best_line(points, signed_slope, width_m);
      if (line.score > best.score) best = line;
    }
  }
  return best;
}

FittedSideLine refined_side_line(const std::vector<SidePoint>& points, const SideLine& line, double width_m) {
  double n = 0.0;
  double sd = 0.0;
  double sa = 0.0;
  double sdd = 0.0;
  double sda = 0.0;
  for (const SidePoint& p : points) {
    n += 1.0;
    sd += p.depth;
    sa += p.across;
    sdd += p.depth * p.depth;
    sda += p.depth * p.across;
  }
  const double spread = sdd / n - sd * sd / (n * n);
  FittedSideLine fitted{line, 1.0};
  if (line.slope == 0.0) {
    fitted.line.place = sa / n;
    fitted.sigma_m = std::hypot(width_m / std::sqrt(n), kSideFloor_m);
  } else {
    fitted.line.slope = (sda / n - sd * sa / (n * n)) / std::max(spread, 1e-9);
    fitted.line.place = (sa - fitted.line.slope * sd) / n;
    const double mean = sd / n;
    fitted.sigma_m =
        std::hypot(width_m * std::sqrt((1.0 + mean * mean / std::max(spread, 1e-9)) / n), kSideFloor_m);
  }
  return fitted;
}

std::vector<SidePoint> near_side_line(const std::vector<SidePoint>& points, const SideLine& line,
                                      double within_m) {
  std::vector<SidePoint> near;
  for (const SidePoint& p : points) {
    if (p.graze(line.slope) < kMinGraze) continue;
    if (std::abs(p.across - line.place - line.slope * p.depth) <= within_m) near.push_back(p);
  }
  return near;
}

std::size_t side_depths(const std::vector<SidePoint>& points) {
  std::set<int> bins;
  for (const SidePoint& p : points) bins.insert(static_cast<int>(p.depth / kSideDepthBin_m));
  return bins.size();
}

}  // namespace limen
