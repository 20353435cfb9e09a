// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "limen/io/las/laz/laz_arithmetic.h"
#include "limen/io/las/laz/laz_prediction.h"

namespace limen::laz {

using Colour = std::array<std::uint16_t, 3>;

/// Red, green and blue as version 2 codes them: which bytes change, then their differences; green and blue
/// are predicted from what red (and green) did.
class ColourDecoder {
 public:
  Colour decode(Decoder& decoder, const Colour& last) {
    used_.reset_once();
    const unsigned used = decoder.symbol(used_);
    Colour next{};
    for (unsigned half = 0; half < 2; ++half) {
      const std::uint32_t red = changed(decoder, used, half, byte_of(last[0], half), 0);
      next[0] = static_cast<std::uint16_t>(next[0] | (red << (8U * half)));
    }
    if ((used & 64U) == 0) return {next[0], next[0], next[0]};
    for (unsigned half = 0; half < 2; ++half) {
      const int red = byte_of(next[0], half) - byte_of(last[0], half);
      const std::uint32_t green = changed(decoder, used, 2 + half, byte_of(last[1], half), red);
      const int both = (red + (static_cast<int>(green) - byte_of(last[1], half))) / 2;
      const std::uint32_t blue = changed(decoder, used, 4 + half, byte_of(last[2], half), both);
      next[1] = static_cast<std::uint16_t>(next[1] | (green << (8U * half)));
      next[2] = static_cast<std::uint16_t>(next[2] | (blue << (8U * half)));
    }
    return next;
  }

 private:
  static int byte_of(std::uint16_t value, unsigned half) { return (value >> (8U * half)) & 255; }

  std::uint32_t changed(Decoder& decoder, unsigned used, unsigned which, int last, int drift) {
    if ((used & (1U << which)) == 0) return static_cast<std::uint32_t>(last);
    differences_[which].reset_once();
    return (decoder.symbol(differences_[which]) + clamp_to_byte(last + drift)) & 255U;
  }

  SymbolModel<128> used_;
  std::array<SymbolModel<256>, 6> differences_;
};

}  // namespace limen::laz
