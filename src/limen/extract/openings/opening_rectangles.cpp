// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/opening_rectangles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kSigmaFloor_m = 0.003;  // no side is known better than the points are
/// Share of the samples beyond a side that pretend to be open (a beam that meets the edge measures something
/// behind it), and of those within that pretend to be wall.
constexpr double kFalseOpen = 0.15;
constexpr double kFalseWall = 0.03;

}  // namespace

SideSeparator separate(std::vector<SideMark> marks, double from, double to) {
  static const double wall_inside = std::log((1.0 - kFalseOpen) / kFalseWall);
  static const double open_outside = std::log((1.0 - kFalseWall) / kFalseOpen);
  constexpr double kPatience = 30.0;  // log likelihood
  std::sort(marks.begin(), marks.end(), [](const SideMark& a, const SideMark& b) { return a.at < b.at; });
  const auto open =
      std::count_if(marks.begin(), marks.end(), [](const SideMark& mark) { return !mark.wall; });
  if (open == 0) return {};
  // Between marks k - 1 and k the likelihood is the same; `cost` falls with each open mark left inside.
  std::vector<double> costs = {0.0};
  double best = 0.0;
  std::size_t best_at = 0;
  for (const SideMark& mark : marks) {
    costs.push_back(costs.back() + (mark.wall ? wall_inside : -open_outside));
    if (costs.back() < best) {
      best = costs.back();
      best_at = costs.size() - 1;
    }
    if (costs.back() > best + kPatience) break;
  }
  const bool wall_met = std::any_of(marks.begin() + static_cast<std::ptrdiff_t>(best_at), marks.end(),
                                    [](const SideMark& mark) { return mark.wall; });
  if (!wall_met || best_at == 0) return {marks[best_at == 0 ? 0 : best_at - 1].at, kUnboundedSigma_m, true};
  double weight = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const double low = k == 0 ? from : marks[k - 1].at;
    const double high = k == marks.size() ? to : marks[k].at;
    const double w = (high - low) * std::exp(best - costs[k]);
    weight += w;
    first += w * 0.5 * (low + high);
    second += w * (low * low + low * high + high * high) / 3.0;
  }
  if (!(weight > 0.0)) return {};
  const double mean = first / weight;
  const double variance = std::max(0.0, second / weight - mean * mean);
  return {mean, std::sqrt(variance + kSigmaFloor_m * kSigmaFloor_m), true};
}

namespace {

constexpr double kNeck_m = 0.06;     // wall seen to reach this far in from both sides divides
constexpr double kTrimShare = 0.12;  // of a side's length that is left out at either corner
constexpr double kSearch_m = 0.3;    // how far a side is looked for beyond its region
constexpr int kRounds = 2;
constexpr double kMinPane_m = 0.15;     // smaller regions are no part of an opening
constexpr double kMergedBar_m = 0.12;   // bars flush with the wall no wider than this do not divide
constexpr double kMinSupport_m = 0.08;  // beyond a side within which wall must be seen

class Fitter {
 public:
  Fitter(const WallEvidence& evidence, const OpeningGrid& grid) : evidence_(evidence), grid_(grid) {}

  [[nodiscard]] OpeningRectangle fit(const Box2& region) const {
    OpeningRectangle rectangle{.box = region};
    const double spacing_m = grid_.spacing_m(0.5 * (region.low + region.high));
    const double search_m = std::max(kSearch_m, 4.0 * spacing_m);
    Box2 around = region;
    around.low.array() -= 2.0 * search_m;
    around.high.array() += 2.0 * search_m;
    for (int round = 0; round < kRounds; ++round) {
      for (const Side side : kSides) {
        const SideSeparator found = place_side(rectangle.box, side, search_m, around);
        if (!found.found) continue;
        set_place(rectangle.box, side, outward(side) * found.place);
        rectangle.sigma_m[static_cast<std::size_t>(side)] = found.sigma_m;
      }
    }
    return rectangle;
  }

 private:
  /// The part of the wall that tells where a side is: along the side, and as far across as it may lie.
  struct SideStrip {
    Eigen::Index axis = 0;  ///< across the side
    double sign = 1.0;      ///< of the axis: outwards
    double from = 0.0;      ///< across, outwards
    double to = 0.0;
    double low = 0.0;  ///< along
    double high = 0.0;

    [[nodiscard]] double across(const Vector2d& p) const { return sign * p[axis]; }
    [[nodiscard]] bool contains(const Vector2d& p) const {
      return p[1 - axis] >= low && p[1 - axis] <= high && across(p) >= from && across(p) <= to;
    }
    [[nodiscard]] Box2 box() const {
      Box2 all;
      all.add(Vector2d::Unit(axis) * sign * from + Vector2d::Unit(1 - axis) * low);
      all.add(Vector2d::Unit(axis) * sign * to + Vector2d::Unit(1 - axis) * high);
      return all;
    }
  };

