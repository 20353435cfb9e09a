// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/random.h"

#include <cmath>

namespace limen {

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t trial)
    : state_(mix64(seed ^ mix64(trial))), increment_((mix64(trial + 0x5851f42d4c957f2dULL) << 1U) | 1U) {
  next();
}

std::uint32_t RandomStream::next() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
  const auto turn = static_cast<std::uint32_t>(old >> 59U);
  return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
}

std::uint32_t RandomStream::below(std::uint32_t n) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(next()) * n) >> 32U);
}

double RandomStream::uniform() {
  const std::uint64_t high = next();
  const std::uint64_t low = next();
  return unit_lot((high << 32U) | low);
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  for (;;) {
    const double u = 2.0 * uniform() - 1.0;
    const double v = 2.0 * uniform() - 1.0;
    const double s = u * u + v * v;
    if (s >= 1.0 || s == 0.0) continue;
    const double scale = std::sqrt(-2.0 * std::log(s) / s);
    spare_ = v * scale;
    has_spare_ = true;
    return u * scale;
  }
}

}  // namespace limen
