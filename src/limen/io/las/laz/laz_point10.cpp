// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_point10.h"

#include <algorithm>
#include <array>
#include <memory>

#include "limen/io/las/laz/laz_items.h"

namespace limen::laz {
namespace {

class Point10V2 : public PointItem {
 public:
  void start(const char* raw) override { points_.start(get<Point10>(raw)); }
  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;  // in registers
    put(out, points_.code(decoder, {}));
    shared = decoder;
  }

 private:
  Point10Coder<Decoder> points_;
};

std::int32_t median_of_three(const std::array<std::int32_t, 3>& values) {
  return std::max(std::min(values[0], values[1]), std::min(std::max(values[0], values[1]), values[2]));
}

class Point10V1 : public PointItem {
 public:
  Point10V1() { changed_.reset(); }

  void start(const char* raw) override { std::copy_n(raw, kPoint10Bytes, last_.begin()); }

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
    std::copy_n(last_.begin(), kPoint10Bytes, out);
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

  Point10 last_{};
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