  static SideStrip strip_of(const Box2& box, Side side, double search_m) {
    SideStrip strip{.axis = axis_of(side), .sign = outward(side)};
    const Eigen::Index other = 1 - strip.axis;
    const double length = box.high[other] - box.low[other];
    strip.low = box.low[other] + kTrimShare * length;
    strip.high = box.high[other] - kTrimShare * length;
    const double size = box.high[strip.axis] - box.low[strip.axis];
    const double at = strip.sign * place_of(box, side);
    strip.from = at - std::min(search_m, 0.5 * size);
    strip.to = at + search_m;
    return strip;
  }

  /// By the samples within `around`.
  [[nodiscard]] SideSeparator place_side(const Box2& box, Side side, double search_m,
                                         const Box2& around) const {
    const SideStrip strip = strip_of(box, side, search_m);
    Box2 part = strip.box();
    part.low = part.low.cwiseMax(around.low);
    part.high = part.high.cwiseMin(around.high);
    std::vector<SideMark> marks;
    for (const std::uint32_t i : grid_.samples_in(part)) {
      const WallSample& sample = evidence_.samples[i];
      const Vector2d p(sample.u, sample.v);
      if (sample.kind != SampleKind::cover && strip.contains(p))
        marks.push_back({strip.across(p), sample.kind == SampleKind::wall});
    }
    add_silent(strip, marks);
    SideSeparator found = separate(std::move(marks), strip.from, strip.to);
    if (found.found && found.sigma_m >= kUnboundedSigma_m)
      found.place = behind_occluder(found.place, side, {strip.low, strip.high});
    return found;
  }

  /// Silent cells are open: a mark for each, as coarse as the cells.
  void add_silent(const SideStrip& strip, std::vector<SideMark>& marks) const {
    const Box2 box = strip.box();
    const int c0 = std::max(0, grid_.column(box.low.x()));
    const int c1 = std::min(grid_.columns() - 1, grid_.column(box.high.x()));
    const int r1 = std::min(grid_.rows() - 1, grid_.row(box.high.y()));
    for (int r = std::max(0, grid_.row(box.low.y())); r <= r1; ++r) {
      for (int c = c0; c <= c1; ++c) {
        if (grid_.at(c, r) != OpeningGrid::Cell::silent) continue;
        const Vector2d p = grid_.middle(c, r);
        if (strip.contains(p)) marks.push_back({strip.across(p), false});
      }
    }
  }

  /// Where nothing was seen between the opening and the next wall the side lies somewhere in between.
  [[nodiscard]] double behind_occluder(double from, Side side, const Vector2d& along) const {
    constexpr double kReach_m = 1.0;
    constexpr std::size_t kWalls = 4;
    constexpr double kHiddenShare = 0.25;  // an open leaf hides more of the wall than of its opening
    const Eigen::Index axis = axis_of(side);
    const double sign = outward(side);
    Box2 box;
    box.add(Vector2d::Unit(axis) * sign * (from + 1e-6) + Vector2d::Unit(1 - axis) * along.x());
    box.add(Vector2d::Unit(axis) * sign * (from + kReach_m) + Vector2d::Unit(1 - axis) * along.y());
    std::vector<double> walls;
    for (const std::uint32_t i : grid_.samples_in(box)) {
      const WallSample& sample = evidence_.samples[i];
      if (sample.kind == SampleKind::wall) walls.push_back(sign * (axis == 0 ? sample.u : sample.v));
    }
    if (walls.size() < kWalls) return from;
    return from + kHiddenShare * (ranked(walls, kWalls - 1) - from);
  }

