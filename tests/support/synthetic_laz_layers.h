// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/synthetic_laz_items.h"

/// Encoders of layered chunks (formats 6 to 10), for tests.
namespace limen::testing_laz {

/// One layer: its message, and whether any value in it changed.
struct EncodedLayer {
  Encoder encoder;
  bool changed = false;

  std::string finish() { return changed ? encoder.finish() : std::string(); }
};

/// The 30 bytes of points, nine layers.
class Point14Encoder {
 public:
  std::array<EncodedLayer, 9> layers;

  explicit Point14Encoder(const char* raw) {
    layers[0].changed = true;
    current_ = channel_of(raw);
    begin(current_, raw);
  }

  /// The channel it comes from, and whether its own is new.
  struct Step {
    unsigned from;
    unsigned channel;
    bool fresh;
  };

  Step encode(const char* next) {
    const unsigned from = current_;
    const unsigned to = channel_of(next);
    Channel* channel = channels_[from].get();
    const std::string old = channel->last;
    const unsigned kind = (number(old.data()) == 1 ? 1U : 0U) +
                          (number(old.data()) >= of(old.data()) ? 2U : 0U) +
                          (channel->time_changed ? 4U : 0U);
    Channel* before = channel;
    const bool fresh = to != from && !channels_[to];
    if (fresh) begin(to, old.data());
    if (to != from) channel = channels_[to].get();
    const char* last = channel->last.data();
    const bool time = get<std::uint64_t>(last + 22) != get<std::uint64_t>(next + 22);
    const unsigned rise = (number(next) - number(last)) & 15U;
    const unsigned returns = rise == 0 ? 0 : (rise == 1 ? 1 : (rise == 15 ? 2 : 3));
    const unsigned changed = (to != from ? 64U : 0U) |
                             (get<std::uint16_t>(last + 20) != get<std::uint16_t>(next + 20) ? 32U : 0U) |
                             (time ? 16U : 0U) |
                             (get<std::int16_t>(last + 18) != get<std::int16_t>(next + 18) ? 8U : 0U) |
                             (of(last) != of(next) ? 4U : 0U) | returns;
    Encoder& place = layers[0].encoder;
    place.symbol(before->changed[kind], changed);
    if (to != from) place.symbol(before->channel, (to - from - 1) & 3U);
    if ((changed & 4U) != 0) place.symbol(channel->of[of(last)], of(next));
    if (returns == 3 && time) place.symbol(channel->number[number(last)], number(next));
    if (returns == 3 && !time) place.symbol(channel->number_same_time, rise - 2);
    encode_values(*channel, next, time, changed);
    channel->last.assign(next, 30);
    channel->time_changed = time;
    current_ = to;
    return {from, to, fresh};
  }

 private:
  struct Channel {
    std::string last;
    bool time_changed = false;
    std::array<RunningMedian, 12> x;
    std::array<RunningMedian, 12> y;
    std::array<std::int32_t, 8> heights{};
    std::array<std::uint16_t, 8> intensities{};
    std::array<SymbolModel<128>, 8> changed;
    SymbolModel<3> channel;
    std::map<unsigned, SymbolModel<16>> of;
    std::map<unsigned, SymbolModel<16>> number;
    SymbolModel<13> number_same_time;
    std::map<unsigned, SymbolModel<256>> classes;
    std::map<unsigned, SymbolModel<64>> flags;
    std::map<unsigned, SymbolModel<256>> users;
    IntegerEncoder<32, 2> dx;
    IntegerEncoder<32, 22> dy;
    IntegerEncoder<32, 20> z;
    IntegerEncoder<16, 4> intensity;
    IntegerEncoder<16, 2> angle;
    IntegerEncoder<16, 1> source;
    TimeEncoder<false> time;
  };

  static unsigned channel_of(const char* record) { return (byte_of(record, 15) >> 4U) & 3U; }
  static unsigned number(const char* record) { return byte_of(record, 14) & 15U; }
  static unsigned of(const char* record) { return byte_of(record, 14) >> 4U; }
  static unsigned flags(const char* record) {
    const unsigned byte = byte_of(record, 15);
    return (byte & 15U) | (((byte >> 6U) & 1U) << 4U) | ((byte >> 7U) << 5U);
  }

