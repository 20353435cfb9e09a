// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/laz_encoder.h"

#include "limen/io/las/laz/laz_prediction.h"

/// Encoders of the parts of points, for tests: what limen writes is held against them. Written from the
/// description of the format, not from limen's coders; running medians and wrapping sums are shared.
namespace limen::testing_laz {

using laz::clamp_to_byte;
using laz::get;
using laz::RunningMedian;

inline std::uint8_t byte_of(const char* record, std::size_t at) {
  return static_cast<std::uint8_t>(record[at]);
}

/// Versions 2 (`stays`) and 3 of GPS times.
template <bool stays>
class TimeEncoder {
 public:
  void start(std::uint64_t time) { times_[0] = time; }

  void encode(Encoder& encoder, std::uint64_t time) {
    const auto step = static_cast<std::int64_t>(time - times_[now_]);
    if (steps_[now_] == 0) {
      if (stays && step == 0) return encoder.symbol(first_, 0);
      if (fits(step)) {
        encoder.symbol(first_, kFirst);
        numbers_.encode(encoder, static_cast<std::int32_t>(step), 0, 0);
        steps_[now_] = static_cast<std::int32_t>(step);
        odd_[now_] = 0;
        times_[now_] = time;
      } else if (const unsigned other = sequence_for(time)) {
        encoder.symbol(first_, kFirst + 1 + other);
        now_ = (now_ + other) & 3U;
        encode(encoder, time);
      } else {
        encoder.symbol(first_, kFirst + 1);
        begin(encoder, time);
      }
      return;
    }
    if (stays && step == 0) return encoder.symbol(multiples_, 511);
    if (fits(step)) return encode_multiple(encoder, time, static_cast<std::int32_t>(step));
    if (const unsigned other = sequence_for(time)) {
      encoder.symbol(multiples_, kFull + other);
      now_ = (now_ + other) & 3U;
      return encode(encoder, time);
    }
    encoder.symbol(multiples_, kFull);
    begin(encoder, time);
  }

 private:
  static constexpr unsigned kFirst = stays ? 1 : 0;
  static constexpr unsigned kFull = stays ? 512 : 511;

  static bool fits(std::int64_t step) { return step == static_cast<std::int32_t>(step); }
  unsigned sequence_for(std::uint64_t time) const {
    for (unsigned k = 1; k < 4; ++k) {
      if (fits(static_cast<std::int64_t>(time - times_[(now_ + k) & 3U]))) return k;
    }
    return 0;
  }

  void encode_multiple(Encoder& encoder, std::uint64_t time, std::int32_t step) {
    const std::int32_t usual = steps_[now_];
    const auto multiple = static_cast<std::int64_t>(std::round(static_cast<double>(step) / usual));
    const auto predicted = [&](std::int32_t by) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(by) * static_cast<std::uint32_t>(usual));
    };
    bool odd = false;
    if (multiple == 1) {
      encoder.symbol(multiples_, 1);
      numbers_.encode(encoder, step, usual, 1);
      odd_[now_] = 0;
    } else if (multiple > 0) {
      const auto by = static_cast<std::int32_t>(std::min<std::int64_t>(multiple, 500));
      encoder.symbol(multiples_, static_cast<unsigned>(by));
      numbers_.encode(encoder, step, predicted(by), by < 10 ? 2 : (by < 500 ? 3 : 4));
      odd = by == 500;
    } else if (multiple < 0) {
      const auto by = static_cast<std::int32_t>(std::max<std::int64_t>(multiple, -10));
      encoder.symbol(multiples_, static_cast<unsigned>(500 - by));
      numbers_.encode(encoder, step, predicted(by), by > -10 ? 5 : 6);
      odd = by == -10;
    } else {
      encoder.symbol(multiples_, 0);
      numbers_.encode(encoder, step, 0, 7);
      odd = true;
    }
    if (odd && ++odd_[now_] > 3) {
      steps_[now_] = step;
      odd_[now_] = 0;
    }
    times_[now_] = time;
  }

  void begin(Encoder& encoder, std::uint64_t time) {
    const auto upper = static_cast<std::int32_t>(times_[now_] >> 32U);
    numbers_.encode(encoder, static_cast<std::int32_t>(time >> 32U), upper, 8);
    encoder.word(static_cast<std::uint32_t>(time));
    newest_ = (newest_ + 1) & 3U;
    now_ = newest_;
    times_[now_] = time;
    steps_[now_] = 0;
    odd_[now_] = 0;
  }

  unsigned now_ = 0;
  unsigned newest_ = 0;
  std::array<std::uint64_t, 4> times_{};
  std::array<std::int32_t, 4> steps_{};
  std::array<int, 4> odd_{};
  SymbolModel<stays ? 6 : 5> first_;
  SymbolModel<stays ? 516 : 515> multiples_;
  IntegerEncoder<32, 9> numbers_;
};

