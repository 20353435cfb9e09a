// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/openings/opening_separator.h"

#include <algorithm>
#include <cmath>

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

}  // namespace limen
