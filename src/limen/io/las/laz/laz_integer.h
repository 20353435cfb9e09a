// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "limen/io/las/laz/laz_arithmetic.h"

namespace limen::laz {

/// Codes integers of `digits` bits that differ little from a prediction. The difference d is coded as the
/// number k of its bits, -(2^k - 1) <= d <= 2^k with 2^(k-1) steps on either side, by one of `contexts`
/// models, then its place among the numbers of k bits: the leading eight bits by a model per k, the rest
/// plain. Sums wrap round in `digits` bits. `Coder` is a Decoder or an Encoder.
template <typename Coder, unsigned digits, unsigned contexts>
class IntegerCoder {
 public:
  /// The coded integer; below 32 digits it is not negative.
  std::int32_t code(Coder& coder, std::int32_t wanted, std::int32_t prediction, unsigned context = 0) {
    std::uint32_t difference = 0;
    if constexpr (Coder::kEncodes) difference = wrapped_difference(wanted, prediction);
    bit_counts_[context].reset_once();
    bits_ = coder.code(bit_counts_[context], bits_of(difference));
    const std::uint32_t sum = static_cast<std::uint32_t>(prediction) + code_difference(coder, difference);
    if constexpr (digits < 32) return static_cast<std::int32_t>(sum & ((1U << digits) - 1));
    return static_cast<std::int32_t>(sum);
  }
  /// Of the last integer.
  [[nodiscard]] unsigned bit_count() const { return bits_; }

 private:
  static constexpr unsigned kModelled = 8;

  /// Modulo 2^32, the shorter way round.
  static std::uint32_t wrapped_difference(std::int32_t wanted, std::int32_t prediction) {
    const std::uint32_t difference =
        static_cast<std::uint32_t>(wanted) - static_cast<std::uint32_t>(prediction);
    if constexpr (digits == 32) return difference;
    constexpr std::uint32_t kHalf = 1U << (digits - 1);
    return ((difference + kHalf) & (2 * kHalf - 1)) - kHalf;
  }
  static unsigned bits_of(std::uint32_t difference) {
    const bool positive = difference != 0 && (difference >> 31U) == 0;
    return static_cast<unsigned>(std::bit_width(positive ? difference - 1 : 0U - difference));
  }

  /// Modulo 2^32.
  std::uint32_t code_difference(Coder& coder, std::uint32_t difference) {
    const unsigned k = bits_;
    if (k == 0) return coder.code(least_, difference == 1) ? 1U : 0U;
    if (k >= 32) return 0x80000000U;
    std::uint32_t place = 0;
    if constexpr (Coder::kEncodes)
      place = (difference >> 31U) == 0 ? difference - 1U : difference + ((1U << k) - 1U);
    if (k <= 4) {
      few_[k - 1].reset_once(1U << k);
      place = coder.code(few_[k - 1], place);
    } else {
      const unsigned modelled = k < kModelled ? k : kModelled;
      const unsigned rest = k - modelled;
      many_[k - 5].reset_once(1U << modelled);
      const std::uint32_t leading = coder.code(many_[k - 5], place >> rest);
      if (rest > 0) place = (leading << rest) | coder.code_bits(rest, place & ((1U << rest) - 1U));
      if (rest == 0) place = leading;
    }
    return place >= (1U << (k - 1)) ? place + 1U : place - ((1U << k) - 1U);
  }

  unsigned bits_ = 0;
  std::array<SymbolModel<digits + 1>, contexts> bit_counts_;
  BitModel least_;
  std::array<SymbolModel<16>, 4> few_;
  std::array<SymbolModel<256>, (digits < 32 ? digits : 31) - 4> many_;
};

/// Where nothing is ever encoded.
template <unsigned digits, unsigned contexts>
class IntegerDecoder : public IntegerCoder<Decoder, digits, contexts> {
 public:
  std::int32_t decode(Decoder& decoder, std::int32_t prediction, unsigned context = 0) {
    return this->code(decoder, 0, prediction, context);
  }
};

}  // namespace limen::laz
