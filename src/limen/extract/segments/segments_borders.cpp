// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/segments/segments_borders.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kBin = 1.5;           // width of a bin in units of the spacing
constexpr double kDepth = 6.0;         // how far inward gaps are measured, in units of the spacing
constexpr double kTowardsMean = 0.16;  // measured on samples at random; rows have one value for both
constexpr int kFewestBins = 5;
constexpr double kBend_m = 0.002;        // a line may seem to bend by this,
constexpr double kBendSigmas = 3.5;      // or by this many standard deviations
constexpr double kShortfallKnown = 0.2;  // of the shortfall: how far its mean may be wrong, one deviation
constexpr double kNarrow = 0.5;          // of the spacing: points less deep are one row
constexpr double kUniform = 0.57735;     // standard deviation of what is uniform in [-1, 1]

/// The points along a run, bin by bin, outermost first.
struct BinnedPoints {
  double begin_m = 0.0;
  double bin_m = 0.0;
  std::vector<std::vector<std::pair<double, FlatPoint>>> bins;  ///< inward distance and point
};

BinnedPoints binned(const PlaneImage& image, const Strip& strip, double bin_m,
                    const std::vector<char>& ambiguous = {}) {
  BinnedPoints points;
  points.begin_m = strip.begin_m;
  points.bin_m = bin_m;
  points.bins.resize(static_cast<std::size_t>((strip.end_m - strip.begin_m) / bin_m) + 1);
  for (const FlatPoint& point : image.points_in(strip)) {
    if (!ambiguous.empty() && ambiguous[point.point] != 0) continue;
    const Vector2d off = point.at - strip.origin;
    const double t = (off.dot(strip.along) - strip.begin_m) / bin_m;
    const auto k = std::min(points.bins.size() - 1, static_cast<std::size_t>(std::max(0.0, t)));
    points.bins[k].emplace_back(off.dot(strip.inward()), point);
  }
  for (auto& bin : points.bins)
    std::sort(bin.begin(), bin.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second.point < b.second.point;
    });
  return points;
}

/// The distance from a place within to the next point inward.
struct Shortfall {
  double mean_m = 0.0;
  double middle_m = 0.0;  ///< median
};

Shortfall shortfall_of(const BinnedPoints& points, double depth_m) {
  std::vector<double> gaps;
  for (const auto& bin : points.bins)
    for (std::size_t i = 1; i < bin.size() && bin[i].first < bin[0].first + depth_m; ++i)
      gaps.push_back(bin[i].first - bin[i - 1].first);
  double squares = 0.0;
  double sum = 0.0;
  for (const double gap : gaps) {
    squares += gap * gap;
    sum += gap;
  }
  if (!(sum > 0.0)) return {};
  // Of all places, those in gaps wider than m have the next point further than m for the rest of the gap:
  // the median m halves the sum of min(gap, m).
  std::sort(gaps.begin(), gaps.end());
  double shorter = 0.0;
  std::size_t k = 0;
  while (k < gaps.size() && shorter + static_cast<double>(gaps.size() - k) * gaps[k] < 0.5 * sum)
    shorter += gaps[k++];
  const double middle = (0.5 * sum - shorter) / static_cast<double>(gaps.size() - k);
  return {0.5 * squares / sum, middle};
}

/// How deep a bin's points reach inward, in the middle of the bins. A surface narrower than its points are
/// apart shows one row of them: where it ends they do not tell.
double depth_of(const BinnedPoints& points) {
  std::vector<double> depths;
  for (const auto& bin : points.bins)
    if (!bin.empty()) depths.push_back(bin.back().first - bin.front().first);
  if (depths.empty()) return 0.0;
  return median(depths);
}

struct Line2 {
  double height = 0.0;
  double slope = 0.0;
  [[nodiscard]] double at(double t) const { return height + slope * t; }
};

/// h over t of the bins within [begin, end], robustly: weights 1 / (1 + (r / scale)^2), from the median on.
Line2 robust_line(const std::vector<BorderBin>& bins, double begin, double end, double scale) {
  std::vector<double> heights;
  for (const BorderBin& bin : bins)
    if (bin.found && bin.t >= begin && bin.t <= end) heights.push_back(bin.h);
  if (heights.empty()) return {};
  Line2 line{median(heights), 0.0};
  for (int round = 0; round < 8; ++round) {
    double w = 0.0, t = 0.0, h = 0.0, tt = 0.0, th = 0.0;
    for (const BorderBin& bin : bins) {
      if (!bin.found || bin.t < begin || bin.t > end) continue;
      const double off = (bin.h - line.at(bin.t)) / scale;
      const double weight = 1.0 / (1.0 + off * off);
      w += weight;
      t += weight * bin.t;
      h += weight * bin.h;
      tt += weight * bin.t * bin.t;
      th += weight * bin.t * bin.h;
    }
    const double spread = tt - t * t / w;
    line.slope = spread > 1e-12 ? (th - t * h / w) / spread : 0.0;
    line.height = (h - line.slope * t) / w;
  }
  return line;
}

