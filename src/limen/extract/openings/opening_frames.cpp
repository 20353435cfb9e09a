// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// A side lies between the last ray that passed and the first that met wall, no one place more likely than
// another; so does the inner edge of the frame's bar between the last ray to the pane and the first to the
// bar. The bar's width is the distance of the two, and its likelihood the convolution of two boxes. Windows
// whose bars are equally wide narrow it: the product of their likelihoods. Windows one above the other are
// met by the same lines and count once.
#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kMaxFrameBar_m = 0.16;
constexpr double kFrameStep_m = 0.001;  // of the widths that are asked
constexpr std::size_t kFrameWidths = static_cast<std::size_t>(kMaxFrameBar_m / kFrameStep_m);
constexpr double kFrameSoft_m = 0.003;      // of boxes: noise, and what equal bars differ by
constexpr double kOtherBar = 0.05;          // share of bars that are not as wide as the others
constexpr double kSameLine_m = 0.015;       // sides nearer to each other are met by the same lines
constexpr double kSameFront_m = 0.012;      // frames equally deep
constexpr double kFrameLayer_m = 0.012;     // behind the front; sashes stand farther back
constexpr double kFrameTrim = 0.15;         // of the height, left out at either end
constexpr double kMinEvidenceForOne = 2.0;  // log of how much likelier one width is than any to each

using Widths = std::array<double, kFrameWidths>;

double width_at(std::size_t k) {
  return (static_cast<double>(k) + 0.5) * kFrameStep_m;
}

/// A box with slanted flanks; 1 within.
struct SoftBox {
  double middle = 0.0;
  double half = 0.0;

  [[nodiscard]] double at(double x) const {
    const double beyond = std::abs(x - middle) - half;
    return std::clamp(0.5 - beyond / (2.0 * kFrameSoft_m), 0.0, 1.0);
  }
};

SoftBox box_of_side(double place, double sigma_m) {
  return {place, std::max(0.001, std::sqrt(3.0) * sigma_m)};
}

/// One upright side: where it may lie, outwards, and the inner edge of its bar.
struct FrameSide {
  std::size_t window = 0;
  Side side = Side::left;
  SoftBox edge;
  SoftBox inner;
  double across = 0.0;     ///< of the side in the wall
  Widths likelihood = {};  ///< of the bar's width, mean 1
};

/// Likelihood of the widths given the two boxes, other widths allowed for.
Widths width_likelihood(const SoftBox& edge, const SoftBox& inner) {
  Widths likelihood{};
  double sum = 0.0;
  const double low = std::max(edge.middle - edge.half, inner.middle - inner.half) - kMaxFrameBar_m;
  const double high = edge.middle + edge.half + kFrameSoft_m;
  for (std::size_t k = 0; k < kFrameWidths; ++k) {
    for (double e = std::max(low, edge.middle - edge.half - kFrameSoft_m); e <= high; e += kFrameStep_m)
      likelihood[k] += edge.at(e) * inner.at(e - width_at(k));
    sum += likelihood[k];
  }
  for (double& value : likelihood)
    value = kOtherBar + (sum > 0.0 ? (1.0 - kOtherBar) * value * static_cast<double>(kFrameWidths) / sum
                                   : 1.0 - kOtherBar);
  return likelihood;
}

std::vector<FrameSide> frame_sides(const std::vector<FramedRectangle>& windows) {
  std::vector<FrameSide> sides;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (!windows[w].front_m) continue;
    for (const Side side : {Side::right, Side::left}) {
      const SideSeparator& inner = windows[w].inner[side == Side::right ? 0 : 1];
      const double sigma_m = windows[w].rectangle.sigma_m[static_cast<std::size_t>(side)];
      if (!inner.found || inner.sigma_m > 0.05 || sigma_m > 0.05) continue;
      FrameSide it;
      it.window = w;
      it.side = side;
      it.across = place_of(windows[w].rectangle.box, side);
      it.edge = box_of_side(outward(side) * it.across, sigma_m);
      it.inner = box_of_side(inner.place, inner.sigma_m);
      it.likelihood = width_likelihood(it.edge, it.inner);
      sides.push_back(it);
    }
  }
  return sides;
}

bool same_lines(const FrameSide& a, const FrameSide& b) {
  return a.side == b.side && std::abs(a.across - b.across) < kSameLine_m;
}

/// Of each set of sides that the same lines met, the one whose bar's width is known best.
std::vector<std::size_t> one_of_each(const std::vector<FrameSide>& sides) {
  const auto peak = [&](std::size_t i) {
    return *std::max_element(sides[i].likelihood.begin(), sides[i].likelihood.end());
  };
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto same = std::find_if(chosen.begin(), chosen.end(),
                                   [&](std::size_t j) { return same_lines(sides[i], sides[j]); });
    if (same == chosen.end()) {
      chosen.push_back(i);
    } else if (peak(i) > peak(*same)) {
      *same = i;
    }
  }
  return chosen;
}

/// A common width's density, mean 1, and the log of how much likelier the sides are with one than with any.
struct CommonWidth {
  Widths density;
  double log_evidence = 0.0;
};