  void begin(unsigned channel, const char* raw) {
    channels_[channel] = std::make_unique<Channel>();
    channels_[channel]->last.assign(raw, 30);
    channels_[channel]->heights.fill(get<std::int32_t>(raw + 8));
    channels_[channel]->intensities.fill(get<std::uint16_t>(raw + 12));
    channels_[channel]->time.start(get<std::uint64_t>(raw + 22));
  }

  void encode_values(Channel& c, const char* next, bool time, unsigned changed) {
    static constexpr const char* kMap[16] = {
        "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
        "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
        "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
        "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};
    const char* last = c.last.data();
    const unsigned r = number(next);
    const unsigned n = of(next);
    const unsigned single = n == 1 ? 1 : 0;
    const auto m = static_cast<std::size_t>(2 * (kMap[n][r] - '0') + (time ? 1 : 0));
    const unsigned l = std::min(n > r ? n - r : r - n, 7U);
    const unsigned echo = (r == 1 ? 2U : 0U) + (r >= n ? 1U : 0U);
    const auto step = [&](std::size_t at) {
      return laz::wrapping_sum(get<std::int32_t>(next + at),
                               laz::wrapping_product(get<std::int32_t>(last + at), -1));
    };
    c.dx.encode(layers[0].encoder, step(0), c.x[m].get(), single);
    c.x[m].add(step(0));
    const unsigned kx = c.dx.bit_count();
    c.dy.encode(layers[0].encoder, step(4), c.y[m].get(), single + (kx < 20 ? kx / 2 * 2 : 20));
    c.y[m].add(step(4));
    const unsigned k = (kx + c.dy.bit_count()) / 2;
    const auto z = get<std::int32_t>(next + 8);
    c.z.encode(layers[1].encoder, z, c.heights[l], single + (k < 18 ? k / 2 * 2 : 18));
    c.heights[l] = z;
    layers[1].changed |= z != get<std::int32_t>(last + 8);
    layers[2].encoder.symbol(c.classes[2 * (byte_of(last, 16) & 31U) + (echo == 3 ? 1 : 0)],
                             byte_of(next, 16));
    layers[2].changed |= last[16] != next[16];
    layers[3].encoder.symbol(c.flags[flags(last)], flags(next));
    layers[3].changed |= flags(last) != flags(next);
    const auto intensity = get<std::uint16_t>(next + 12);
    std::uint16_t& before = c.intensities[2 * echo + (time ? 1 : 0)];
    c.intensity.encode(layers[4].encoder, intensity, before, echo);
    before = intensity;
    layers[4].changed |= intensity != get<std::uint16_t>(last + 12);
    if ((changed & 8U) != 0) {
      c.angle.encode(layers[5].encoder, get<std::int16_t>(next + 18), get<std::int16_t>(last + 18),
                     time ? 1 : 0);
      layers[5].changed = true;
    }
    layers[6].encoder.symbol(c.users[byte_of(last, 17) / 4U], byte_of(next, 17));
    layers[6].changed |= last[17] != next[17];
    if ((changed & 32U) != 0) {
      c.source.encode(layers[7].encoder, get<std::uint16_t>(next + 20), get<std::uint16_t>(last + 20));
      layers[7].changed = true;
    }
    if (time) {
      c.time.encode(layers[8].encoder, get<std::uint64_t>(next + 22));
      layers[8].changed = true;
    }
  }

  unsigned current_ = 0;
  std::array<std::unique_ptr<Channel>, 4> channels_;
};

/// One layer of anything else: `bytes` at `at` of the record, predicted by the last ones of the channel. In
/// version 3 a change to a channel seen before goes on with the values of the channel that is left.
template <typename Values>
class ValueEncoder {
 public:
  ValueEncoder(const char* raw, std::size_t at, std::size_t bytes, int version)
      : at_(at), bytes_(bytes), version_(version) {
    last_.fill(std::string(raw + at, bytes));
  }
  void encode(const char* next, const Point14Encoder::Step& step) {
    if (step.fresh) last_[step.channel] = last_[step.from];
    std::string& last = last_[version_ == 3 && !step.fresh ? step.from : step.channel];
    const std::string now(next + at_, bytes_);
    layer_.changed |= last != now;
    values_[step.channel].encode(layer_.encoder, last.data(), now.data());
    last = now;
  }
  std::string finish() { return layer_.finish(); }

 private:
  std::size_t at_;
  std::size_t bytes_;
  int version_;
  EncodedLayer layer_;
  std::array<std::string, 4> last_;
  std::map<unsigned, Values> values_;
};

}  // namespace limen::testing_laz
