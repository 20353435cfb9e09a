// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/opening_reveals.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace limen {
namespace {

constexpr double kMaxDepth_m = 1.0;    // walls are thinner
constexpr double kMinDepth_m = 0.008;  // nearer to the face a point may belong to the wall itself
constexpr double kDepthBin_m = 0.015;
constexpr std::size_t kMinBins = 4;  // depths at which a side must be seen: a frame's face has one or two
constexpr std::size_t kMinRevealPoints = 8;
constexpr double kCorner_m = 0.05;       // left out at either end of a side
constexpr double kRevealReach_m = 0.12;  // of a side from where crossings and wall part
constexpr double kMaxSlope = 0.5;        // of splayed sides, metres per metre
constexpr double kSlopeStep = 0.05;
constexpr double kSplayGain = 1.3;     // a splayed side must fit that much better than a straight one
constexpr double kMinGraze = 0.08;     // tangent between ray and side: beams that touch an edge run along it
constexpr double kMaxStart_m = 0.05;   // a side begins at the wall's face; a frame's bar does not
constexpr double kMinBeyond_m = 0.03;  // of a point past a side whose ray did not end on it
constexpr double kFloor_m = 0.002;     // no side is known better

/// A point seen through the opening, as one of its sides sees it.
struct SidePoint {
  double across = 0.0;   ///< of the point, growing outwards
  double crossed = 0.0;  ///< of its ray on the wall's face
  double depth = 0.0;    ///< behind the wall's face

  /// Tangent of the angle at which the ray meets a side of this slope.
  [[nodiscard]] double graze(double slope) const { return (across - crossed) / depth - slope; }
};

struct Line {
  double place = 0.0;
  double slope = 0.0;
  double score = 0.0;
};

/// Different depths among the points with `across - slope * depth` in a window that starts at the k-th.
class WindowScore {
 public:
  void add(double depth) { score_ += ++count_[bin(depth)] <= kPerDepth ? 1.0 : 0.0; }
  void remove(double depth) { score_ -= --count_[bin(depth)] < kPerDepth ? 1.0 : 0.0; }
  [[nodiscard]] double score() const { return score_; }

