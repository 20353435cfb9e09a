// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limen/base/ranked.h"
#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kMaxDepth_m = 1.0;    // walls are thinner
constexpr double kMinDepth_m = 0.008;  // nearer to the face a point may belong to the wall itself
constexpr std::size_t kMinBins = 4;    // depths at which a side must be seen: a frame's face has one or two
constexpr double kSideShare = 0.4;     // of the rays that met the face where theirs did end on a side
constexpr std::size_t kMinRevealPoints = 8;
constexpr double kCorner_m = 0.05;       // left out at either end of a side
constexpr double kRevealReach_m = 0.12;  // of a side from where crossings and wall part
constexpr double kMaxStart_m = 0.05;     // a side begins at the wall's face; a frame's bar does not
constexpr double kMinBeyond_m = 0.03;    // of a point past a side whose ray did not end on it
constexpr double kMinLayerGraze = 0.03;  // of what tells a side by one depth only
constexpr double kLayerSlope = 0.03;     // of sides seen at one depth: deviation from straight
constexpr double kLayerRough_m = 0.001;  // of a side's surface
constexpr double kMinLayerDepth_m = 0.004;
constexpr double kFrontMargin_m = 0.008;  // before what is in the opening
constexpr double kFrontDepth_m = 0.08;    // of frames and sashes
constexpr double kRayBeside_m = 0.003;    // rays of one row cross the face this near to each other
constexpr double kLayerMargin_m = 0.005;  // before the front of the middle one of many points
constexpr double kLayerShare = 0.5;       // of the rays that met the face where theirs did

