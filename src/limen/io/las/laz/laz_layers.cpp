// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <vector>

#include "limen/io/las/laz/laz_colours.h"
#include "limen/io/las/laz/laz_items.h"
#include "limen/io/las/laz/laz_prediction.h"
#include "limen/io/las/laz/laz_wave_packet.h"

// Colours, near infrared, wave packets and extra bytes of formats 6 to 10. Models and last values are kept
// per scanner channel; point14 tells the channel of each point.

namespace limen::laz {
namespace {

constexpr std::size_t kChannels = 4;

/// One layer whose values are `Value`, its models `Models` with code(decoder, last, wanted) -> next.
template <typename Value, typename Models>
class Layer {
 public:
  void start(const Value& first, unsigned channel, std::string_view bytes, int version) {
    version_ = version;
    constant_ = bytes.empty();
    last_.fill(first);
    if (constant_) return;
    decoder_ = Decoder(bytes);
    models_[channel] = std::make_unique<Models>();
  }

  void decode(char* record, std::size_t stride, const std::vector<PointStep>& steps) {
    Decoder decoder = decoder_;
    for (const PointStep& step : steps) {
      if (!constant_) {
        if (step.fresh) {
          models_[step.channel] = std::make_unique<Models>();
          last_[step.channel] = last_[step.from];
        }
        // Where the channel changes to one seen before, version 3 goes on from the value of the channel it
        // leaves, and stores the new value there.
        const bool stale = version_ == 3 && !step.fresh;
        Value& last = last_[stale ? step.from : step.channel];
        last = models_[step.channel]->code(decoder, last, Value{});
        put(record, last);
      } else {
        put(record, last_[0]);
      }
      record += stride;
    }
    decoder_ = decoder;
  }
  [[nodiscard]] bool sound(bool at_end) const { return decoder_.sound(at_end); }

 private:
  int version_ = 3;
  bool constant_ = true;
  Decoder decoder_;
  std::array<Value, kChannels> last_{};
  std::array<std::unique_ptr<Models>, kChannels> models_;
};

class Colours14 : public LayerItem {
 public:
  Colours14(int version, bool with_infrared) : version_(version), with_infrared_(with_infrared) {}

  [[nodiscard]] std::size_t layers() const override { return with_infrared_ ? 2 : 1; }
  void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) override {
    colours_.start(get<Colour>(raw), channel, bytes[0], version_);
    if (with_infrared_) infrared_.start(get<std::uint16_t>(raw + 6), channel, bytes[1], version_);
  }
  void decode(const RecordPlace& out, std::vector<PointStep>& steps) override {
    colours_.decode(out.first, out.stride, steps);
    if (with_infrared_) infrared_.decode(out.first + 6, out.stride, steps);
  }
  [[nodiscard]] bool sound(bool at_end) const override {
    return colours_.sound(at_end) && infrared_.sound(at_end);
  }

 private:
  int version_;
  bool with_infrared_;
  Layer<Colour, ColourCoder<Decoder>> colours_;
  Layer<std::uint16_t, InfraredCoder<Decoder>> infrared_;
};

class Bytes14 : public LayerItem {
 public:
  Bytes14(int version, std::size_t count) : version_(version), bytes_(count) {}

  [[nodiscard]] std::size_t layers() const override { return bytes_.size(); }
  void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) override {
    for (std::size_t k = 0; k < bytes_.size(); ++k)
      bytes_[k].start(get<std::uint8_t>(raw + k), channel, bytes[k], version_);
  }
  void decode(const RecordPlace& out, std::vector<PointStep>& steps) override {
    for (std::size_t k = 0; k < bytes_.size(); ++k) bytes_[k].decode(out.first + k, out.stride, steps);
  }
  [[nodiscard]] bool sound(bool at_end) const override {
    for (const auto& byte : bytes_) {
      if (!byte.sound(at_end)) return false;
    }
    return true;
  }

 private:
  int version_;
  std::vector<Layer<std::uint8_t, ByteCoder<Decoder>>> bytes_;
};

class WavePackets14 : public LayerItem {
 public:
  explicit WavePackets14(int version) : version_(version) {}

  [[nodiscard]] std::size_t layers() const override { return 1; }
  void start(const char* raw, unsigned channel, const std::vector<std::string_view>& bytes) override {
    packets_.start(get<WavePacket>(raw), channel, bytes[0], version_);
  }
  void decode(const RecordPlace& out, std::vector<PointStep>& steps) override {
    packets_.decode(out.first, out.stride, steps);
  }
  [[nodiscard]] bool sound(bool at_end) const override { return packets_.sound(at_end); }

 private:
  int version_;
  Layer<WavePacket, WavePacketCoder<Decoder>> packets_;
};

}  // namespace

std::unique_ptr<LayerItem> make_rgb14(int version, bool with_infrared) {
  return std::make_unique<Colours14>(version, with_infrared);
}

std::unique_ptr<LayerItem> make_bytes14(int version, std::size_t count) {
  return std::make_unique<Bytes14>(version, count);
}

std::unique_ptr<LayerItem> make_wave_packet14(int version) {
  return std::make_unique<WavePackets14>(version);
}

}  // namespace limen::laz
