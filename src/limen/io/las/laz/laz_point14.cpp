// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_point14.h"

#include <array>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace limen::laz {
namespace {

/// The first layer.
class PlaceLayer {
 public:
  void start(const char* raw, std::string_view bytes) {
    decoder_ = Decoder(bytes);
    places_.start(wanted_place(raw));
  }

  void decode(const RecordPlace& out, std::vector<PointStep>& steps) {
    char* record = out.first;
    Decoder decoder = decoder_;
    for (PointStep& step : steps) {
      step = places_.code(decoder, {});
      const PlaceState& place = places_.place();
      put(record, place.x);
      put(record + 4, place.y);
      put(record + kReturns14, static_cast<std::uint8_t>(place.number | (place.of << 4U)));
      record += out.stride;
    }
    decoder_ = decoder;
  }
  [[nodiscard]] bool sound(bool at_end) const { return decoder_.sound(at_end); }

 private:
  Decoder decoder_;
  PlaceCoder<Decoder> places_;
};

/// One value of a point in a layer of its own. `Models` holds what is kept per channel: `last`, start(last)
/// and code(decoder, wanted, step), which changes it.
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
        models_[step.channel]->code(decoder, {}, step);
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

class Point14 : public LayerItem {
 public:
  [[nodiscard]] std::size_t layers() const override { return 9; }

  void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) override {
    place_.start(raw, bytes[0]);
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
  ValueLayer<HeightModels<Decoder>> height_;
  ValueLayer<ClassModels<Decoder>> class_;
  ValueLayer<FlagModels<Decoder>> flags_;
  ValueLayer<IntensityModels<Decoder>> intensity_;
  ValueLayer<AngleModels<Decoder>> angle_;
  ValueLayer<UserModels<Decoder>> user_;
  ValueLayer<SourceModels<Decoder>> source_;
  ValueLayer<TimeModels<Decoder>> time_;
};

}  // namespace

std::unique_ptr<LayerItem> make_point14() {
  return std::make_unique<Point14>();
}

}  // namespace limen::laz
