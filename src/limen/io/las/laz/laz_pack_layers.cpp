// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>

#include "limen/io/las/las_header.h"
#include "limen/io/las/laz/laz_arithmetic.h"
#include "limen/io/las/laz/laz_colours.h"
#include "limen/io/las/laz/laz_pack.h"
#include "limen/io/las/laz/laz_point14.h"
#include "limen/io/las/laz/laz_wave_packet.h"

// A chunk of formats 6 to 10: the first layer is made first, for all others follow its steps. A layer whose
// values never change is left empty.

namespace limen::laz {
namespace {

/// The records of a chunk, one behind the other, and how they follow one another.
struct ChunkToPack {
  std::string_view records;
  std::size_t stride;
  std::vector<PointStep> steps;  ///< from the second point on

  [[nodiscard]] const char* record(std::size_t point) const { return records.data() + point * stride; }
  [[nodiscard]] std::size_t points() const { return records.size() / stride; }
  [[nodiscard]] unsigned first_channel() const { return wanted_place(record(0)).channel; }
};

std::string pack_places(ChunkToPack& chunk) {
  Encoder encoder;
  PlaceCoder<Encoder> places;
  places.start(wanted_place(chunk.record(0)));
  chunk.steps.reserve(chunk.points());
  for (std::size_t i = 1; i < chunk.points(); ++i)
    chunk.steps.push_back(places.code(encoder, wanted_place(chunk.record(i))));
  return encoder.finish();
}

/// `read` gives the value of a record.
template <typename Read>
bool never_changes(const ChunkToPack& chunk, const Read& read) {
  const auto first = read(chunk.record(0));
  for (std::size_t i = 1; i < chunk.points(); ++i) {
    if (read(chunk.record(i)) != first) return false;
  }
  return true;
}

/// A value of the 30 bytes.
template <typename Models, typename Read>
std::string pack_values(const ChunkToPack& chunk, const Read& read) {
  if (never_changes(chunk, read)) return {};
  Encoder encoder;
  std::array<std::unique_ptr<Models>, kScannerChannels> models;
  const auto begin = [&](unsigned channel, auto last) {
    models[channel] = std::make_unique<Models>();
    models[channel]->start(last);
  };
  begin(chunk.first_channel(), read(chunk.record(0)));
  for (std::size_t i = 1; i < chunk.points(); ++i) {
    const PointStep& step = chunk.steps[i - 1];
    if (step.fresh) begin(step.channel, models[step.from]->last);
    models[step.channel]->code(encoder, read(chunk.record(i)), step);
  }
  return encoder.finish();
}

template <typename Value>
auto value_at(std::size_t at) {
  return [at](const char* record) { return get<Value>(record + at); };
}

/// A value behind the 30 bytes, by version 3: where the channel changes to one seen before, the last value is
/// that of the channel it leaves.
template <typename Value, typename Models>
std::string pack_others(const ChunkToPack& chunk, std::size_t at) {
  const auto read = value_at<Value>(at);
  if (never_changes(chunk, read)) return {};
  Encoder encoder;
  std::array<Models, kScannerChannels> models;
  std::array<Value, kScannerChannels> last{};
  last.fill(read(chunk.record(0)));
  for (std::size_t i = 1; i < chunk.points(); ++i) {
    const PointStep& step = chunk.steps[i - 1];
    if (step.fresh) last[step.channel] = last[step.from];
    Value& before = last[step.fresh ? step.channel : step.from];
    before = models[step.channel].code(encoder, before, read(chunk.record(i)));
  }
  return encoder.finish();
}

void pack_point14(ChunkToPack& chunk, std::vector<std::string>& layers) {
  layers.push_back(pack_places(chunk));
  layers.push_back(pack_values<HeightModels<Encoder>>(chunk, value_at<std::int32_t>(8)));
  layers.push_back(pack_values<ClassModels<Encoder>>(chunk, value_at<std::uint8_t>(kClass14)));
  layers.push_back(pack_values<FlagModels<Encoder>>(
      chunk, [](const char* record) { return coded_flags(get<std::uint8_t>(record + kFlags)); }));
  layers.push_back(pack_values<IntensityModels<Encoder>>(chunk, value_at<std::uint16_t>(kIntensity14)));
  layers.push_back(pack_values<AngleModels<Encoder>>(chunk, value_at<std::int16_t>(kAngle14)));
  layers.push_back(pack_values<UserModels<Encoder>>(chunk, value_at<std::uint8_t>(kUser14)));
  layers.push_back(pack_values<SourceModels<Encoder>>(chunk, value_at<std::uint16_t>(kSource14)));
  layers.push_back(pack_values<TimeModels<Encoder>>(chunk, value_at<std::uint64_t>(kTime)));
}

void pack_item(const ItemPlan& item, std::size_t at, ChunkToPack& chunk, std::vector<std::string>& layers) {
  switch (item.type) {
    case ItemType::point14:
      return pack_point14(chunk, layers);
    case ItemType::rgb_nir14:
      layers.push_back(pack_others<Colour, ColourCoder<Encoder>>(chunk, at));
      layers.push_back(pack_others<std::uint16_t, InfraredCoder<Encoder>>(chunk, at + 6));
      return;
    case ItemType::rgb14:
      layers.push_back(pack_others<Colour, ColourCoder<Encoder>>(chunk, at));
      return;
    case ItemType::wave_packet14:
      layers.push_back(pack_others<WavePacket, WavePacketCoder<Encoder>>(chunk, at));
      return;
    default:
      for (std::size_t k = 0; k < item.bytes; ++k)
        layers.push_back(pack_others<std::uint8_t, ByteCoder<Encoder>>(chunk, at + k));
  }
}

void append_number(std::string& bytes, std::size_t number) {
  bytes.append(4, '\0');
  put_las_number(bytes, bytes.size() - 4, static_cast<std::uint32_t>(number));
}

}  // namespace

std::string pack_layered_chunk(const std::vector<ItemPlan>& items, std::string_view records,
                               std::size_t stride) {
  ChunkToPack chunk{records, stride, {}};
  std::vector<std::string> layers;
  std::size_t at = 0;
  for (const ItemPlan& item : items) {
    pack_item(item, at, chunk, layers);
    at += item.bytes;
  }
  std::string packed(records.substr(0, stride));
  append_number(packed, chunk.points());
  for (const std::string& layer : layers) append_number(packed, layer.size());
  for (const std::string& layer : layers) packed += layer;
  return packed;
}

}  // namespace limen::laz
