// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_items.h"

#include <cstring>

#include "limen/io/las/laz/laz_colours.h"
#include "limen/io/las/laz/laz_gps_time.h"
#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_prediction.h"
#include "limen/io/las/laz/laz_wave_packet.h"

namespace limen::laz {
namespace {

class GpsTimeV2 : public PointItem {
 public:
  void start(const char* raw) override { times_.start(get<std::uint64_t>(raw)); }
  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;
    put(out, times_.code(decoder, 0));
    shared = decoder;
  }

 private:
  GpsTimeCoder<Decoder, true> times_;
};

/// Version 1: one sequence of times.
class GpsTimeV1 : public PointItem {
 public:
  void start(const char* raw) override { time_ = get<std::uint64_t>(raw); }

  void decode(Decoder& decoder, char* out) override {
    if (step_ == 0) {
      decode_first(decoder);
    } else {
      decode_multiple(decoder);
    }
    put(out, time_);
  }

 private:
  static constexpr unsigned kMost = 509;  ///< largest multiple; 510: a time of its own, 511: unchanged

  void decode_first(Decoder& decoder) {
    first_.reset_once();
    const unsigned found = decoder.symbol(first_);
    if (found == 1) {
      step_ = differences_.decode(decoder, 0, 0);
      advance(step_);
    } else if (found == 2) {
      time_ = decoder.long_word();
    }
  }

  void decode_multiple(Decoder& decoder) {
    multiples_.reset_once();
    const unsigned found = decoder.symbol(multiples_);
    if (found == kMost + 1) time_ = decoder.long_word();
    if (found > kMost) return;
    const unsigned context = found == 1 ? 1 : (found == 0 ? 2 : (found < 10 ? 3 : (found < 50 ? 4 : 5)));
    const std::int32_t predicted =
        found == 0 ? step_ / 4 : wrapping_product(static_cast<std::int32_t>(found), step_);
    const std::int32_t difference = differences_.decode(decoder, predicted, context);
    const bool odd = (found == 0 || found == kMost) && ++odd_ > 3;
    if (found == 1 || odd) {
      step_ = difference;
      odd_ = 0;
    }
    advance(difference);
  }

  void advance(std::int32_t step) { time_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(step)); }

  std::uint64_t time_ = 0;
  std::int32_t step_ = 0;
  int odd_ = 0;
  SymbolModel<3> first_;
  SymbolModel<512> multiples_;
  IntegerDecoder<32, 6> differences_;
};

class ColoursV2 : public PointItem {
 public:
  void start(const char* raw) override { last_ = get<Colour>(raw); }
  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;
    last_ = colours_.code(decoder, last_, {});
    put(out, last_);
    shared = decoder;
  }

 private:
  Colour last_{};
  ColourCoder<Decoder> colours_;
};

/// Version 1: each byte is predicted by the last one.
class ColoursV1 : public PointItem {
 public:
  void start(const char* raw) override { std::memcpy(last_.data(), raw, last_.size()); }
  void decode(Decoder& decoder, char* out) override {
    used_.reset_once();
    const unsigned used = decoder.symbol(used_);
    for (unsigned k = 0; k < last_.size(); ++k) {
      if ((used & (1U << k)) != 0) last_[k] = static_cast<std::uint8_t>(bytes_.decode(decoder, last_[k], k));
    }
    std::memcpy(out, last_.data(), last_.size());
  }

 private:
  std::array<std::uint8_t, 6> last_{};
  SymbolModel<64> used_;
  IntegerDecoder<8, 6> bytes_;
};

class BytesV2 : public PointItem {
 public:
  explicit BytesV2(std::size_t count) : last_(count), bytes_(count) {}

  void start(const char* raw) override { std::memcpy(last_.data(), raw, last_.size()); }
  void decode(Decoder& shared, char* out) override {
    Decoder decoder = shared;
    for (std::size_t k = 0; k < last_.size(); ++k) last_[k] = bytes_[k].code(decoder, last_[k], 0);
    std::memcpy(out, last_.data(), last_.size());
    shared = decoder;
  }

 private:
  std::vector<std::uint8_t> last_;
  std::vector<ByteCoder<Decoder>> bytes_;
};

/// Version 1: the number of bits has a model per byte, what follows is shared.
class BytesV1 : public PointItem {
 public:
  explicit BytesV1(std::size_t count) : last_(count) {}

  void start(const char* raw) override { std::memcpy(last_.data(), raw, last_.size()); }
  void decode(Decoder& decoder, char* out) override {
    for (std::size_t k = 0; k < last_.size(); ++k) {
      last_[k] = static_cast<std::uint8_t>(bytes_.decode(decoder, last_[k], static_cast<unsigned>(k)));
    }
    std::memcpy(out, last_.data(), last_.size());
  }

  static constexpr unsigned kMost = 64;

 private:
  std::vector<std::uint8_t> last_;
  IntegerDecoder<8, kMost> bytes_;
};

class WavePacketV1 : public PointItem {
 public:
  void start(const char* raw) override { last_ = get<WavePacket>(raw); }
  void decode(Decoder& decoder, char* out) override {
    last_ = packets_.code(decoder, last_, {});
    put(out, last_);
  }

 private:
  WavePacket last_{};
  WavePacketCoder<Decoder> packets_;
};

}  // namespace

std::unique_ptr<PointItem> make_gps_time11(int version) {
  if (version == 1) return std::make_unique<GpsTimeV1>();
  if (version == 2) return std::make_unique<GpsTimeV2>();
  return nullptr;
}

std::unique_ptr<PointItem> make_rgb12(int version) {
  if (version == 1) return std::make_unique<ColoursV1>();
  if (version == 2) return std::make_unique<ColoursV2>();
  return nullptr;
}

std::unique_ptr<PointItem> make_bytes(int version, std::size_t count) {
  if (version == 1 && count <= BytesV1::kMost) return std::make_unique<BytesV1>(count);
  if (version == 2) return std::make_unique<BytesV2>(count);
  return nullptr;
}

std::unique_ptr<PointItem> make_wave_packet13(int version) {
  return version == 1 ? std::make_unique<WavePacketV1>() : nullptr;
}

}  // namespace limen::laz