  const WallEvidence& evidence_;
  const OpeningGrid& grid_;
};

/// Part of a side beyond which the first thing seen is wall, among where anything was seen; where little was,
/// among all.
double bounded_share(const Box2& box, Side side, const OpeningGrid& grid) {
  constexpr double kEnough = 0.25;
  const double spacing_m = grid.spacing_m(0.5 * (box.low + box.high));
  const double support_m = std::max(kMinSupport_m, 3.0 * spacing_m);
  const int steps = std::max(2, static_cast<int>(std::ceil(support_m / grid.cell_m())));
  const bool upright = axis_of(side) == 0;
  const int direction = outward(side) > 0.0 ? 1 : -1;
  const int first = upright ? grid.row(box.low.y()) : grid.column(box.low.x());
  const int last = upright ? grid.row(box.high.y()) : grid.column(box.high.x());
  const int start = upright ? grid.column(place_of(box, side)) : grid.row(place_of(box, side));
  int walls = 0;
  int others = 0;
  for (int k = first; k <= last; ++k) {
    int wall = 0;
    int open = 0;
    for (int s = 0; s <= steps && wall == 0; ++s) {
      const int across = start + direction * s;
      const OpeningGrid::Cell cell = upright ? grid.at(across, k) : grid.at(k, across);
      wall += cell == OpeningGrid::Cell::wall ? 1 : 0;
      open += grid.passes(upright ? across : k, upright ? k : across) && s >= 2 ? 1 : 0;
    }
    walls += wall;
    others += wall == 0 && open > 0 ? 1 : 0;
  }
  const double share = last < first ? 0.0 : static_cast<double>(walls) / (last - first + 1);
  return share < kEnough ? share : static_cast<double>(walls) / (walls + others);
}

bool overlap(const Box2& a, const Box2& b) {
  const Vector2d common = a.high.cwiseMin(b.high) - a.low.cwiseMax(b.low);
  if ((common.array() <= 0.0).any()) return false;
  const Vector2d sa = a.high - a.low;
  const Vector2d sb = b.high - b.low;
  return common.prod() > 0.3 * std::min(sa.prod(), sb.prod());
}

/// Side by side (or one above the other) with the same ends, a bar apart.
bool joined_by_bar(const Box2& a, const Box2& b, Eigen::Index axis, double bar_m) {
  constexpr double kSameEnd_m = 0.08;
  const Eigen::Index other = 1 - axis;
  if (std::abs(a.low[other] - b.low[other]) > kSameEnd_m ||
      std::abs(a.high[other] - b.high[other]) > kSameEnd_m)
    return false;
  const double gap = std::max(a.low[axis], b.low[axis]) - std::min(a.high[axis], b.high[axis]);
  return gap <= bar_m && gap > -0.5 * bar_m;
}

/// Boxes that overlap or lie a bar apart become one, until none do.
std::vector<Box2> merged_boxes(std::vector<Box2> boxes, double bar_m) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = boxes.size(); j-- > i + 1;) {
        if (!overlap(boxes[i], boxes[j]) && !joined_by_bar(boxes[i], boxes[j], 0, bar_m) &&
            !joined_by_bar(boxes[i], boxes[j], 1, bar_m))
          continue;
        boxes[i].add(boxes[j].low);
        boxes[i].add(boxes[j].high);
        boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(j));
        changed = true;
      }
    }
  }
  return boxes;
}

}  // namespace

OpeningRectangle measured(OpeningRectangle rectangle, const WallEvidence& evidence, const OpeningGrid& grid,
                          const OpeningOptions& options) {
  const Box2& box = rectangle.box;
  rectangle.evidence = 0;
  rectangle.through = 0;
  for (const std::uint32_t i : grid.samples_in(box)) {
    const WallSample& sample = evidence.samples[i];
    if (sample.kind != SampleKind::open) continue;
    ++rectangle.evidence;
    if (sample.depth_m > options.through_m) ++rectangle.through;
  }
  double open = 0.0;
  double wall = 0.0;
  double all = 0.0;
  for (int r = grid.row(box.low.y() + 0.5 * grid.cell_m()); r <= grid.row(box.high.y() - 0.5 * grid.cell_m());
       ++r) {
    for (int c = grid.column(box.low.x() + 0.5 * grid.cell_m());
         c <= grid.column(box.high.x() - 0.5 * grid.cell_m()); ++c) {
      const OpeningGrid::Cell cell = grid.at(c, r);
      open += grid.passes(c, r) ? 1.0 : 0.0;
      wall += cell == OpeningGrid::Cell::wall ? 1.0 : 0.0;
      all += 1.0;
    }
  }
  rectangle.fill = open / std::max(1.0, open + wall);
  rectangle.known = open / std::max(1.0, all);
  for (const Side side : kSides) {
    const auto k = static_cast<std::size_t>(side);
    rectangle.bounded[k] = bounded_share(box, side, grid);
    if (rectangle.bounded[k] < kMinBounded) rectangle.sigma_m[k] = kUnboundedSigma_m;
  }
  return rectangle;
}

std::vector<OpeningRectangle> opening_rectangles(const WallEvidence& evidence, const OpeningGrid& grid,
                                                 const OpeningOptions& options) {
  const Fitter fitter(evidence, grid);
  std::vector<OpeningRectangle> fitted;
  std::vector<Box2> boxes;
  for (const Box2& region : grid.regions(OpeningGrid::Cell::open, kNeck_m)) {
    const Vector2d size = region.high - region.low;
    if (size.minCoeff() < kMinPane_m) continue;
    if (size.x() > 1.5 * options.max_width_m || size.y() > 1.5 * options.max_height_m) continue;
    fitted.push_back(fitter.fit(region));
    boxes.push_back(fitted.back().box);
  }
  std::vector<OpeningRectangle> rectangles;
  for (const Box2& box : merged_boxes(std::move(boxes), kMergedBar_m)) {
    const Vector2d size = box.high - box.low;
    if (size.x() < options.min_width_m || size.y() < options.min_height_m) continue;
    const auto alone = std::find_if(fitted.begin(), fitted.end(), [&](const OpeningRectangle& other) {
      return other.box.low == box.low && other.box.high == box.high;
    });
    rectangles.push_back(measured(alone != fitted.end() ? *alone : fitter.fit(box), evidence, grid, options));
  }
  return rectangles;
}

}  // namespace limen