 private:
  static std::size_t bin(double depth) {
    return std::min(kBins - 1, static_cast<std::size_t>(depth / kDepthBin_m));
  }
  static constexpr std::size_t kBins = 70;
  static constexpr int kPerDepth = 3;  // more points at one depth say no more
  std::array<int, kBins> count_{};
  double score_ = 0.0;
};

Line best_line(const std::vector<SidePoint>& points, double slope, double width) {
  std::vector<std::pair<double, double>> sorted;  // place, depth
  for (const SidePoint& p : points) {
    if (p.graze(slope) >= kMinGraze) sorted.emplace_back(p.across - slope * p.depth, p.depth);
  }
  std::sort(sorted.begin(), sorted.end());
  WindowScore window;
  Line best{0.0, slope, 0.0};
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

/// The side through points at most depths; straight unless a splayed one is clearly better.
Line find_line(const std::vector<SidePoint>& points, double width) {
  Line best = best_line(points, 0.0, width);
  best.score *= kSplayGain;
  if (best.score >= most_score(points)) return best;
  for (double slope = kSlopeStep; slope < kMaxSlope; slope += kSlopeStep) {
    for (const double signed_slope : {slope, -slope}) {
      const Line line = best_line(points, signed_slope, width);
      if (line.score > best.score) best = line;
    }
  }
  return best;
}

struct FittedLine {
  Line line;
  double sigma_m = 1.0;
};

/// Least squares over the points near the line; a straight side keeps its direction. Frames and stray points
/// pass for a side: its deviation is that of points anywhere within `width_m`.
FittedLine refined(const std::vector<SidePoint>& points, const Line& line, double width_m) {
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
  FittedLine fitted{line, 1.0};
  if (line.slope == 0.0) {
    fitted.line.place = sa / n;
    fitted.sigma_m = std::hypot(width_m / std::sqrt(n), kFloor_m);
  } else {
    fitted.line.slope = (sda / n - sd * sa / (n * n)) / std::max(spread, 1e-9);
    fitted.line.place = (sa - fitted.line.slope * sd) / n;
    const double mean = sd / n;
    fitted.sigma_m =
        std::hypot(width_m * std::sqrt((1.0 + mean * mean / std::max(spread, 1e-9)) / n), kFloor_m);
  }
  return fitted;
}

std::vector<SidePoint> near_line(const std::vector<SidePoint>& points, const Line& line, double within_m) {
  std::vector<SidePoint> near;
  for (const SidePoint& p : points) {
    if (p.graze(line.slope) < kMinGraze) continue;
    if (std::abs(p.across - line.place - line.slope * p.depth) <= within_m) near.push_back(p);
  }
  return near;
}

/// Depth at which a side begins: a few points nearer are strays.
double start_of(const std::vector<SidePoint>& points) {
  std::vector<double> depths;
  for (const SidePoint& p : points) depths.push_back(p.depth);
  std::nth_element(depths.begin(), depths.begin() + 1, depths.end());
  return depths[1];
}

/// The deepest point reached without a gap.
double continuous_depth(const std::vector<SidePoint>& points, double max_gap_m) {
  std::vector<double> depths;
  for (const SidePoint& p : points) depths.push_back(p.depth);
  std::sort(depths.begin(), depths.end());
  double reached = depths.front();
  for (const double depth : depths) {
    if (depth - reached > max_gap_m) break;
    reached = depth;
  }
  return reached;
}

/// A ray that cut through where a side would go on.
struct Passage {
  double depth = 0.0;   ///< where it did
  double end = 0.0;     ///< of its point
  double beyond = 0.0;  ///< of its point past the side

  [[nodiscard]] bool far() const { return end - depth > 0.25 || beyond > 0.15; }
};

class RevealFinder {
 public:
  RevealFinder(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
               const OpeningRectangle& rectangle, double noise_m)
      : rectangle_(rectangle), noise_m_(noise_m) {
    const Vector2d middle = 0.5 * (rectangle.box.low + rectangle.box.high);
    spacing_m_ = grid.spacing_m(middle);
    Box2 around = rectangle.box;
    around.low.array() -= kRevealReach_m;
    around.high.array() += kRevealReach_m;
    for (const std::uint32_t i : grid.samples_in(around)) {
      const WallSample& sample = evidence.samples[i];
      if (sample.kind != SampleKind::open && sample.kind != SampleKind::shallow) continue;
      if (sample.depth_m < kMinDepth_m) continue;
      seen_.push_back({{sample.u, sample.v},
                       evidence.wall.frame.to_plane(scan.points[sample.point]),
                       static_cast<double>(sample.depth_m)});
    }
  }

  [[nodiscard]] Reveal find(Side side) const {
    const std::vector<SidePoint> all = points_of(side);
    const double place = outward(side) * place_of(rectangle_.box, side);
    const double sigma_m = rectangle_.sigma_m[static_cast<std::size_t>(side)];
    const double reach_m = std::min(2.5 * sigma_m + 0.01, kRevealReach_m);
    const double width_m = std::max(5.0 * noise_m_, 0.01);
    std::vector<SidePoint> near;
    for (const SidePoint& p : all) {
      if (p.depth < kMaxDepth_m && std::abs(p.across - place) <= reach_m + kMaxSlope * p.depth)
        near.push_back(p);
    }
    if (near.size() < kMinRevealPoints) return {};
    const Line line = find_line(near, width_m);
    std::vector<SidePoint> on = near_line(near, line, width_m);
    if (on.size() < kMinRevealPoints || depths_of(on) < kMinBins || start_of(on) > kMaxStart_m) return {};
    const FittedLine fitted = refined(on, line, 2.0 * width_m);
    if (std::abs(fitted.line.place - place) > reach_m) return {};
    Reveal reveal;
    reveal.found = true;
    reveal.place = outward(side) * fitted.line.place;
    reveal.sigma_m = fitted.sigma_m;
    set_depth(near_line(on, fitted.line, width_m), all, fitted.line, reveal);
    return reveal;
  }

 private:
  struct Seen {
    Vector2d crossed;
    Vector2d at;
    double depth;
  };

  /// The points as a side sees them, those about its corners left out.
  [[nodiscard]] std::vector<SidePoint> points_of(Side side) const {
    const Eigen::Index axis = axis_of(side);
    const Eigen::Index other = 1 - axis;
    const double low = rectangle_.box.low[other] + kCorner_m;
    const double high = rectangle_.box.high[other] - kCorner_m;
    std::vector<SidePoint> points;
    for (const Seen& seen : seen_) {
      if (seen.at[other] < low || seen.at[other] > high) continue;
      points.push_back({outward(side) * seen.at[axis], outward(side) * seen.crossed[axis], seen.depth});
    }
    return points;
  }

  static std::size_t depths_of(const std::vector<SidePoint>& points) {
    std::set<int> bins;
    for (const SidePoint& p : points) bins.insert(static_cast<int>(p.depth / kDepthBin_m));
    return bins.size();
  }

  /// A frame stands where the side ends: behind it the opening may be wider, but the wall goes on.
  static bool ends_at_frame(const std::vector<SidePoint>& all, const Line& line, double depth_m) {
    constexpr double kFrame_m = 0.08;  // depth of a frame, and a little
    constexpr double kBar_m = 0.12;
    constexpr std::ptrdiff_t kPoints = 3;
    const auto count = std::count_if(all.begin(), all.end(), [&](const SidePoint& p) {
      const double inside = line.place + line.slope * p.depth - p.across;
      return inside > 0.02 && inside < kBar_m && p.depth > depth_m - kFrame_m && p.depth < depth_m + 0.02;
    });
    return count >= kPoints;
  }

  /// How deep the side goes, and whether it ends there: the shallowest rays that cut through where it would
  /// go on.
  void set_depth(const std::vector<SidePoint>& on, const std::vector<SidePoint>& all, const Line& line,
                 Reveal& reveal) const {
    if (on.empty()) return;
    const double max_gap_m = std::max(0.08, 3.0 * spacing_m_);
    reveal.depth_m = continuous_depth(on, max_gap_m);
    std::vector<Passage> passed;
    for (const SidePoint& p : all) {
      const double beyond = p.across - line.place - line.slope * p.depth;
      const double before = line.place - p.crossed;
      if (beyond < kMinBeyond_m || before < 0.0) continue;
      passed.push_back({p.depth * before / (before + beyond), p.depth, beyond});
    }
    constexpr std::size_t kRays = 3;  // a stray one proves nothing
    if (passed.size() < kRays) return;
    std::partial_sort(passed.begin(), passed.begin() + kRays, passed.end(),
                      [](const Passage& a, const Passage& b) { return a.depth < b.depth; });
    // Behind a frame the side often goes on a little wider: the first rays past a wall's end go far.
    if (std::any_of(passed.begin(), passed.begin() + kRays, [](const Passage& ray) { return !ray.far(); }))
      return;
    const double pass_m = passed[kRays - 1].depth;
    const double gap_m = pass_m - reveal.depth_m;
    if (gap_m < -0.02 || gap_m > std::max(0.05, 1.5 * spacing_m_)) return;
    if (ends_at_frame(all, line, reveal.depth_m + 0.5 * gap_m)) return;
    reveal.complete = true;
    reveal.depth_sigma_m = std::hypot(std::max(gap_m, 0.0) / std::sqrt(12.0), 0.004);
    reveal.depth_m += 0.5 * gap_m;
  }

  const OpeningRectangle& rectangle_;
  double noise_m_;
  double spacing_m_ = 0.05;
  std::vector<Seen> seen_;
};

}  // namespace

std::array<Reveal, 4> find_reveals(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                   const OpeningRectangle& rectangle, double noise_m) {
  const RevealFinder finder(scan, evidence, grid, rectangle, noise_m);
  std::array<Reveal, 4> reveals;
  for (const Side side : kSides) reveals[static_cast<std::size_t>(side)] = finder.find(side);
  return reveals;
}

}  // namespace limen