std::vector<BorderBin> outermost(const BinnedPoints& points, const Strip& strip) {
  std::vector<BorderBin> bins(points.bins.size());
  for (std::size_t k = 0; k < bins.size(); ++k) {
    bins[k].t = points.begin_m + (static_cast<double>(k) + 0.5) * points.bin_m;
    if (points.bins[k].empty()) continue;
    const auto& [h, point] = points.bins[k].front();
    bins[k].found = true;
    bins[k].t = (point.at - strip.origin).dot(strip.along);
    bins[k].h = h;
    bins[k].point = point.point;
  }
  return bins;
}

/// Turns the strip's line onto the fitted one: the bins' places are computed anew.
Strip turned_onto(const Strip& strip, const Line2& line, std::vector<BorderBin>& bins) {
  Strip turned;
  turned.along = (strip.along + line.slope * strip.inward()).normalized();
  turned.origin = strip.at(0.0, line.height);
  turned.begin_m = 1e300;
  turned.end_m = -1e300;
  for (BorderBin& bin : bins) {
    const Vector2d off = strip.at(bin.t, bin.h) - turned.origin;
    bin.t = off.dot(turned.along);
    bin.h = off.dot(turned.inward());
    turned.begin_m = std::min(turned.begin_m, bin.t);
    turned.end_m = std::max(turned.end_m, bin.t);
  }
  return turned;
}

/// How many of the heights are independent: rows of points that run nearly along the border step from one to
/// the next only here and there.
double independent(const std::vector<double>& heights) {
  double product = 0.0;
  double squares = 1e-12;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    squares += heights[k] * heights[k];
    if (k > 0) product += heights[k] * heights[k - 1];
  }
  const double related = std::clamp(product / squares, 0.0, 0.95);
  return static_cast<double>(heights.size()) * (1.0 - related) / (1.0 + related);
}

/// By how much the heights bend in their middle, and one standard deviation of that if they were independent.
struct Bend {
  double middle_m = 0.0;
  double sigma_m = 0.0;
};

Bend bend_of(const std::vector<double>& places, const std::vector<double>& heights, double spread) {
  // Heights against the square of the place, freed of mean and slope: the rest of a parabola.
  const auto count = static_cast<double>(places.size());
  double mean = 0.0;
  for (const double t : places) mean += t / count;
  double m2 = 0.0;
  double m3 = 0.0;
  for (const double t : places) {
    m2 += (t - mean) * (t - mean) / count;
    m3 += (t - mean) * (t - mean) * (t - mean) / count;
  }
  double product = 0.0;
  double squares = 1e-15;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double t = places[k] - mean;
    const double shape = t * t - m2 - (m2 > 0.0 ? m3 / m2 : 0.0) * t;
    product += shape * heights[k];
    squares += shape * shape;
  }
  const double half = 0.5 * (places.back() - places.front());
  return {std::abs(product / squares) * half * half, spread / std::sqrt(squares) * half * half};
}

/// Fills in which bins fit, and how well the line is known. False: too few, too ragged, or bent.
bool judge(BorderFit& fit, double core_begin, double core_end) {
  const double slack = std::max(0.004, 2.2 * fit.shortfall_m);
  std::vector<double> places;
  std::vector<double> heights;
  double squares = 0.0;
  int core = 0;
  for (BorderBin& bin : fit.bins) {
    // Bin heights are about the line through the outermost points: 0 where they are on average.
    bin.fits = bin.found && std::abs(bin.h) <= slack;
    const bool in_core = bin.t >= core_begin && bin.t <= core_end;
    if (in_core) ++core;
    if (!in_core || !bin.fits) continue;
    places.push_back(bin.t);
    heights.push_back(bin.h);
    squares += bin.h * bin.h;
  }
  const auto fitting = static_cast<int>(places.size());
  if (fitting < kFewestBins || fitting * 3 < core * 2) return false;
  const double spread = std::sqrt(squares / fitting);
  const Bend bend = bend_of(places, heights, spread);
  if (bend.middle_m > kBend_m && bend.middle_m > kBendSigmas * bend.sigma_m) return false;
  // Where the points' rows run along the border all bins err alike: their agreement tells nothing.
  const double expected = kUniform * fit.shortfall_m;
  const double own = expected > 0.0 ? std::max(0.0, 1.0 - spread * spread / (expected * expected)) : 0.0;
  const double count = std::max(1.0, independent(heights));
  // Nor is the shortfall itself known better than to a part of it from the gaps further in.
  const double stated = kShortfallKnown * fit.shortfall_m;
  fit.sigma_m = std::sqrt(spread * spread / count + expected * expected * own + stated * stated);
  fit.angle_sigma_rad = std::sqrt(12.0 / count) * std::max(spread, 0.3 * expected) /
                        std::max(0.01, places.back() - places.front());
  return true;
}

}  // namespace

