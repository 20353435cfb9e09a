// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "limen/io/las/laz/laz_gps_time.h"
#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_items.h"
#include "limen/io/las/laz/laz_prediction.h"

/// The 30 bytes that all points of formats 6 to 10 begin with: x y z (4 each), intensity (2), returns, flags,
/// classification, user data (1 each), scan angle, point source (2 each), GPS time (8). Nine layers; the
/// first holds x, y, returns and what changes, and is coded before all others. `Coder` is a Decoder or an
/// Encoder.
namespace limen::laz {

inline constexpr std::size_t kIntensity14 = 12;
inline constexpr std::size_t kReturns14 = 14;
inline constexpr std::size_t kFlags = 15;
inline constexpr std::size_t kClass14 = 16;
inline constexpr std::size_t kUser14 = 17;
inline constexpr std::size_t kAngle14 = 18;
inline constexpr std::size_t kSource14 = 20;
inline constexpr std::size_t kTime = 22;
inline constexpr std::size_t kScannerChannels = 4;

/// Context of a return, by number of returns and return number.
inline constexpr std::array<std::array<std::uint8_t, 16>, 16> kReturnContexts14{{
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

/// What the first layer predicts from, per scanner channel, and what it does not hold but tells the changes
/// of.
struct PlaceState {
  std::int32_t x = 0;
  std::int32_t y = 0;
  unsigned number = 0;  ///< return number
  unsigned of = 0;      ///< number of returns
  bool time_changed = false;
};

/// A point as the first layer is to store it; only an encoder has one.
struct WantedPlace {
  std::int32_t x = 0;
  std::int32_t y = 0;
  unsigned number = 0;
  unsigned of = 0;
  unsigned channel = 0;
  std::uint16_t source = 0;
  std::int16_t angle = 0;
  std::uint64_t time = 0;
};

inline WantedPlace wanted_place(const char* record) {
  const auto returns = get<std::uint8_t>(record + kReturns14);
  const unsigned channel = (get<std::uint8_t>(record + kFlags) >> 4U) & 3U;
  return {get<std::int32_t>(record),
          get<std::int32_t>(record + 4),
          returns & 15U,
          static_cast<unsigned>(returns >> 4U),
          channel,
          get<std::uint16_t>(record + kSource14),
          get<std::int16_t>(record + kAngle14),
          get<std::uint64_t>(record + kTime)};
}

template <typename Coder>
struct PlaceModels {
  PlaceState last;
  WantedPlace seen;  ///< of an encoder: the channel's last point
  std::array<RunningMedian, 12> x_steps;
  std::array<RunningMedian, 12> y_steps;
  std::array<SymbolModel<128>, 8> changed;
  SymbolModel<3> channel;
  ModelPerValue<16, 16> of;
  ModelPerValue<16, 16> number;
  SymbolModel<13> number_same_time;
  IntegerCoder<Coder, 32, 2> dx;
  IntegerCoder<Coder, 32, 22> dy;
};

/// The first layer: x, y, returns, channel, and what else changes.
template <typename Coder>
class PlaceCoder {
 public:
  void start(const WantedPlace& first) {
    channel_ = first.channel;
    begin(channel_, {first.x, first.y, first.number, first.of, false}, first);
  }

  PointStep code(Coder& coder, const WantedPlace& wanted) {
    PlaceModels<Coder>* models = models_[channel_].get();
    const PlaceState& before = models->last;
    const unsigned kind = (before.number == 1 ? 1U : 0U) + (before.number >= before.of ? 2U : 0U) +
                          (before.time_changed ? 4U : 0U);
    models->changed[kind].reset_once();
    const unsigned changed = coder.code(models->changed[kind], Coder::kEncodes ? changed_by(wanted) : 0U);
    PointStep step;
    step.from = static_cast<std::uint8_t>(channel_);
    if ((changed & 64U) != 0) {
      models->channel.reset_once();
      const unsigned further = coder.code(models->channel, (wanted.channel - channel_ - 1U) & 3U);
      channel_ = (channel_ + further + 1) % kScannerChannels;
      step.fresh = !models_[channel_];
      if (step.fresh) begin(channel_, before, models->seen);
      models = models_[channel_].get();
    }
    step.channel = static_cast<std::uint8_t>(channel_);
    step.source_changes = (changed & 32U) != 0;
    step.gps_time_changes = (changed & 16U) != 0;
    step.scan_angle_changes = (changed & 8U) != 0;
    code_returns(coder, *models, changed, wanted);
    code_place(coder, *models, step, wanted);
    models->last.time_changed = step.gps_time_changes;
    if constexpr (Coder::kEncodes) models->seen = wanted;
    return step;
  }
  /// The last point.
  [[nodiscard]] const PlaceState& place() const { return models_[channel_]->last; }

 private:
  void begin(unsigned channel, const PlaceState& last, const WantedPlace& seen) {
    models_[channel] = std::make_unique<PlaceModels<Coder>>();
    models_[channel]->last = last;
    models_[channel]->last.time_changed = false;
    models_[channel]->seen = seen;
  }

  /// Bits 0 and 1: the return number stays, rises, falls by one, or otherwise; 2: number of returns, 3: scan
  /// angle, 4: time, 5: point source, 6: channel.
  [[nodiscard]] unsigned changed_by(const WantedPlace& wanted) const {
    const bool other = wanted.channel != channel_;
    const bool known = models_[wanted.channel] != nullptr;
    const WantedPlace& seen = models_[known ? wanted.channel : channel_]->seen;
    const unsigned rise = (wanted.number - seen.number) & 15U;
    return (other ? 64U : 0U) | (wanted.source != seen.source ? 32U : 0U) |
           (wanted.time != seen.time ? 16U : 0U) | (wanted.angle != seen.angle ? 8U : 0U) |
           (wanted.of != seen.of ? 4U : 0U) | (rise < 2 ? rise : (rise == 15 ? 2U : 3U));
  }

  static void code_returns(Coder& coder, PlaceModels<Coder>& models, unsigned changed,
                           const WantedPlace& wanted) {
    PlaceState& last = models.last;
    const unsigned number = last.number;
    if ((changed & 4U) != 0) last.of = coder.code(models.of.of(last.of), wanted.of);
    if ((changed & 3U) == 1) last.number = (number + 1) & 15U;
    if ((changed & 3U) == 2) last.number = (number + 15) & 15U;
    if ((changed & 3U) != 3) return;
    if ((changed & 16U) != 0) {
      last.number = coder.code(models.number.of(number), wanted.number);
    } else {
      models.number_same_time.reset_once();
      last.number =
          (number + coder.code(models.number_same_time, (wanted.number - number - 2U) & 15U) + 2) & 15U;
    }
  }

  static void code_place(Coder& coder, PlaceModels<Coder>& models, PointStep& step,
                         const WantedPlace& wanted) {
    PlaceState& last = models.last;
    const unsigned single = last.of == 1 ? 1 : 0;
    const std::size_t context =
        2U * kReturnContexts14[last.of][last.number] + (step.gps_time_changes ? 1U : 0U);
    RunningMedian& x_steps = models.x_steps[context];
    RunningMedian& y_steps = models.y_steps[context];
    const std::int32_t dx =
        models.dx.code(coder, wrapping_difference(wanted.x, last.x), x_steps.get(), single);
    x_steps.add(dx);
    const unsigned x_bits = models.dx.bit_count();
    const std::int32_t dy = models.dy.code(coder, wrapping_difference(wanted.y, last.y), y_steps.get(),
                                           single + (x_bits < 20 ? x_bits & ~1U : 20U));
    y_steps.add(dy);
    last.x = wrapping_sum(last.x, dx);
    last.y = wrapping_sum(last.y, dy);
    const unsigned bits = (x_bits + models.dy.bit_count()) / 2;
    const unsigned level = last.of > last.number ? last.of - last.number : last.number - last.of;
    step.echo = static_cast<std::uint8_t>((last.number == 1 ? 2U : 0U) + (last.number >= last.of ? 1U : 0U));
    step.level = static_cast<std::uint8_t>(std::min(level, 7U));
    step.z_context = static_cast<std::uint8_t>(single + (bits < 18 ? bits & ~1U : 18U));
  }

  unsigned channel_ = 0;
  std::array<std::unique_ptr<PlaceModels<Coder>>, kScannerChannels> models_;
};

// What is kept per channel of a value in a layer of its own: `last`, start(last), and code(coder, wanted,
// step), which changes it.

template <typename Coder>
struct HeightModels {
  std::int32_t last = 0;
  std::array<std::int32_t, 8> heights{};
  IntegerCoder<Coder, 32, 20> numbers;

  void start(std::int32_t height) {
    last = height;
    heights.fill(height);
  }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    last = heights[step.level] = numbers.code(coder, wanted, heights[step.level], step.z_context);
  }
};

template <typename Coder>
struct ClassModels {
  std::uint8_t last = 0;
  ModelPerValue<256, 64> models;

  void start(std::uint8_t first) { last = first; }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    const unsigned context = ((last & 31U) << 1U) | (step.echo == 3 ? 1U : 0U);
    last = static_cast<std::uint8_t>(coder.code(models.of(context), wanted));
  }
};

/// Four classification flags, scan direction, edge of flight line: bits 0 to 5.
template <typename Coder>
struct FlagModels {
  std::uint8_t last = 0;
  ModelPerValue<64, 64> models;

