// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace limen {

/// A random stream named by (seed, trial): the same pair gives the same numbers on every machine and for
/// every thread count. PCG-XSH-RR on a splitmix64-seeded state.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t trial = 0);

  std::uint32_t next();
  /// Uniform integer in [0, n); n > 0.
  std::uint32_t below(std::uint32_t n);
  /// Uniform in [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (polar method: exact, no library functions that differ between machines but log, sqrt).
  double normal();

 private:
  std::uint64_t state_;
  std::uint64_t increment_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// One round of splitmix64: a well-mixed 64-bit hash.
inline std::uint64_t mix64(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31U);
}

/// The hash of the cell of `cell_m` that a place (three coordinates) lies in. Points that are drawn by it are
/// the same ones in any order.
template <typename Place>
std::uint64_t mix_place(const Place& place, double cell_m) {
  std::uint64_t mixed = 0;
  for (const double x : place)
    mixed = mix64(mixed ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / cell_m))));
  return mixed;
}

/// A hash as a number in [0, 1).
inline double unit_lot(std::uint64_t mixed) {
  return static_cast<double>(mixed >> 11U) * 0x1.0p-53;
}

}  // namespace limen