Approach approach_of(const PlaneImage& image, const Strip& line) {
  constexpr double kDeepest_m = 0.06;
  const auto spacing_at = [&](double t) { return image.spacing_m(line.at(t, line.low_m)); };
  const double spacing = spacing_at(0.5 * (line.begin_m + line.end_m));
  const double widest = std::max({spacing, spacing_at(line.begin_m), spacing_at(line.end_m)});
  Strip strip = line;
  strip.high_m = line.low_m + std::max(kDeepest_m, kDepth * widest);
  const BinnedPoints points = binned(image, strip, std::max(0.005, kBin * spacing));
  std::vector<double> nearest;
  for (const auto& bin : points.bins)
    if (!bin.empty()) nearest.push_back(bin.front().first - line.low_m);
  Approach approach;
  if (nearest.empty()) return approach;
  std::sort(nearest.begin(), nearest.end());
  approach.nearest_m = nearest[nearest.size() / 2];
  approach.spread_m = nearest[3 * nearest.size() / 4] - nearest[nearest.size() / 4];
  approach.shortfall_m = shortfall_of(points, strip.high_m - strip.low_m).mean_m;
  approach.filled = static_cast<double>(nearest.size()) / static_cast<double>(points.bins.size());
  approach.first_m = 1e300;
  approach.last_m = -1e300;
  const double usual = approach.nearest_m + 2.0 * approach.shortfall_m;
  for (const auto& bin : points.bins) {
    if (bin.empty()) continue;
    const double t = (bin.front().second.at - strip.origin).dot(strip.along);
    const double sparser = std::max(1.0, spacing_at(t) / spacing);
    if (bin.front().first > line.low_m + sparser * usual + image.pixel_m()) continue;
    approach.first_m = std::min(approach.first_m, t);
    approach.last_m = std::max(approach.last_m, t);
  }
  return approach;
}

std::optional<BorderFit> fit_border(const PlaneImage& image, const StraightRun& run, double beyond_m,
                                    const std::vector<char>& ambiguous) {
  const double middle_t = 0.5 * (run.line.begin_m + run.line.end_m);
  const double reach = image.reach_m(run.line.at(middle_t, 0.0));
  const double spacing = image.spacing_m(run.line.at(middle_t, reach));
  Strip strip = run.line;
  strip.begin_m -= beyond_m;
  strip.end_m += beyond_m;
  strip.low_m = reach - 3.0 * spacing - image.pixel_m();
  strip.high_m = reach + kDepth * spacing;
  const double bin_m = std::max(0.005, kBin * spacing);
  const BinnedPoints points = binned(image, strip, bin_m, ambiguous);
  if (depth_of(points) < kNarrow * spacing) return std::nullopt;
  BorderFit fit;
  fit.bin_m = bin_m;
  const Shortfall shortfall = shortfall_of(points, kDepth * spacing);
  fit.shortfall_m = shortfall.mean_m;
  fit.bins = outermost(points, strip);
  const double scale = std::max(0.0015, 0.7 * fit.shortfall_m);
  const Line2 line = robust_line(fit.bins, run.line.begin_m, run.line.end_m, scale);
  fit.line = turned_onto(strip, line, fit.bins);
  // Along hardly changes by the turn: the run keeps its bounds.
  if (!judge(fit, run.line.begin_m, run.line.end_m)) return std::nullopt;
  // The robust line lies between the median and the mean of the distances.
  const double moved = shortfall.middle_m + kTowardsMean * (shortfall.mean_m - shortfall.middle_m);
  fit.line.origin -= moved * fit.line.inward();
  for (BorderBin& bin : fit.bins) bin.h += moved;
  return fit;
}

}  // namespace limen