/// Depth at which a side begins: a few points nearer are strays.
double start_of(const std::vector<SidePoint>& points) {
  std::vector<double> depths;
  for (const SidePoint& p : points) depths.push_back(p.depth);
  return ranked(depths, 1);
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
               const OpeningRectangle& rectangle, double noise_m, std::optional<double> front_m)
      : rectangle_(rectangle), noise_m_(noise_m), front_m_(front_m) {
    const Vector2d middle = 0.5 * (rectangle.box.low + rectangle.box.high);
    spacing_m_ = grid.spacing_m(middle);
    Box2 around = rectangle.box;
    around.low.array() -= kRevealReach_m;
    around.high.array() += kRevealReach_m;
    for (const std::uint32_t i : grid.samples_in(around)) {
      const WallSample& sample = evidence.samples[i];
      if (sample.kind == SampleKind::wall) walls_.emplace_back(sample.u, sample.v);
      if (sample.kind != SampleKind::open && sample.kind != SampleKind::shallow) continue;
      if (sample.depth_m < kMinLayerDepth_m) continue;
      seen_.push_back({{sample.u, sample.v},
                       evidence.wall.frame.to_plane(scan.points[sample.point]),
                       static_cast<double>(sample.depth_m)});
    }
  }

  [[nodiscard]] Reveal find(Side side) const {
    const std::vector<SidePoint> all = points_of(side);
    const Reveal straight = at_depths(side, all, false);
    if (straight.found) return straight;
    const Reveal layer = before_front(side, all);
    return layer.found ? layer : at_depths(side, all, true);
  }

 private:
  struct Seen {
    Vector2d crossed;
    Vector2d at;
    double depth;
  };

  /// The side through points at several depths.
  [[nodiscard]] Reveal at_depths(Side side, const std::vector<SidePoint>& all, bool splayed) const {
    const double place = outward(side) * place_of(rectangle_.box, side);
    const double sigma_m = rectangle_.sigma_m[static_cast<std::size_t>(side)];
    const double reach_m = std::min(2.5 * sigma_m + 0.01, kRevealReach_m);
    const double width_m = std::max(5.0 * noise_m_, 0.01);
    std::vector<SidePoint> near;
    for (const SidePoint& p : all) {
      if (p.depth > kMinDepth_m && p.depth < kMaxDepth_m &&
          std::abs(p.across - place) <= reach_m + kSideMaxSlope * p.depth)
        near.push_back(p);
    }
    if (near.size() < kMinRevealPoints) return {};
    const SideLine line = find_side_line(near, width_m, splayed);
    std::vector<SidePoint> on = near_side_line(near, line, width_m);
    if (!surely_side(side, all, on)) return {};
    const FittedSideLine fitted = refined_side_line(on, line, 2.0 * width_m);
    if (std::abs(fitted.line.place - place) > reach_m) return {};
    Reveal reveal;
    reveal.found = true;
    reveal.place = outward(side) * fitted.line.place;
    reveal.sigma_m = fitted.sigma_m;
    set_depth(near_side_line(on, fitted.line, width_m), all, fitted.line, reveal);
    return reveal;
  }

  /// A scan line may meet a side at one depth only. Before what is in the opening there is nothing but
  /// its sides: where points lie there in one straight side, within what the noise of their ranges allows, it
  /// is the side.
  [[nodiscard]] Reveal before_front(Side side, const std::vector<SidePoint>& all) const {
    if (!front_m_) return {};
    const double place = outward(side) * place_of(rectangle_.box, side);
    const double sigma_m = rectangle_.sigma_m[static_cast<std::size_t>(side)];
    const double reach_m = std::min(2.5 * sigma_m + 0.01, kRevealReach_m);
    std::vector<SidePoint> near;
    std::size_t before = 0;
    for (const SidePoint& p : all) {
      if (p.depth > *front_m_ + 3.0 * noise_m_ || std::abs(p.across - place) > reach_m) continue;
      if (p.graze(0.0) < kMinLayerGraze) continue;
      near.push_back(p);
      before += p.depth < *front_m_ - std::max(kFrontMargin_m, 3.0 * noise_m_) ? 1 : 0;
    }
    const Layer layer = outermost_layer(near);
    const auto count = static_cast<double>(layer.count);
    if (layer.count == 0 || layer.depth_m > *front_m_ - std::max(kLayerMargin_m, 2.0 * noise_m_)) return {};
    if (count < kLayerShare * static_cast<double>(std::max(before, rays_at(side, all, layer)))) return {};
    Reveal reveal;
    reveal.found = true;
    reveal.place = outward(side) * layer.across;
    reveal.sigma_m = std::hypot(kSideFloor_m, kLayerSlope * layer.depth_m);
    const SideLine line{layer.across, 0.0, 0.0};
    std::vector<SidePoint> on = near_side_line(all, line, std::max(5.0 * noise_m_, 0.01));
    std::erase_if(on, [](const SidePoint& p) { return p.depth > kMaxDepth_m; });
    set_depth(on, all, line, reveal);
    reveal.depth_m = std::max(reveal.depth_m, layer.depth_m);
    return reveal;
  }

  /// Points in one straight side, their mean place and median depth, and where their rays met the face.
  struct Layer {
    std::size_t count = 0;
    double across = 0.0;
    double depth_m = 0.0;
    std::vector<double> crossed;  ///< ascending
  };

  /// What lies in one straight side as far out as anything does.
  [[nodiscard]] Layer outermost_layer(std::vector<SidePoint>& points) const {
    const auto tolerance_m = [&](const SidePoint& p) {
      const double graze = p.graze(0.0);
      return 3.0 * std::hypot(noise_m_ * graze / std::sqrt(1.0 + graze * graze), kLayerRough_m);
    };
    std::sort(points.begin(), points.end(),
              [](const SidePoint& a, const SidePoint& b) { return a.across > b.across; });
    for (std::size_t i = 0; i + kMinRevealPoints <= points.size(); ++i) {
      const SidePoint& middle = points[i + kMinRevealPoints / 2];
      const double wide_m = 1.5 * tolerance_m(middle);
      if (points[i].across - points[i + kMinRevealPoints - 1].across > wide_m) continue;
      return layer_about(points, i, points[i].across - wide_m);
    }
    return {};
  }

  static Layer layer_about(const std::vector<SidePoint>& points, std::size_t begin, double from) {
    Layer layer;
    std::vector<double> depths;
    for (std::size_t i = begin; i < points.size() && points[i].across >= from; ++i) {
      layer.across += points[i].across;
      depths.push_back(points[i].depth);
      layer.crossed.push_back(points[i].crossed);
      ++layer.count;
    }
    std::sort(layer.crossed.begin(), layer.crossed.end());
    layer.across /= static_cast<double>(layer.count);
    layer.depth_m = median(depths);
    return layer;
  }

  /// How many rays met the face there, whatever they hit: of those that a side stops all but a few are
  /// stopped, of those that blend two surfaces at an edge few.
  [[nodiscard]] std::size_t rays_at(Side side, const std::vector<SidePoint>& all, const Layer& layer) const {
    const Eigen::Index axis = axis_of(side);
    const auto there = [&](double at) {
      const auto next = std::lower_bound(layer.crossed.begin(), layer.crossed.end(), at - kRayBeside_m);
      return next != layer.crossed.end() && *next <= at + kRayBeside_m;
    };
    const auto behind =
        std::count_if(all.begin(), all.end(), [&](const SidePoint& p) { return there(p.crossed); });
    const double low = rectangle_.box.low[1 - axis] + kCorner_m;
    const double high = rectangle_.box.high[1 - axis] - kCorner_m;
    const auto before = std::count_if(walls_.begin(), walls_.end(), [&](const Vector2d& wall) {
      return wall[1 - axis] > low && wall[1 - axis] < high && there(outward(side) * wall[axis]);
    });
    return static_cast<std::size_t>(behind + before);
  }

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

  /// Whether points near one line are a side: at several depths, those of frames left out, from the wall's
  /// face on. A row of rays that crossed the face in one place meets a side at one depth: where it has
  /// several, they blend two surfaces, and most of the row does not.
  [[nodiscard]] bool surely_side(Side side, const std::vector<SidePoint>& all,
                                 const std::vector<SidePoint>& points) const {
    std::vector<SidePoint> off_frame;
    for (const SidePoint& p : points) {
      if (!front_m_ || p.depth < *front_m_ - kFrontMargin_m || p.depth > *front_m_ + kFrontDepth_m)
        off_frame.push_back(p);
    }
    if (off_frame.size() < kMinRevealPoints || side_depths(off_frame) < kMinBins ||
        start_of(off_frame) > kMaxStart_m)
      return false;
    const auto rays = static_cast<double>(rays_at(side, all, layer_about(off_frame, 0, -1e9)));
    return static_cast<double>(off_frame.size()) >= kSideShare * rays;
  }

  /// A frame is where the side ends: behind it the opening may be wider, but the wall goes on.
  static bool ends_at_frame(const std::vector<SidePoint>& all, const SideLine& line, double depth_m) {
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
  void set_depth(const std::vector<SidePoint>& on, const std::vector<SidePoint>& all, const SideLine& line,
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
  std::optional<double> front_m_;
  double spacing_m_ = 0.05;
  std::vector<Seen> seen_;
  std::vector<Vector2d> walls_;
};

}  // namespace

std::array<Reveal, 4> find_reveals(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                                   const OpeningRectangle& rectangle, double noise_m,
                                   std::optional<double> front_m) {
  const RevealFinder finder(scan, evidence, grid, rectangle, noise_m, front_m);
  std::array<Reveal, 4> reveals;
  for (const Side side : kSides) reveals[static_cast<std::size_t>(side)] = finder.find(side);
  return reveals;
}

}  // namespace limen
