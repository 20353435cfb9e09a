// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/distance_counts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace limen {
namespace {

constexpr double kCountedBinM = 0.0001;
constexpr double kFarthestM = 1.0;

}  // namespace

std::uint64_t& DistanceCounts::at(std::int32_t bin) {
  if (counts_.empty()) first_ = bin;
  if (bin < first_) {
    counts_.insert(counts_.begin(), static_cast<std::size_t>(first_ - bin), 0);
    first_ = bin;
  }
  const auto place = static_cast<std::size_t>(bin - first_);
  if (place >= counts_.size()) counts_.resize(place + 1, 0);
  return counts_[place];
}

void DistanceCounts::add(double distance_m) {
  if (!(std::abs(distance_m) <= kFarthestM)) return;
  ++at(static_cast<std::int32_t>(std::lround(distance_m / kCountedBinM)));
  ++points_;
  sum_ += distance_m;
  squares_ += distance_m * distance_m;
}

void DistanceCounts::describe(ElementDeviation& it) const {
  it.points = points_;
  if (points_ == 0) return;
  const auto count = static_cast<double>(points_);
  it.mean_m = sum_ / count;
  it.sigma_m = std::sqrt(std::max(0.0, squares_ / count - it.mean_m * it.mean_m));
  std::map<std::int32_t, std::uint64_t> sizes;  // by the distance without its sign
  std::uint64_t passed = 0;
  bool middle_found = false;
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const std::int32_t bin = first_ + static_cast<std::int32_t>(k);
    if (counts_[k] > 0) sizes[std::abs(bin)] += counts_[k];
    passed += counts_[k];
    if (middle_found || 2 * passed < points_) continue;
    it.median_m = kCountedBinM * bin;
    middle_found = true;
  }
  passed = 0;
  for (const auto& [bin, points] : sizes) {
    passed += points;
    it.p95_m = kCountedBinM * bin;
    if (static_cast<double>(passed) >= 0.95 * count) break;
  }
  it.loa = loa_class(it.p95_m);
}

}  // namespace limen
