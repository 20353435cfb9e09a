// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "limen/io/las/laz/laz_gps_time.h"
#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_items.h"
#include "limen/io/las/laz/laz_prediction.h"

// The 30 bytes that all points of formats 6 to 10 begin with: x y z (4 each), intensity (2), returns, flags,
// classification, user data (1 each), scan angle, point source (2 each), GPS time (8). Nine layers; the first
// holds x, y, returns and what changes, and is read before all others.

namespace limen::laz {
namespace {

constexpr std::size_t kIntensity14 = 12;
constexpr std::size_t kReturns14 = 14;
constexpr std::size_t kFlags = 15;
constexpr std::size_t kClass14 = 16;
constexpr std::size_t kUser14 = 17;
constexpr std::size_t kAngle14 = 18;
constexpr std::size_t kSource14 = 20;
constexpr std::size_t kTime = 22;
constexpr std::size_t kScannerChannels = 4;

/// Context of a return, by number of returns and return number.
constexpr std::array<std::array<std::uint8_t, 16>, 16> kReturnContexts14{{
    {0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
    {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
    {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
    {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
    {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
    {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
    {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5},
}};

/// What the first layer predicts from, per scanner channel.
struct PlaceState {
  std::int32_t x = 0;
  std::int32_t y = 0;
  unsigned number = 0;  ///< return number
  unsigned of = 0;      ///< number of returns
  bool time_changed = false;
};

struct PlaceModels {
  PlaceState last;
  std::array<RunningMedian, 12> x_steps;
  std::array<RunningMedian, 12> y_steps;
  std::array<SymbolModel<128>, 8> changed;
  SymbolModel<3> channel;
  ModelPerValue<16, 16> of;
  ModelPerValue<16, 16> number;
  SymbolModel<13> number_same_time;
  IntegerDecoder<32, 2> dx;
  IntegerDecoder<32, 22> dy;
};

/// The first layer: x, y, returns, channel, and what else changes.
class PlaceLayer {
 public:
  void start(const char* raw, unsigned channel, std::string_view bytes) {
    decoder_ = Decoder(bytes);
    channel_ = channel;
    const auto returns = get<std::uint8_t>(raw + kReturns14);
    begin(channel, {get<std::int32_t>(raw), get<std::int32_t>(raw + 4), returns & 15U,
                    static_cast<unsigned>(returns >> 4U), false});
  }

  void decode(const RecordPlace& out, std::vector<PointStep>& steps) {
    char* record = out.first;
    Decoder decoder = decoder_;
    for (PointStep& step : steps) {
      step = decode_point(decoder, record);
      record += out.stride;
    }
    decoder_ = decoder;
  }
  [[nodiscard]] bool sound(bool at_end) const { return decoder_.sound(at_end); }

 private:
  void begin(unsigned channel, const PlaceState& last) {
    models_[channel] = std::make_unique<PlaceModels>();
    models_[channel]->last = last;
    models_[channel]->last.time_changed = false;
  }

  PointStep decode_point(Decoder& decoder, char* record) {
    PlaceModels* models = models_[channel_].get();
    const PlaceState& before = models->last;
    const unsigned kind = (before.number == 1 ? 1U : 0U) + (before.number >= before.of ? 2U : 0U) +
                          (before.time_changed ? 4U : 0U);
    models->changed[kind].reset_once();
    const unsigned changed = decoder.symbol(models->changed[kind]);
    PointStep step;
    step.from = static_cast<std::uint8_t>(channel_);
    if ((changed & 64U) != 0) {
      models->channel.reset_once();
      channel_ = (channel_ + decoder.symbol(models->channel) + 1) % kScannerChannels;
      step.fresh = !models_[channel_];
      if (step.fresh) begin(channel_, before);
      models = models_[channel_].get();
    }
    step.channel = static_cast<std::uint8_t>(channel_);
    step.source_changes = (changed & 32U) != 0;
    step.gps_time_changes = (changed & 16U) != 0;
    step.scan_angle_changes = (changed & 8U) != 0;
    decode_returns(decoder, *models, changed);
    decode_place(decoder, *models, step);
    put(record, models->last.x);
    put(record + 4, models->last.y);
    put(record + kReturns14, static_cast<std::uint8_t>(models->last.number | (models->last.of << 4U)));
    models->last.time_changed = step.gps_time_changes;
    return step;
  }

  static void decode_returns(Decoder& decoder, PlaceModels& models, unsigned changed) {
    PlaceState& last = models.last;
    const unsigned number = last.number;
    if ((changed & 4U) != 0) last.of = models.of.decode(decoder, last.of);
    if ((changed & 3U) == 1) last.number = (number + 1) & 15U;
    if ((changed & 3U) == 2) last.number = (number + 15) & 15U;
    if ((changed & 3U) != 3) return;
    if ((changed & 16U) != 0) {
      last.number = models.number.decode(decoder, number);
    } else {
      models.number_same_time.reset_once();
      last.number = (number + decoder.symbol(models.number_same_time) + 2) & 15U;
    }
  }

  static void decode_place(Decoder& decoder, PlaceModels& models, PointStep& step) {
    PlaceState& last = models.last;
    const unsigned single = last.of == 1 ? 1 : 0;
    const std::size_t context =
        2U * kReturnContexts14[last.of][last.number] + (step.gps_time_changes ? 1U : 0U);
    const std::int32_t dx = models.dx.decode(decoder, models.x_steps[context].get(), single);
    models.x_steps[context].add(dx);
    const unsigned x_bits = models.dx.bit_count();
    const std::int32_t dy =
        models.dy.decode(decoder, models.y_steps[context].get(), single + (x_bits < 20 ? x_bits & ~1U : 20U));
    models.y_steps[context].add(dy);
    last.x = wrapping_sum(last.x, dx);
    last.y = wrapping_sum(last.y, dy);
    const unsigned bits = (x_bits + models.dy.bit_count()) / 2;
    const unsigned level = last.of > last.number ? last.of - last.number : last.number - last.of;
    step.echo = static_cast<std::uint8_t>((last.number == 1 ? 2U : 0U) + (last.number >= last.of ? 1U : 0U));
    step.level = static_cast<std::uint8_t>(std::min(level, 7U));
    step.z_context = static_cast<std::uint8_t>(single + (bits < 18 ? bits & ~1U : 18U));
  }

  Decoder decoder_;
  unsigned channel_ = 0;
  std::array<std::unique_ptr<PlaceModels>, kScannerChannels> models_;
};

/// One value of a point in a layer of its own. `Models` holds what is kept per channel: `last`, start(last)
/// and decode(decoder, step), which changes it.
template <typename Models>
class ValueLayer {
 public:
  using Value = decltype(Models::last);

  void start(Value first, unsigned channel, std::string_view bytes) {
    first_ = first;
    constant_ = bytes.empty();
    if (constant_) return;
    decoder_ = Decoder(bytes);
    begin(channel, first);
  }

  /// Calls `write` with each record and its value.
  template <typename Write>
  void decode(const RecordPlace& out, const std::vector<PointStep>& steps, const Write& write) {
    char* record = out.first;
    Decoder decoder = decoder_;
    for (const PointStep& step : steps) {
      if (!constant_) {
        if (step.fresh) begin(step.channel, models_[step.from]->last);
        models_[step.channel]->decode(decoder, step);
      }
      write(record, constant_ ? first_ : models_[step.channel]->last, step);
      record += out.stride;
    }
    decoder_ = decoder;
  }
  [[nodiscard]] bool sound(bool at_end) const { return decoder_.sound(at_end); }

 private:
  void begin(unsigned channel, Value last) {
    auto models = std::make_unique<Models>();
    models->start(last);
    models_[channel] = std::move(models);
  }

  Value first_{};
  bool constant_ = true;
  Decoder decoder_;
  std::array<std::unique_ptr<Models>, kScannerChannels> models_;
};

struct HeightModels {
  std::int32_t last = 0;
  std::array<std::int32_t, 8> heights{};
  IntegerDecoder<32, 20> numbers;

  void start(std::int32_t height) {
    last = height;
    heights.fill(height);
  }
  void decode(Decoder& decoder, const PointStep& step) {
    last = heights[step.level] = numbers.decode(decoder, heights[step.level], step.z_context);
  }
};

struct ClassModels {
  std::uint8_t last = 0;
  ModelPerValue<256, 64> models;

  void start(std::uint8_t first) { last = first; }
  void decode(Decoder& decoder, const PointStep& step) {
    const unsigned context = ((last & 31U) << 1U) | (step.echo == 3 ? 1U : 0U);
    last = static_cast<std::uint8_t>(models.decode(decoder, context));
  }
};

/// Four classification flags, scan direction, edge of flight line: bits 0 to 5.
struct FlagModels {
  std::uint8_t last = 0;
  ModelPerValue<64, 64> models;

  void start(std::uint8_t first) { last = first; }
  void decode(Decoder& decoder, const PointStep& /*step*/) {
    last = static_cast<std::uint8_t>(models.decode(decoder, last));
  }
};

struct IntensityModels {
  std::uint16_t last = 0;
  std::array<std::uint16_t, 8> intensities{};
  IntegerDecoder<16, 4> numbers;

  void start(std::uint16_t intensity) {
    last = intensity;
    intensities.fill(intensity);
  }
  void decode(Decoder& decoder, const PointStep& step) {
    std::uint16_t& predicted = intensities[2U * step.echo + (step.gps_time_changes ? 1U : 0U)];
    last = predicted = static_cast<std::uint16_t>(numbers.decode(decoder, predicted, step.echo));
  }
};

struct AngleModels {
  std::int16_t last = 0;
  IntegerDecoder<16, 2> numbers;

  void start(std::int16_t first) { last = first; }
  void decode(Decoder& decoder, const PointStep& step) {
    if (!step.scan_angle_changes) return;
    last = static_cast<std::int16_t>(numbers.decode(decoder, last, step.gps_time_changes ? 1U : 0U));
  }
};

struct UserModels {
  std::uint8_t last = 0;
  ModelPerValue<256, 64> models;

  void start(std::uint8_t first) { last = first; }
  void decode(Decoder& decoder, const PointStep& /*step*/) {
    last = static_cast<std::uint8_t>(models.decode(decoder, last / 4U));
  }
};

struct SourceModels {
  std::uint16_t last = 0;
  IntegerDecoder<16, 1> numbers;

  void start(std::uint16_t first) { last = first; }
  void decode(Decoder& decoder, const PointStep& step) {
    if (step.source_changes) last = static_cast<std::uint16_t>(numbers.decode(decoder, last));
  }
};

struct TimeModels {
  std::uint64_t last = 0;
  GpsTimeDecoder<false> times;

  void start(std::uint64_t first) {
    last = first;
    times.start(first);
  }
  void decode(Decoder& decoder, const PointStep& step) {
    if (step.gps_time_changes) last = times.decode(decoder);
  }
};

/// Between the byte of flags in a record, with the channel in bits 4 and 5, and the six bits that are coded.
std::uint8_t coded_flags(std::uint8_t byte) {
  return static_cast<std::uint8_t>((byte & 15U) | ((byte >> 2U) & 48U));
}
std::uint8_t flags_byte(std::uint8_t coded, unsigned channel) {
  return static_cast<std::uint8_t>((coded & 15U) | (channel << 4U) | ((coded & 48U) << 2U));
}

class Point14 : public LayerItem {
 public:
  [[nodiscard]] std::size_t layers() const override { return 9; }

  void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) override {
    place_.start(raw, channel, bytes[0]);
    height_.start(get<std::int32_t>(raw + 8), channel, bytes[1]);
    class_.start(get<std::uint8_t>(raw + kClass14), channel, bytes[2]);
    flags_.start(coded_flags(get<std::uint8_t>(raw + kFlags)), channel, bytes[3]);
    intensity_.start(get<std::uint16_t>(raw + kIntensity14), channel, bytes[4]);
    angle_.start(get<std::int16_t>(raw + kAngle14), channel, bytes[5]);
    user_.start(get<std::uint8_t>(raw + kUser14), channel, bytes[6]);
    source_.start(get<std::uint16_t>(raw + kSource14), channel, bytes[7]);
    time_.start(get<std::uint64_t>(raw + kTime), channel, bytes[8]);
  }

  void decode(const RecordPlace& out, std::vector<PointStep>& steps) override {
    const auto to = [](std::size_t at) {
      return [at](char* record, auto value, const PointStep&) { put(record + at, value); };
    };
    place_.decode(out, steps);
    height_.decode(out, steps, to(8));
    class_.decode(out, steps, to(kClass14));
    flags_.decode(out, steps, [](char* record, std::uint8_t coded, const PointStep& step) {
      put(record + kFlags, flags_byte(coded, step.channel));
    });
    intensity_.decode(out, steps, to(kIntensity14));
    angle_.decode(out, steps, to(kAngle14));
    user_.decode(out, steps, to(kUser14));
    source_.decode(out, steps, to(kSource14));
    time_.decode(out, steps, to(kTime));
  }

  [[nodiscard]] bool sound(bool at_end) const override {
    return place_.sound(at_end) && height_.sound(at_end) && class_.sound(at_end) && flags_.sound(at_end) &&
           intensity_.sound(at_end) && angle_.sound(at_end) && user_.sound(at_end) && source_.sound(at_end) &&
           time_.sound(at_end);
  }

 private:
  PlaceLayer place_;
  ValueLayer<HeightModels> height_;
  ValueLayer<ClassModels> class_;
  ValueLayer<FlagModels> flags_;
  ValueLayer<IntensityModels> intensity_;
  ValueLayer<AngleModels> angle_;
  ValueLayer<UserModels> user_;
  ValueLayer<SourceModels> source_;
  ValueLayer<TimeModels> time_;
};

}  // namespace

std::unique_ptr<LayerItem> make_point14() {
  return std::make_unique<Point14>();
}

}  // namespace limen::laz
