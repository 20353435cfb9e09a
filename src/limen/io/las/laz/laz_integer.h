// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "limen/io/las/laz/laz_arithmetic.h"

namespace limen::laz {

/// Decodes integers of `digits` bits that differ little from a prediction. The difference d is coded as the
/// number k of its bits, -(2^k - 1) <= d <= 2^k with 2^(k-1) steps on either side, by one of `contexts`
/// models, then its place among the numbers of k bits: the leading eight bits by a model per k, the rest
/// plain. Sums wrap round in `digits` bits.
template <unsigned digits, unsigned contexts>
class IntegerDecoder {
 public:
  /// The coded integer; below 32 digits it is not negative.
  std::int32_t decode(Decoder& decoder, std::int32_t prediction, unsigned context = 0) {
    bit_counts_[context].reset_once();
    bits_ = decoder.symbol(bit_counts_[context]);
    const std::uint32_t sum = static_cast<std::uint32_t>(prediction) + difference(decoder);
    if constexpr (digits < 32) return static_cast<std::int32_t>(sum & ((1U << digits) - 1));
    return static_cast<std::int32_t>(sum);
  }
  /// Of the last integer.
  [[nodiscard]] unsigned bit_count() const { return bits_; }

 private:
  static constexpr unsigned kModelled = 8;

  /// Modulo 2^32.
  std::uint32_t difference(Decoder& decoder) {
    const unsigned k = bits_;
    if (k == 0) return decoder.bit(least_) ? 1U : 0U;
    if (k >= 32) return 0x80000000U;
    std::uint32_t place = 0;
    if (k <= 4) {
      few_[k - 1].reset_once(1U << k);
      place = decoder.symbol(few_[k - 1]);
    } else {
      const unsigned modelled = k < kModelled ? k : kModelled;
      many_[k - 5].reset_once(1U << modelled);
      place = decoder.symbol(many_[k - 5]);
      if (k > kModelled) place = (place << (k - kModelled)) | decoder.bits(k - kModelled);
    }
    return place >= (1U << (k - 1)) ? place + 1U : place - ((1U << k) - 1U);
  }

  unsigned bits_ = 0;
  std::array<SymbolModel<digits + 1>, contexts> bit_counts_;
  BitModel least_;
  std::array<SymbolModel<16>, 4> few_;
  std::array<SymbolModel<256>, (digits < 32 ? digits : 31) - 4> many_;
};

}  // namespace limen::laz
