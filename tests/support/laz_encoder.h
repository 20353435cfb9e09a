// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "limen/io/las/laz/laz_arithmetic.h"

/// A second encoder, for tests: limen's own is held against it.
namespace limen::testing_laz {

using laz::BitModel;
using laz::SymbolModel;

class Encoder {
 public:
  void bit(BitModel& model, bool one) {
    const std::uint32_t split = model.zero_share() * (length_ >> laz::kBitDigits);
    one ? narrow(split, length_ - split) : narrow(0, split);
    model.count(one);
  }

  template <unsigned most>
  void symbol(SymbolModel<most>& model, unsigned value) {
    model.reset_once();
    symbol_of(model, value);
  }
  /// A model that is in use already.
  template <unsigned most>
  void symbol_of(SymbolModel<most>& model, unsigned value) {
    const std::uint32_t unit = length_ >> laz::kSymbolDigits;
    const std::uint32_t low = model.begin_of(value) * unit;
    const std::uint32_t high = model.is_last(value) ? length_ : model.begin_of(value + 1) * unit;
    narrow(low, high - low);
    model.count(value);
  }

  void bits(unsigned count, std::uint32_t value) {
    if (count > 19) {
      few_bits(16, value & 0xFFFFU);
      few_bits(count - 16, value >> 16U);
    } else {
      few_bits(count, value);
    }
  }
  void word(std::uint32_t value) {
    few_bits(16, value & 0xFFFFU);
    few_bits(16, value >> 16U);
  }

  /// The message; at its end as many bytes as a decoder takes in advance.
  std::string finish() {
    const bool wide = length_ > (2U << 24U);
    narrow(wide ? 1U << 24U : 1U << 23U, wide ? 1U << 23U : 1U << 15U);
    return bytes_ + std::string(wide ? 3 : 2, '\0');
  }

 private:
  void few_bits(unsigned count, std::uint32_t value) {
    const std::uint32_t unit = length_ >> count;
    narrow(value * unit, unit);
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
  void carry() {
    std::size_t at = bytes_.size();
    while (++bytes_[--at] == 0) {
    }
  }

  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::string bytes_;
};

template <unsigned digits, unsigned contexts>
class IntegerEncoder {
 public:
  void encode(Encoder& encoder, std::int32_t value, std::int32_t prediction, unsigned context = 0) {
    auto difference = static_cast<std::int64_t>(static_cast<std::int32_t>(
        static_cast<std::uint32_t>(value) - static_cast<std::uint32_t>(prediction)));
    if constexpr (digits < 32) {
      constexpr std::int64_t kRange = std::int64_t{1} << digits;
      if (difference < -kRange / 2) difference += kRange;
      if (difference > kRange / 2 - 1) difference -= kRange;
    }
    bits_ = 0;
    while ((std::int64_t{1} << bits_) < difference || -((std::int64_t{1} << bits_) - 1) > difference) ++bits_;
    encoder.symbol(counts_[context], bits_);
    if (bits_ == 0) {
      encoder.bit(least_, difference == 1);
    } else if (bits_ < 32) {
      const std::int64_t most = (std::int64_t{1} << bits_) - 1;
      place(encoder, static_cast<std::uint32_t>(difference < 0 ? difference + most : difference - 1));
    }
  }
  [[nodiscard]] unsigned bit_count() const { return bits_; }

 private:
  void place(Encoder& encoder, std::uint32_t value) {
    SymbolModel<256>& model = places_[bits_];
    model.reset_once(1U << std::min(bits_, 8U));
    if (bits_ <= 8) return encoder.symbol_of(model, value);
    encoder.symbol_of(model, value >> (bits_ - 8));
    encoder.bits(bits_ - 8, value & ((1U << (bits_ - 8)) - 1));
  }

  unsigned bits_ = 0;
  std::array<SymbolModel<digits + 1>, contexts> counts_;
  BitModel least_;
  std::array<SymbolModel<256>, digits + 1> places_;
};

}  // namespace limen::testing_laz
