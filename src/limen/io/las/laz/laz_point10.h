// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"

/// The 20 bytes that all points of formats 0 to 5 begin with: x y z (4 each), intensity (2), returns and
/// flags, classification, scan angle, user data (1 each), point source (2).
namespace limen::laz {

inline constexpr std::size_t kPoint10Bytes = 20;
inline constexpr std::size_t kIntensity10 = 12;
inline constexpr std::size_t kReturns10 = 14;
inline constexpr std::size_t kClass10 = 15;
inline constexpr std::size_t kAngle10 = 16;
inline constexpr std::size_t kUser10 = 17;
inline constexpr std::size_t kSource10 = 18;

/// Context of a return, by number of returns and return number.
inline constexpr std::array<std::array<std::uint8_t, 8>, 8> kReturnContexts10{{
    {15, 14, 13, 12, 11, 10, 9, 8},
    {14, 0, 1, 3, 6, 10, 10, 9},
    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},
    {11, 6, 7, 8, 9, 13, 13, 12},
    {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14},
    {8, 9, 10, 11, 12, 13, 14, 15},
}};

using Point10 = std::array<char, kPoint10Bytes>;

/// Bytes that are predicted by the same byte of the last point.
using ByteAfterByte = ModelPerValue<256, 256>;

inline std::uint8_t byte_at(const Point10& point, std::size_t at) {
  return static_cast<std::uint8_t>(point[at]);
}

/// Version 2 of them: what changes, then the parts that do, then the place.
template <typename Coder>
class Point10Coder {
 public:
  Point10Coder() {
    changed_.reset();
    for (SymbolModel<256>& model : angles_) model.reset();
  }

  void start(const Point10& first) { last_ = first; }

  const Point10& code(Coder& coder, const Point10& wanted) {
    const unsigned changed = coder.code(changed_, Coder::kEncodes ? changed_by(wanted) : 0U);
    if ((changed & 32U) != 0) code_byte(coder, returns_, kReturns10, wanted);
    const unsigned returns = byte_at(last_, kReturns10);
    const unsigned number = returns & 7U;
    const unsigned of = (returns >> 3U) & 7U;
    const unsigned context = kReturnContexts10[of][number];
    code_intensity(coder, changed, context, wanted);
    code_rest(coder, changed, wanted);
    const unsigned single = of == 1 ? 1 : 0;
    const unsigned level = of > number ? of - number : number - of;
    code_place(coder, {context, level, single}, wanted);
    return last_;
  }

 private:
  /// What a place is predicted by.
  struct PlaceContext {
    unsigned context;
    unsigned level;
    unsigned single;
  };

  [[nodiscard]] unsigned changed_by(const Point10& wanted) const {
    const unsigned returns = byte_at(wanted, kReturns10);
    const unsigned context = kReturnContexts10[(returns >> 3U) & 7U][returns & 7U];
    const auto differs = [&](std::size_t at) { return last_[at] != wanted[at]; };
    return (differs(kReturns10) ? 32U : 0U) |
           (intensities_[context] != get<std::uint16_t>(&wanted[kIntensity10]) ? 16U : 0U) |
           (differs(kClass10) ? 8U : 0U) | (differs(kAngle10) ? 4U : 0U) | (differs(kUser10) ? 2U : 0U) |
           (differs(kSource10) || differs(kSource10 + 1) ? 1U : 0U);
  }

  void code_byte(Coder& coder, ByteAfterByte& models, std::size_t at, const Point10& wanted) {
    last_[at] = static_cast<char>(coder.code(models.of(byte_at(last_, at)), byte_at(wanted, at)));
  }

  void code_intensity(Coder& coder, unsigned changed, unsigned context, const Point10& wanted) {
    std::uint16_t& intensity = intensities_[context];
    if ((changed & 16U) != 0) {
      const auto value = get<std::uint16_t>(&wanted[kIntensity10]);
      intensity = static_cast<std::uint16_t>(intensity_.code(coder, value, intensity, std::min(context, 3U)));
    }
    put(&last_[kIntensity10], intensity);
  }

  void code_rest(Coder& coder, unsigned changed, const Point10& wanted) {
    if ((changed & 8U) != 0) code_byte(coder, classes_, kClass10, wanted);
    if ((changed & 4U) != 0) {
      SymbolModel<256>& model = angles_[(byte_at(last_, kReturns10) >> 6U) & 1U];
      const unsigned before = byte_at(last_, kAngle10);
      last_[kAngle10] =
          static_cast<char>(before + coder.code(model, (byte_at(wanted, kAngle10) - before) & 255U));
    }
    if ((changed & 2U) != 0) code_byte(coder, users_, kUser10, wanted);
    if ((changed & 1U) != 0) {
      const auto source =
          source_.code(coder, get<std::uint16_t>(&wanted[kSource10]), get<std::uint16_t>(&last_[kSource10]));
      put(&last_[kSource10], static_cast<std::uint16_t>(source));
    }
  }

  void code_place(Coder& coder, const PlaceContext& about, const Point10& wanted) {
    const auto step = [&](std::size_t at) {
      return wrapping_difference(get<std::int32_t>(&wanted[at]), get<std::int32_t>(&last_[at]));
    };
    RunningMedian& x_steps = x_steps_[about.context];
    RunningMedian& y_steps = y_steps_[about.context];
    const std::int32_t dx = dx_.code(coder, step(0), x_steps.get(), about.single);
    x_steps.add(dx);
    const unsigned x_bits = dx_.bit_count();
    const std::int32_t dy =
        dy_.code(coder, step(4), y_steps.get(), about.single + (x_bits < 20 ? x_bits & ~1U : 20U));
    y_steps.add(dy);
    const unsigned bits = (x_bits + dy_.bit_count()) / 2;
    std::int32_t& height = heights_[about.level];
    height =
        z_.code(coder, get<std::int32_t>(&wanted[8]), height, about.single + (bits < 18 ? bits & ~1U : 18U));
    put(last_.data(), wrapping_sum(get<std::int32_t>(last_.data()), dx));
    put(&last_[4], wrapping_sum(get<std::int32_t>(&last_[4]), dy));
    put(&last_[8], height);
  }

  Point10 last_{};
  std::array<RunningMedian, 16> x_steps_;
  std::array<RunningMedian, 16> y_steps_;
  std::array<std::uint16_t, 16> intensities_{};
  std::array<std::int32_t, 8> heights_{};
  SymbolModel<64> changed_;
  std::array<SymbolModel<256>, 2> angles_;
  ByteAfterByte returns_;
  ByteAfterByte classes_;
  ByteAfterByte users_;
  IntegerCoder<Coder, 16, 4> intensity_;
  IntegerCoder<Coder, 16, 1> source_;
  IntegerCoder<Coder, 32, 2> dx_;
  IntegerCoder<Coder, 32, 22> dy_;
  IntegerCoder<Coder, 32, 20> z_;
};

}  // namespace limen::laz
