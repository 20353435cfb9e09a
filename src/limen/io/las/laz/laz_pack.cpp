// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_pack.h"

#include <memory>

#include "limen/io/las/las_fields.h"
#include "limen/io/las/las_header.h"
#include "limen/io/las/laz/laz_arithmetic.h"
#include "limen/io/las/laz/laz_colours.h"
#include "limen/io/las/laz/laz_gps_time.h"
#include "limen/io/las/laz/laz_point10.h"
#include "limen/io/las/laz/laz_wave_packet.h"

namespace limen::laz {
namespace {

/// A part of points that are coded one by one.
class PackedPart {
 public:
  PackedPart() = default;
  PackedPart(const PackedPart&) = delete;
  PackedPart& operator=(const PackedPart&) = delete;
  virtual ~PackedPart() = default;

  virtual void start(const char* first) = 0;
  virtual void encode(Encoder& encoder, const char* next) = 0;
};

class PackedPoint10 : public PackedPart {
 public:
  void start(const char* first) override { points_.start(get<Point10>(first)); }
  void encode(Encoder& encoder, const char* next) override { points_.code(encoder, get<Point10>(next)); }

 private:
  Point10Coder<Encoder> points_;
};

class PackedTime : public PackedPart {
 public:
  void start(const char* first) override { times_.start(get<std::uint64_t>(first)); }
  void encode(Encoder& encoder, const char* next) override { times_.code(encoder, get<std::uint64_t>(next)); }

 private:
  GpsTimeCoder<Encoder, true> times_;
};

/// Colours, wave packets and bytes, which are predicted by the last ones alone.
template <typename Value, typename Values>
class PackedValue : public PackedPart {
 public:
  void start(const char* first) override { last_ = get<Value>(first); }
  void encode(Encoder& encoder, const char* next) override {
    last_ = values_.code(encoder, last_, get<Value>(next));
  }

 private:
  Value last_{};
  Values values_;
};

struct PlacedPart {
  std::size_t at;
  std::unique_ptr<PackedPart> part;
};

std::vector<PlacedPart> parts_of(const std::vector<ItemPlan>& items) {
  std::vector<PlacedPart> parts;
  std::size_t at = 0;
  for (const ItemPlan& item : items) {
    if (item.type == ItemType::point10) parts.push_back({at, std::make_unique<PackedPoint10>()});
    if (item.type == ItemType::gps_time11) parts.push_back({at, std::make_unique<PackedTime>()});
    if (item.type == ItemType::rgb12)
      parts.push_back({at, std::make_unique<PackedValue<Colour, ColourCoder<Encoder>>>()});
    if (item.type == ItemType::wave_packet13)
      parts.push_back({at, std::make_unique<PackedValue<WavePacket, WavePacketCoder<Encoder>>>()});
    for (std::size_t k = 0; item.type == ItemType::byte && k < item.bytes; ++k)
      parts.push_back({at + k, std::make_unique<PackedValue<std::uint8_t, ByteCoder<Encoder>>>()});
    at += item.bytes;
  }
  return parts;
}

std::string pack_pointwise_chunk(const std::vector<ItemPlan>& items, std::string_view records,
                                 std::size_t stride) {
  const std::vector<PlacedPart> parts = parts_of(items);
  for (const PlacedPart& one : parts) one.part->start(records.data() + one.at);
  Encoder encoder;
  for (std::size_t at = stride; at < records.size(); at += stride) {
    for (const PlacedPart& one : parts) one.part->encode(encoder, records.data() + at + one.at);
  }
  return std::string(records.substr(0, stride)) + encoder.finish();
}

bool is_layered(const std::vector<ItemPlan>& items) {
  return items.front().type == ItemType::point14;
}

}  // namespace

std::vector<ItemPlan> items_of(int point_format, std::size_t point_bytes) {
  const bool layered = las_is_long_format(point_format);
  const int version = layered ? 3 : 2;
  const bool time = !layered && las_gps_time_at(point_format) != 0;
  const bool colours = las_colours_at(point_format) != 0;
  const bool infrared = las_infrared_at(point_format) != 0;
  std::vector<ItemPlan> items;
  items.push_back({layered ? ItemType::point14 : ItemType::point10, layered ? 30U : 20U, version});
  if (time) items.push_back({ItemType::gps_time11, 8, version});
  if (infrared) {
    items.push_back({ItemType::rgb_nir14, 8, version});
  } else if (colours) {
    items.push_back({layered ? ItemType::rgb14 : ItemType::rgb12, 6, version});
  }
  if (las_wave_packet_at(point_format) != 0) {
    items.push_back({layered ? ItemType::wave_packet14 : ItemType::wave_packet13, kWavePacketBytes,
                     layered ? version : 1});
  }
  const std::size_t extra = point_bytes - las_point_bytes(point_format);
  if (extra > 0) items.push_back({layered ? ItemType::byte14 : ItemType::byte, extra, version});
  return items;
}

std::string laszip_record(const std::vector<ItemPlan>& items, std::uint32_t chunk_points) {
  constexpr std::size_t kHead = 34;
  constexpr std::size_t kItem = 6;
  std::string body(kHead + kItem * items.size(), '\0');
  put_las_number(body, 0, static_cast<std::uint16_t>(is_layered(items) ? 3 : 2));
  body[4] = 3;  // the version of the format that these parts came with: 3.4, revision 3
  body[5] = 4;
  put_las_number(body, 6, std::uint16_t{3});
  put_las_number(body, 12, chunk_points);
  put_las_number(body, 16, std::int64_t{-1});  // no records hidden behind the points
  put_las_number(body, 24, std::int64_t{-1});
  put_las_number(body, 32, static_cast<std::uint16_t>(items.size()));
  for (std::size_t k = 0; k < items.size(); ++k) {
    put_las_number(body, kHead + kItem * k, static_cast<std::uint16_t>(items[k].type));
    put_las_number(body, kHead + kItem * k + 2, static_cast<std::uint16_t>(items[k].bytes));
    put_las_number(body, kHead + kItem * k + 4, static_cast<std::uint16_t>(items[k].version));
  }
  return body;
}

std::string pack_chunk(const std::vector<ItemPlan>& items, std::string_view records) {
  std::size_t stride = 0;
  for (const ItemPlan& item : items) stride += item.bytes;
  return is_layered(items) ? pack_layered_chunk(items, records, stride)
                           : pack_pointwise_chunk(items, records, stride);
}

std::string pack_table(const std::vector<ChunkSize>& chunks, bool varying) {
  std::string table(8, '\0');
  put_las_number(table, 4, static_cast<std::uint32_t>(chunks.size()));
  Encoder encoder;
  IntegerCoder<Encoder, 32, 2> numbers;
  std::int32_t points = 0;
  std::int32_t bytes = 0;
  for (const ChunkSize& chunk : chunks) {
    if (varying) points = numbers.code(encoder, static_cast<std::int32_t>(chunk.points), points, 0);
    bytes = numbers.code(encoder, static_cast<std::int32_t>(chunk.bytes), bytes, 1);
  }
  return table + encoder.finish();
}

}  // namespace limen::laz
