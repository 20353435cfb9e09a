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
template <typename Coder>
class ColourCoder {
 public:
  Colour code(Coder& coder, const Colour& last, const Colour& wanted) {
    used_.reset_once();
    const unsigned used = coder.code(used_, Coder::kEncodes ? used_by(last, wanted) : 0U);
    Colour next{};
    for (unsigned half = 0; half < 2; ++half) {
      const Byte red{half, byte_of(last[0], half), 0, byte_of(wanted[0], half)};
      next[0] = static_cast<std::uint16_t>(next[0] | (code_byte(coder, used, red) << (8U * half)));
    }
    if ((used & kNotGrey) == 0) return {next[0], next[0], next[0]};
    for (unsigned half = 0; half < 2; ++half) {
      const int red = byte_of(next[0], half) - byte_of(last[0], half);
      const std::uint32_t green =
          code_byte(coder, used, {2 + half, byte_of(last[1], half), red, byte_of(wanted[1], half)});
      const int both = (red + (static_cast<int>(green) - byte_of(last[1], half))) / 2;
      const std::uint32_t blue =
          code_byte(coder, used, {4 + half, byte_of(last[2], half), both, byte_of(wanted[2], half)});
      next[1] = static_cast<std::uint16_t>(next[1] | (green << (8U * half)));
      next[2] = static_cast<std::uint16_t>(next[2] | (blue << (8U * half)));
    }
    return next;
  }

 private:
  static constexpr unsigned kNotGrey = 64;

  /// One of the six bytes, its last value, by how much it is expected to change, and what it is to be.
  struct Byte {
    unsigned which;
    int last;
    int drift;
    int wanted;
  };

  static int byte_of(std::uint16_t value, unsigned half) { return (value >> (8U * half)) & 255; }

  /// Bits 0 to 5: red low, red high, green low, ... change; bit 6: the colour is not grey.
  static unsigned used_by(const Colour& last, const Colour& wanted) {
    unsigned used = wanted[0] == wanted[1] && wanted[0] == wanted[2] ? 0U : kNotGrey;
    for (unsigned k = 0; k < 6; ++k)
      used |= byte_of(last[k / 2], k % 2) != byte_of(wanted[k / 2], k % 2) ? 1U << k : 0U;
    return used;
  }

  std::uint32_t code_byte(Coder& coder, unsigned used, const Byte& byte) {
    if ((used & (1U << byte.which)) == 0) return static_cast<std::uint32_t>(byte.last);
    const std::uint32_t expected = clamp_to_byte(byte.last + byte.drift);
    differences_[byte.which].reset_once();
    const std::uint32_t wanted = (static_cast<std::uint32_t>(byte.wanted) - expected) & 255U;
    return (coder.code(differences_[byte.which], wanted) + expected) & 255U;
  }

  SymbolModel<128> used_;
  std::array<SymbolModel<256>, 6> differences_;
};

/// Near infrared: which of its two bytes change, then their differences.
template <typename Coder>
class InfraredCoder {
 public:
  std::uint16_t code(Coder& coder, std::uint16_t last, std::uint16_t wanted) {
    used_.reset_once();
    const unsigned change = last ^ wanted;
    const unsigned used = coder.code(used_, ((change & 255U) != 0 ? 1U : 0U) | (change > 255U ? 2U : 0U));
    std::uint32_t next = last;
    for (unsigned half = 0; half < 2; ++half) {
      if ((used & (1U << half)) == 0) continue;
      differences_[half].reset_once();
      const unsigned before = static_cast<unsigned>(last) >> (8U * half);
      const unsigned after = static_cast<unsigned>(wanted) >> (8U * half);
      const std::uint32_t byte = (before + coder.code(differences_[half], (after - before) & 255U)) & 255U;
      next = (next & ~(255U << (8U * half))) | (byte << (8U * half));
    }
    return static_cast<std::uint16_t>(next);
  }

 private:
  SymbolModel<4> used_;
  std::array<SymbolModel<256>, 2> differences_;
};

/// A byte of which nothing is known: its difference from the last one.
template <typename Coder>
class ByteCoder {
 public:
  std::uint8_t code(Coder& coder, std::uint8_t last, std::uint8_t wanted) {
    model_.reset_once();
    return static_cast<std::uint8_t>(last + coder.code(model_, (wanted - last) & 255U));
  }

 private:
  SymbolModel<256> model_;
};

}  // namespace limen::laz
