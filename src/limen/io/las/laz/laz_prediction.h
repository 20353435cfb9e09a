// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

/// What the values of a point are predicted from.
namespace limen::laz {

template <typename Value>
Value get(const char* at) {
  Value value;
  std::memcpy(&value, at, sizeof value);
  return value;
}
template <typename Value>
void put(char* at, Value value) {
  std::memcpy(at, &value, sizeof value);
}

inline std::int32_t wrapping_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t wrapping_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
inline std::int32_t wrapping_product(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}
inline std::uint32_t clamp_to_byte(int value) {
  return static_cast<std::uint32_t>(std::clamp(value, 0, 255));
}

/// The median of about five recent numbers: each new one drives out, in turn, the largest or the smallest.
class RunningMedian {
 public:
  [[nodiscard]] std::int32_t get() const { return sorted_[2]; }
  void add(std::int32_t value) {
    const bool lower = value < sorted_[2];
    const bool higher = sorted_[2] < value;
    if (drop_largest_) {
      insert_from(4, value);
      drop_largest_ = lower;
    } else {
      insert_from(0, value);
      drop_largest_ = !higher;
    }
  }

 private:
  /// Puts the value in place of the number at one end, and moves it inwards to where it belongs.
  void insert_from(std::size_t end, std::int32_t value) {
    sorted_[end] = value;
    if (end == 0) {
      for (std::size_t k = 0; k < 4 && sorted_[k] > sorted_[k + 1]; ++k)
        std::swap(sorted_[k], sorted_[k + 1]);
    } else {
      for (std::size_t k = 4; k > 0 && sorted_[k] < sorted_[k - 1]; --k)
        std::swap(sorted_[k], sorted_[k - 1]);
    }
  }

  std::array<std::int32_t, 5> sorted_{};
  bool drop_largest_ = true;
};

}  // namespace limen::laz
