// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "limen/io/las/laz/laz_arithmetic.h"

namespace limen::laz {

/// The other direction of Decoder: the interval is narrowed to the part of each symbol, and the bytes that
/// its beginning can no longer change go out. Source: as laz_arithmetic.h.
class Encoder {
 public:
  static constexpr bool kEncodes = true;

  bool code(BitModel& model, bool wanted) {
    const std::uint32_t split = model.zero_share() * (length_ >> kBitDigits);
    wanted ? narrow(split, length_ - split) : narrow(0, split);
    model.count(wanted);
    return wanted;
  }

  template <unsigned most>
  unsigned code(SymbolModel<most>& model, unsigned wanted) {
    const std::uint32_t unit = length_ >> kSymbolDigits;
    const std::uint32_t low = model.begin_of(wanted) * unit;
    const std::uint32_t high = model.is_last(wanted) ? length_ : model.begin_of(wanted + 1) * unit;
    narrow(low, high - low);
    model.count(wanted);
    return wanted;
  }

  /// Plain bits, up to 32.
  std::uint32_t code_bits(unsigned count, std::uint32_t wanted) {
    if (count <= 19) {
      few_bits(count, wanted);
    } else {
      few_bits(16, wanted & 0xFFFFU);
      few_bits(count - 16, wanted >> 16U);
    }
    return wanted;
  }
  std::uint32_t code_word(std::uint32_t wanted) {
    few_bits(16, wanted & 0xFFFFU);
    few_bits(16, wanted >> 16U);
    return wanted;
  }
  std::uint64_t code_long_word(std::uint64_t wanted) {
    code_word(static_cast<std::uint32_t>(wanted));
    code_word(static_cast<std::uint32_t>(wanted >> 32U));
    return wanted;
  }

  /// The message. Call it once, last: it ends with as many bytes as a decoder takes in advance.
  std::string finish() {
    constexpr std::uint32_t kLeast = 1U << 24U;
    const bool wide = length_ > 2 * kLeast;
    narrow(wide ? kLeast : kLeast / 2, wide ? kLeast / 2 : kLeast >> 9U);
    bytes_.append(wide ? 3 : 2, '\0');
    return std::move(bytes_);
  }

 private:
  void few_bits(unsigned count, std::uint32_t wanted) {
    const std::uint32_t unit = length_ >> count;
    narrow(wanted * unit, unit);
  }
  void narrow(std::uint32_t low, std::uint32_t length) {
    base_ += low;
    if (base_ < low) carry();
    length_ = length;
    while (length_ < (1U << 24U)) {
      bytes_ += static_cast<char>(base_ >> 24U);
      base_ <<= 8U;
      length_ <<= 8U;
    }
  }
  /// The beginning passed 1: one more in the bytes that are out. The message is below 1, so one is there.
  void carry() {
    std::size_t at = bytes_.size();
    while (++bytes_[--at] == 0) {
    }
  }

  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::string bytes_;
};

}  // namespace limen::laz
