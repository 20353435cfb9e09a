// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/value_tops.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::size_t kLookedAtOnce = 1024;
constexpr std::size_t kLookedPerTask = 32768;

}  // namespace

bool is_colour(const std::string& name) {
  return name == "red" || name == "green" || name == "blue";
}

double colour_top(double largest, bool integer) {
  if (largest > 255.0) return 65535.0;
  return largest > 1.0 || integer ? 255.0 : 1.0;
}

double largest_value(const RecordTable& table, const Field& field) {
  return parallel_reduce(
      table.rows, kLookedPerTask, 0.0,
      [&](std::size_t begin, std::size_t end) {
        std::array<double, kLookedAtOnce> strip{};
        double largest = 0.0;
        for (std::size_t at = begin; at < end; at += kLookedAtOnce) {
          const std::size_t stop = std::min(end, at + kLookedAtOnce);
          load_numbers(table, field, {at, stop}, strip.data());
          for (std::size_t i = 0; i < stop - at; ++i) {
            if (std::isfinite(strip[i])) largest = std::max(largest, strip[i]);
          }
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace limen