/// What the sides say that other lines met than `own`; all, where it is null.
CommonWidth common_width(const std::vector<FrameSide>& sides, const std::vector<std::size_t>& chosen,
                         const FrameSide* own) {
  CommonWidth common;
  common.density.fill(1.0);
  for (const std::size_t i : chosen) {
    if (own != nullptr && same_lines(sides[i], *own)) continue;
    double mean = 0.0;
    for (std::size_t k = 0; k < kFrameWidths; ++k) {
      common.density[k] *= sides[i].likelihood[k];
      mean += common.density[k] / static_cast<double>(kFrameWidths);
    }
    for (double& value : common.density) value /= mean;
    common.log_evidence += std::log(mean);
  }
  return common;
}

/// Places a side again where its frame is as wide as the widths say.
void place_by_frame(const FrameSide& side, const Widths& widths, OpeningRectangle& rectangle) {
  double weight = 0.0;
  double first = 0.0;
  double second = 0.0;
  const double reach_m = side.edge.half + kFrameSoft_m;
  for (double d = -reach_m; d <= reach_m; d += kFrameStep_m) {
    double p = 0.0;
    for (std::size_t k = 0; k < kFrameWidths; ++k)
      p += widths[k] * side.inner.at(side.edge.middle + d - width_at(k));
    p *= side.edge.at(side.edge.middle + d);
    weight += p;
    first += p * d;
    second += p * d * d;
  }
  if (!(weight > 0.0)) return;
  const double mean = first / weight;
  const double sigma_m = std::hypot(std::sqrt(std::max(0.0, second / weight - mean * mean)), 0.002);
  double& known_m = rectangle.sigma_m[static_cast<std::size_t>(side.side)];
  if (sigma_m >= known_m) return;
  set_place(rectangle.box, side.side, outward(side.side) * (side.edge.middle + mean));
  known_m = sigma_m;
}

/// Places the sides by one width for all where that is likelier than any for each.
void share_among(std::vector<FramedRectangle>& windows) {
  const std::vector<FrameSide> sides = frame_sides(windows);
  const std::vector<std::size_t> chosen = one_of_each(sides);
  if (chosen.size() < 3) return;
  if (!(common_width(sides, chosen, nullptr).log_evidence > kMinEvidenceForOne)) return;
  for (const FrameSide& side : sides)
    place_by_frame(side, common_width(sides, chosen, &side).density, windows[side.window].rectangle);
}

/// For either upright side what lies about it in the front's plane: the frame's bar or wall, or neither.
std::array<std::vector<SideMark>, 2> frame_marks(const Scan& scan, const WallEvidence& evidence,
                                                 const OpeningGrid& grid, const Box2& box, double front_m) {
  const double trim_m = kFrameTrim * (box.high.y() - box.low.y());
  Box2 around = box;
  around.low.x() -= kMaxFrameBar_m;
  around.high.x() += kMaxFrameBar_m;
  std::array<std::vector<SideMark>, 2> marks;
  for (const std::uint32_t i : grid.samples_in(around)) {
    const WallSample& sample = evidence.samples[i];
    const double depth_m = static_cast<double>(sample.depth_m);
    const bool wall = sample.kind == SampleKind::wall;
    if (!wall && (sample.kind == SampleKind::cover || depth_m < front_m - kFrameLayer_m)) continue;
    Vector2d at(sample.u, sample.v);
    if (!wall) at += front_m / depth_m * (evidence.wall.frame.to_plane(scan.points[sample.point]) - at);
    if (at.y() < box.low.y() + trim_m || at.y() > box.high.y() - trim_m) continue;
    const bool bar = wall || depth_m < front_m + kFrameLayer_m;
    marks[0].push_back({at.x(), bar});
    marks[1].push_back({-at.x(), bar});
  }
  return marks;
}

}  // namespace

std::array<SideSeparator, 2> frame_edges(const Scan& scan, const WallEvidence& evidence,
                                         const OpeningGrid& grid, const OpeningRectangle& rectangle,
                                         double front_m) {
  constexpr double kBeyond_m = 0.05;
  const Box2& box = rectangle.box;
  auto marks = frame_marks(scan, evidence, grid, box, front_m);
  std::array<SideSeparator, 2> edges;
  for (const std::size_t k : {0U, 1U}) {
    const double place = k == 0 ? box.high.x() : -box.low.x();
    const double from = place - std::min(kMaxFrameBar_m, 0.4 * (box.high.x() - box.low.x()));
    const double to = place + kBeyond_m;
    std::erase_if(marks[k], [&](const SideMark& mark) { return mark.at < from || mark.at > to; });
    edges[k] = separate(std::move(marks[k]), from, to);
  }
  return edges;
}

void share_frame_widths(std::vector<FramedRectangle>& windows) {
  std::vector<char> done(windows.size(), 0);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    std::vector<std::size_t> group;
    std::vector<FramedRectangle> alike;
    for (std::size_t j = i; j < windows.size(); ++j) {
      if (done[i] != 0 || done[j] != 0 || !windows[i].front_m || !windows[j].front_m) continue;
      if (std::abs(*windows[j].front_m - *windows[i].front_m) > kSameFront_m) continue;
      group.push_back(j);
      alike.push_back(windows[j]);
    }
    share_among(alike);
    for (std::size_t k = 0; k < group.size(); ++k) {
      windows[group[k]] = alike[k];
      done[group[k]] = 1;
    }
  }
}

}  // namespace limen