  void start(std::uint8_t first) { last = first; }
  void code(Coder& coder, decltype(last) wanted, const PointStep& /*step*/) {
    last = static_cast<std::uint8_t>(coder.code(models.of(last), wanted));
  }
};

template <typename Coder>
struct IntensityModels {
  std::uint16_t last = 0;
  std::array<std::uint16_t, 8> intensities{};
  IntegerCoder<Coder, 16, 4> numbers;

  void start(std::uint16_t intensity) {
    last = intensity;
    intensities.fill(intensity);
  }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    std::uint16_t& predicted = intensities[2U * step.echo + (step.gps_time_changes ? 1U : 0U)];
    last = predicted = static_cast<std::uint16_t>(numbers.code(coder, wanted, predicted, step.echo));
  }
};

template <typename Coder>
struct AngleModels {
  std::int16_t last = 0;
  IntegerCoder<Coder, 16, 2> numbers;

  void start(std::int16_t first) { last = first; }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    if (!step.scan_angle_changes) return;
    last = static_cast<std::int16_t>(numbers.code(coder, wanted, last, step.gps_time_changes ? 1U : 0U));
  }
};

template <typename Coder>
struct UserModels {
  std::uint8_t last = 0;
  ModelPerValue<256, 64> models;

  void start(std::uint8_t first) { last = first; }
  void code(Coder& coder, decltype(last) wanted, const PointStep& /*step*/) {
    last = static_cast<std::uint8_t>(coder.code(models.of(last / 4U), wanted));
  }
};

template <typename Coder>
struct SourceModels {
  std::uint16_t last = 0;
  IntegerCoder<Coder, 16, 1> numbers;

  void start(std::uint16_t first) { last = first; }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    if (step.source_changes) last = static_cast<std::uint16_t>(numbers.code(coder, wanted, last));
  }
};

template <typename Coder>
struct TimeModels {
  std::uint64_t last = 0;
  GpsTimeCoder<Coder, false> times;

  void start(std::uint64_t first) {
    last = first;
    times.start(first);
  }
  void code(Coder& coder, decltype(last) wanted, const PointStep& step) {
    if (step.gps_time_changes) last = times.code(coder, wanted);
  }
};

/// Between the byte of flags in a record, with the channel in bits 4 and 5, and the six bits that are coded.
inline std::uint8_t coded_flags(std::uint8_t byte) {
  return static_cast<std::uint8_t>((byte & 15U) | ((byte >> 2U) & 48U));
}
inline std::uint8_t flags_byte(std::uint8_t coded, unsigned channel) {
  return static_cast<std::uint8_t>((coded & 15U) | (channel << 4U) | ((coded & 48U) << 2U));
}

}  // namespace limen::laz
