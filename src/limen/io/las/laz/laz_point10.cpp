// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <vector>

#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_items.h"
#include "limen/io/las/laz/laz_prediction.h"

// The 20 bytes that all points of formats 0 to 5 begin with: x y z (4 each), intensity (2), returns and
// flags, classification, scan angle, user data (1 each), point source (2).

namespace limen::laz {
namespace {

constexpr std::size_t kBytes = 20;
constexpr std::size_t kIntensity10 = 12;
constexpr std::size_t kReturns10 = 14;
constexpr std::size_t kClass10 = 15;
constexpr std::size_t kAngle10 = 16;
constexpr std::size_t kUser10 = 17;
constexpr std::size_t kSource10 = 18;

/// Context of a return, by number of returns and return number.
constexpr std::array<std::array<std::uint8_t, 8>, 8> kReturnContexts10{{
    {15, 14, 13, 12, 11, 10, 9, 8},
    {14, 0, 1, 3, 6, 10, 10, 9},
    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},
    {11, 6, 7, 8, 9, 13, 13, 12},
    {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14},
    {8, 9, 10, 11, 12, 13, 14, 15},
}};

/// Bytes that are predicted by the same byte of the last point.
using ByteAfterByte = ModelPerValue<256, 256>;

std::uint8_t byte_at(const std::array<char, kBytes>& point, std::size_t at) {
  return static_cast<std::uint8_t>(point[at]);
}

class Point10V2 : public PointItem {
 public:
  Point10V2() {
    changed_.reset();
    for (SymbolModel<256>& model : angles_) model.reset();
  }

  void start(const char* raw) override { std::copy_n(raw, kBytes, last_.begin()); }

  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;  // in registers
    const unsigned changed = decoder.symbol(changed_);
    if ((changed & 32U) != 0)
      last_[kReturns10] = static_cast<char>(returns_.decode(decoder, byte_at(last_, kReturns10)));
    const unsigned returns = byte_at(last_, kReturns10);
    const unsigned number = returns & 7U;
    const unsigned of = (returns >> 3U) & 7U;
    const unsigned context = kReturnContexts10[of][number];
    decode_intensity(decoder, changed, context);
    decode_bytes(decoder, changed);
    const unsigned single = of == 1 ? 1 : 0;
    const unsigned level = of > number ? of - number : number - of;
    decode_place(decoder, context, level, single);
    std::copy_n(last_.begin(), kBytes, out);
    shared = decoder;
  }

 private:
  void decode_intensity(Decoder& decoder, unsigned changed, unsigned context) {
    std::uint16_t& intensity = intensities_[context];
    if ((changed & 16U) != 0) {
      intensity = static_cast<std::uint16_t>(intensity_.decode(decoder, intensity, std::min(context, 3U)));
    }
    put(&last_[kIntensity10], intensity);
  }

  void decode_bytes(Decoder& decoder, unsigned changed) {
    if ((changed & 8U) != 0)
      last_[kClass10] = static_cast<char>(classes_.decode(decoder, byte_at(last_, kClass10)));
    if ((changed & 4U) != 0) {
      SymbolModel<256>& model = angles_[(byte_at(last_, kReturns10) >> 6U) & 1U];
      last_[kAngle10] = static_cast<char>(byte_at(last_, kAngle10) + decoder.symbol(model));
    }
    if ((changed & 2U) != 0)
      last_[kUser10] = static_cast<char>(users_.decode(decoder, byte_at(last_, kUser10)));
    if ((changed & 1U) != 0) {
      const auto source = source_.decode(decoder, get<std::uint16_t>(&last_[kSource10]));
      put(&last_[kSource10], static_cast<std::uint16_t>(source));
    }
  }

  void decode_place(Decoder& decoder, unsigned context, unsigned level, unsigned single) {
    const std::int32_t dx = dx_.decode(decoder, x_steps_[context].get(), single);
    x_steps_[context].add(dx);
    const unsigned x_bits = dx_.bit_count();
    const std::int32_t dy =
        dy_.decode(decoder, y_steps_[context].get(), single + (x_bits < 20 ? x_bits & ~1U : 20U));
    y_steps_[context].add(dy);
    const unsigned bits = (x_bits + dy_.bit_count()) / 2;
    heights_[level] = z_.decode(decoder, heights_[level], single + (bits < 18 ? bits & ~1U : 18U));
    put(last_.data(), wrapping_sum(get<std::int32_t>(last_.data()), dx));
    put(&last_[4], wrapping_sum(get<std::int32_t>(&last_[4]), dy));
    put(&last_[8], heights_[level]);
  }