class ColourEncoder {
 public:
  void encode(Encoder& encoder, const char* last, const char* next) {
    std::array<int, 6> was{};
    std::array<int, 6> is{};
    for (std::size_t k = 0; k < 6; ++k) {  // red low, red high, green low, ...
      was[k] = byte_of(last, k);
      is[k] = byte_of(next, k);
    }
    unsigned used = 0;
    for (std::size_t k = 0; k < 6; ++k) used |= was[k] != is[k] ? 1U << k : 0U;
    const bool grey = is[0] == is[2] && is[0] == is[4] && is[1] == is[3] && is[1] == is[5];
    used |= grey ? 0U : 64U;
    encoder.symbol(used_, used);
    const auto put = [&](std::size_t k, int drift) {
      if ((used & (1U << k)) == 0) return;
      encoder.symbol(differences_[k],
                     static_cast<unsigned>(is[k] - static_cast<int>(clamp_to_byte(was[k] + drift))) & 255U);
    };
    put(0, 0);
    put(1, 0);
    if (grey) return;
    for (std::size_t half = 0; half < 2; ++half) {
      const int red = is[half] - was[half];
      put(2 + half, red);
      put(4 + half, (red + is[2 + half] - was[2 + half]) / 2);
    }
  }

 private:
  SymbolModel<128> used_;
  std::array<SymbolModel<256>, 6> differences_;
};

class PacketEncoder {
 public:
  void encode(Encoder& encoder, const char* last, const char* next) {
    encoder.symbol(index_, byte_of(next, 0));
    const auto step = static_cast<std::int64_t>(get<std::uint64_t>(next + 1) - get<std::uint64_t>(last + 1));
    const bool fits = step == static_cast<std::int32_t>(step);
    const unsigned kind = step == 0 ? 0 : (step == get<std::uint32_t>(last + 9) ? 1 : (fits ? 2 : 3));
    encoder.symbol(kinds_[kind_], kind);
    kind_ = kind;
    if (kind == 2) {
      offset_.encode(encoder, static_cast<std::int32_t>(step), step_);
      step_ = static_cast<std::int32_t>(step);
    } else if (kind == 3) {
      encoder.word(get<std::uint32_t>(next + 1));
      encoder.word(get<std::uint32_t>(next + 5));
    }
    size_.encode(encoder, get<std::int32_t>(next + 9), get<std::int32_t>(last + 9));
    return_.encode(encoder, get<std::int32_t>(next + 13), get<std::int32_t>(last + 13));
    for (unsigned k = 0; k < 3; ++k)
      direction_.encode(encoder, get<std::int32_t>(next + 17 + 4 * k), get<std::int32_t>(last + 17 + 4 * k),
                        k);
  }

 private:
  unsigned kind_ = 0;
  std::int32_t step_ = 0;
  SymbolModel<256> index_;
  std::array<SymbolModel<4>, 4> kinds_;
  IntegerEncoder<32, 1> offset_;
  IntegerEncoder<32, 1> size_;
  IntegerEncoder<32, 1> return_;
  IntegerEncoder<32, 3> direction_;
};

class InfraredEncoder {
 public:
  void encode(Encoder& encoder, const char* last, const char* next) {
    const unsigned used = (last[0] != next[0] ? 1U : 0U) | (last[1] != next[1] ? 2U : 0U);
    encoder.symbol(used_, used);
    for (std::size_t k = 0; k < 2; ++k) {
      if (last[k] != next[k]) encoder.symbol(differences_[k], static_cast<std::uint8_t>(next[k] - last[k]));
    }
  }

 private:
  SymbolModel<4> used_;
  std::array<SymbolModel<256>, 2> differences_;
};

