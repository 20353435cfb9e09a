// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/shift_triples.h"

#include <algorithm>
#include <numeric>

namespace limen {
namespace {

constexpr std::size_t kBuckets = 256;  // by which triples are put in order

/// How many of the shifts, heaviest first, reach more than `least` together with the best along the others.
std::size_t worth_trying(const std::vector<AxisShift>& shifts, double rest_m2, double least) {
  const auto end = std::find_if(shifts.begin(), shifts.end(),
                                [&](const AxisShift& shift) { return shift.limit_m2 + rest_m2 <= least; });
  return static_cast<std::size_t>(end - shifts.begin());
}

/// Put into buckets by what they can bring together, those that can most first; within one as they come.
std::vector<ShiftTriples::Triple> in_buckets(const std::vector<ShiftTriples::Triple>& triples) {
  double most = 0.0;
  for (const ShiftTriples::Triple& triple : triples) most = std::max(most, triple.most_m2);
  if (!(most > 0.0)) return triples;
  const double scale = static_cast<double>(kBuckets - 1) / most;
  const auto bucket = [&](const ShiftTriples::Triple& triple) {
    return kBuckets - 1 - static_cast<std::size_t>(std::max(0.0, triple.most_m2) * scale);
  };
  std::array<std::size_t, kBuckets + 1> begins{};
  for (const ShiftTriples::Triple& triple : triples) ++begins[bucket(triple) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<ShiftTriples::Triple> sorted(triples.size());
  for (const ShiftTriples::Triple& triple : triples) sorted[begins[bucket(triple)]++] = triple;
  return sorted;
}

}  // namespace

ShiftTriples::ShiftTriples(const std::vector<AxisPairs>& axes, const std::array<std::size_t, 3>& basis,
                           double others_m2, double tolerance, double least)
    : basis_(basis), others_m2_(others_m2), least_(least) {
  double all_m2 = others_m2;
  for (const std::size_t axis : basis) {
    if (axes[axis].shifts.empty()) return;
    all_m2 += axes[axis].shifts.front().limit_m2;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<AxisShift>& shifts = axes[basis[k]].shifts;
    const std::size_t count = worth_trying(shifts, all_m2 - shifts.front().limit_m2, least);
    for (std::size_t s = 0; s < count; ++s)
      supports_[k].push_back(axes[basis[k]].support_at(shifts[s].value, tolerance));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t m = 0; m < 3; ++m) {
      if (m != k) most_[k][m] = most_where(axes, k, m);
    }
  }
}

/// The shift along axis m moves the planes of axis k along `way`, with what the own shift adds where the axes
/// are not at right angles.
ShiftTriples::Table ShiftTriples::most_where(const std::vector<AxisPairs>& axes, std::size_t k,
                                             std::size_t m) const {
  const AxisPairs& own = axes[basis_[k]];
  const AxisPairs& other = axes[basis_[m]];
  const Vector3d& along = own.axis.direction;
  const double common = other.axis.direction.dot(along);
  const Vector3d across = other.axis.direction - common * along;
  const double length = across.norm();
  const Vector2d way(own.axis.frame.u.dot(across) / length, own.axis.frame.v.dot(across) / length);
  const std::size_t others = supports_[m].size();
  Table table(supports_[k].size() * others, 0.0);
  std::vector<double> along_m(others);
  for (std::uint32_t a = 0; a < supports_[k].size(); ++a) {
    const ShiftSupport& support = supports_[k][a];
    if (support.most() == 0.0) continue;
    for (std::size_t b = 0; b < others; ++b)
      along_m[b] = (other.shifts[b].value - common * own.shifts[a].value) / length;
    const std::vector<double> most = support.most_where(way, along_m);
    for (std::uint32_t b = 0; b < others; ++b) {
      ShiftPlaces at{};
      at[k] = a;
      at[m] = b;
      table[place(k, m, at)] = std::min(support.most(), most[b]);
    }
  }
  return table;
}

double ShiftTriples::most_of(std::size_t k, const ShiftPlaces& at) const {
  const std::size_t m = k == 0 ? 1 : 0;
  const std::size_t n = k == 2 ? 1 : 2;
  return std::min(most_[k][m][place(k, m, at)], most_[k][n][place(k, n, at)]);
}

void ShiftTriples::add_row(std::uint32_t i, std::uint32_t j, std::vector<Triple>& found) const {
  const std::size_t thirds = supports_[2].size();
  const double first = most_[0][1][i * supports_[1].size() + j];
  const double second = most_[1][0][i * supports_[1].size() + j];
  const double* const first_by_third = most_[0][2].data() + i * thirds;
  const double* const second_by_third = most_[1][2].data() + j * thirds;
  const double* const third_by_first = most_[2][0].data() + i * thirds;
  const double* const third_by_second = most_[2][1].data() + j * thirds;
  for (std::uint32_t k = 0; k < thirds; ++k) {
    const double most = std::min(first, first_by_third[k]) + std::min(second, second_by_third[k]) +
                        std::min(third_by_first[k], third_by_second[k]) + others_m2_;
    if (most > least_) found.push_back({{i, j, k}, most});
  }
}

std::vector<ShiftTriples::Triple> ShiftTriples::best_first() const {
  std::vector<Triple> found;
  for (std::uint32_t i = 0; i < supports_[0].size(); ++i) {
    for (std::uint32_t j = 0; j < supports_[1].size(); ++j) add_row(i, j, found);
  }
  return in_buckets(found);
}

}  // namespace limen