  std::array<char, kBytes> last_{};
  std::array<RunningMedian, 16> x_steps_;
  std::array<RunningMedian, 16> y_steps_;
  std::array<std::uint16_t, 16> intensities_{};
  std::array<std::int32_t, 8> heights_{};
  SymbolModel<64> changed_;
  std::array<SymbolModel<256>, 2> angles_;
  ByteAfterByte returns_;
  ByteAfterByte classes_;
  ByteAfterByte users_;
  IntegerDecoder<16, 4> intensity_;
  IntegerDecoder<16, 1> source_;
  IntegerDecoder<32, 2> dx_;
  IntegerDecoder<32, 22> dy_;
  IntegerDecoder<32, 20> z_;
};

std::int32_t median_of_three(const std::array<std::int32_t, 3>& values) {
  return std::max(std::min(values[0], values[1]), std::min(std::max(values[0], values[1]), values[2]));
}

class Point10V1 : public PointItem {
 public:
  Point10V1() { changed_.reset(); }

  void start(const char* raw) override { std::copy_n(raw, kBytes, last_.begin()); }

  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;
    const std::int32_t dx = dx_.decode(decoder, median_of_three(x_steps_));
    const unsigned x_bits = dx_.bit_count();
    const std::int32_t dy = dy_.decode(decoder, median_of_three(y_steps_), std::min(x_bits, 19U));
    const unsigned bits = (x_bits + dy_.bit_count()) / 2;
    put(last_.data(), wrapping_sum(get<std::int32_t>(last_.data()), dx));
    put(&last_[4], wrapping_sum(get<std::int32_t>(&last_[4]), dy));
    put(&last_[8], z_.decode(decoder, get<std::int32_t>(&last_[8]), std::min(bits, 19U)));
    decode_rest(decoder, decoder.symbol(changed_), bits);
    x_steps_[oldest_] = dx;
    y_steps_[oldest_] = dy;
    oldest_ = (oldest_ + 1) % 3;
    std::copy_n(last_.begin(), kBytes, out);
    shared = decoder;
  }

 private:
  void decode_rest(Decoder& decoder, unsigned changed, unsigned bits) {
    if ((changed & 32U) != 0) decode_short(decoder, intensity_, kIntensity10);
    if ((changed & 16U) != 0)
      last_[kReturns10] = static_cast<char>(returns_.decode(decoder, byte_at(last_, kReturns10)));
    if ((changed & 8U) != 0)
      last_[kClass10] = static_cast<char>(classes_.decode(decoder, byte_at(last_, kClass10)));
    if ((changed & 4U) != 0)
      last_[kAngle10] =
          static_cast<char>(angle_.decode(decoder, byte_at(last_, kAngle10), bits < 3 ? 1U : 0U));
    if ((changed & 2U) != 0)
      last_[kUser10] = static_cast<char>(users_.decode(decoder, byte_at(last_, kUser10)));
    if ((changed & 1U) != 0) decode_short(decoder, source_, kSource10);
  }
  void decode_short(Decoder& decoder, IntegerDecoder<16, 1>& number, std::size_t at) {
    put(&last_[at], static_cast<std::uint16_t>(number.decode(decoder, get<std::uint16_t>(&last_[at]))));
  }

  std::array<char, kBytes> last_{};
  std::array<std::int32_t, 3> x_steps_{};
  std::array<std::int32_t, 3> y_steps_{};
  std::size_t oldest_ = 0;
  SymbolModel<64> changed_;
  ByteAfterByte returns_;
  ByteAfterByte classes_;
  ByteAfterByte users_;
  IntegerDecoder<16, 1> intensity_;
  IntegerDecoder<8, 2> angle_;
  IntegerDecoder<16, 1> source_;
  IntegerDecoder<32, 1> dx_;
  IntegerDecoder<32, 20> dy_;
  IntegerDecoder<32, 20> z_;
};

}  // namespace

std::unique_ptr<PointItem> make_point10(int version) {
  if (version == 1) return std::make_unique<Point10V1>();
  if (version == 2) return std::make_unique<Point10V2>();
  return nullptr;
}

}  // namespace limen::laz