class ByteEncoder {
 public:
  void encode(Encoder& encoder, const char* last, const char* next) {
    encoder.symbol(model_, static_cast<std::uint8_t>(*next - *last));
  }

 private:
  SymbolModel<256> model_;
};

/// Version 2 of the 20 bytes of formats 0 to 5.
class Point10Encoder {
 public:
  void start(const char* raw) { last_.assign(raw, 20); }

  void encode(Encoder& encoder, const char* next) {
    static constexpr int kMap[8][8] = {{15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},
                                       {13, 1, 2, 4, 7, 11, 11, 10},    {12, 3, 4, 5, 8, 12, 12, 11},
                                       {11, 6, 7, 8, 9, 13, 13, 12},    {10, 10, 11, 12, 13, 14, 14, 13},
                                       {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15}};
    const char* last = last_.data();
    const int r = byte_of(next, 14) & 7;
    const int n = (byte_of(next, 14) >> 3) & 7;
    const auto m = static_cast<unsigned>(kMap[n][r]);
    const auto l = static_cast<unsigned>(std::abs(n - r));
    const auto intensity = get<std::uint16_t>(next + 12);
    const unsigned changed = (last[14] != next[14] ? 32U : 0U) | (intensities_[m] != intensity ? 16U : 0U) |
                             (last[15] != next[15] ? 8U : 0U) | (last[16] != next[16] ? 4U : 0U) |
                             (last[17] != next[17] ? 2U : 0U) |
                             (get<std::uint16_t>(last + 18) != get<std::uint16_t>(next + 18) ? 1U : 0U);
    encoder.symbol(changed_, changed);
    if ((changed & 32U) != 0) encoder.symbol(bytes_[0][byte_of(last, 14)], byte_of(next, 14));
    if ((changed & 16U) != 0) intensity_.encode(encoder, intensity, intensities_[m], std::min(m, 3U));
    intensities_[m] = intensity;
    if ((changed & 8U) != 0) encoder.symbol(bytes_[1][byte_of(last, 15)], byte_of(next, 15));
    if ((changed & 4U) != 0)
      encoder.symbol(angles_[(byte_of(next, 14) >> 6) & 1], static_cast<std::uint8_t>(next[16] - last[16]));
    if ((changed & 2U) != 0) encoder.symbol(bytes_[2][byte_of(last, 17)], byte_of(next, 17));
    if ((changed & 1U) != 0)
      source_.encode(encoder, get<std::uint16_t>(next + 18), get<std::uint16_t>(last + 18));
    encode_place(encoder, next, m, l, n == 1 ? 1 : 0);
    last_.assign(next, 20);
  }

 private:
  void encode_place(Encoder& encoder, const char* next, unsigned m, unsigned l, unsigned single) {
    const auto step = [&](std::size_t at) {
      return laz::wrapping_sum(get<std::int32_t>(next + at),
                               laz::wrapping_product(get<std::int32_t>(last_.data() + at), -1));
    };
    dx_.encode(encoder, step(0), x_[m].get(), single);
    x_[m].add(step(0));
    const unsigned kx = dx_.bit_count();
    dy_.encode(encoder, step(4), y_[m].get(), single + (kx < 20 ? kx / 2 * 2 : 20));
    y_[m].add(step(4));
    const unsigned k = (kx + dy_.bit_count()) / 2;
    const auto z = get<std::int32_t>(next + 8);
    z_.encode(encoder, z, heights_[l], single + (k < 18 ? k / 2 * 2 : 18));
    heights_[l] = z;
  }

  std::string last_;
  std::array<RunningMedian, 16> x_;
  std::array<RunningMedian, 16> y_;
  std::array<std::uint16_t, 16> intensities_{};
  std::array<std::int32_t, 8> heights_{};
  SymbolModel<64> changed_;
  std::array<std::map<unsigned, SymbolModel<256>>, 3> bytes_;
  std::array<SymbolModel<256>, 2> angles_;
  IntegerEncoder<16, 4> intensity_;
  IntegerEncoder<16, 1> source_;
  IntegerEncoder<32, 2> dx_;
  IntegerEncoder<32, 22> dy_;
  IntegerEncoder<32, 20> z_;
};

}  // namespace limen::testing_laz
