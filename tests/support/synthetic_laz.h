// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "support/synthetic_las.h"
#include "support/synthetic_laz_layers.h"

/// LAZ files for tests.
namespace limen::testing_laz {

using testing_las::Parts;

/// How a file is packed.
struct Packing {
  std::size_t chunk = 100;  ///< points
  bool variable = false;    ///< chunks of several lengths, listed in the table
  bool one_run = false;     ///< formats 0 to 5: no chunks
  bool table_at_end = false;
  int version = 3;  ///< of the layers, 3 or 4
};

/// Formats 0 to 5: the points of one chunk.
inline std::string pack_points(const Parts& parts, const std::string& points) {
  const std::size_t stride = testing_las::point_bytes(parts);
  const std::size_t time = las_gps_time_at(parts.format);
  const std::size_t colours = las_colours_at(parts.format);
  const std::size_t packet = las_wave_packet_at(parts.format);
  Encoder encoder;
  Point10Encoder point10;
  TimeEncoder<true> times;
  ColourEncoder colour;
  PacketEncoder packets;
  std::vector<ByteEncoder> bytes(parts.extra);
  point10.start(points.data());
  if (time != 0) times.start(laz::get<std::uint64_t>(&points[time]));
  for (std::size_t at = stride; at < points.size(); at += stride) {
    const char* next = &points[at];
    const char* last = next - stride;
    point10.encode(encoder, next);
    if (time != 0) times.encode(encoder, laz::get<std::uint64_t>(next + time));
    if (colours != 0) colour.encode(encoder, last + colours, next + colours);
    if (packet != 0) packets.encode(encoder, last + packet, next + packet);
    for (std::size_t k = 0; k < parts.extra; ++k) {
      const std::size_t place = stride - parts.extra + k;
      bytes[k].encode(encoder, last + place, next + place);
    }
  }
  return points.substr(0, stride) + encoder.finish();
}

/// Formats 6 to 10.
inline std::string pack_layers(const Parts& parts, const std::string& points, int version) {
  const std::size_t stride = testing_las::point_bytes(parts);
  const char* first = points.data();
  Point14Encoder point14(first);
  std::optional<ValueEncoder<ColourEncoder>> colours;
  std::optional<ValueEncoder<InfraredEncoder>> infrared;
  std::optional<ValueEncoder<PacketEncoder>> packets;
  std::vector<ValueEncoder<ByteEncoder>> bytes;
  if (const std::size_t at = las_colours_at(parts.format)) colours.emplace(first, at, 6, version);
  if (const std::size_t at = las_infrared_at(parts.format)) infrared.emplace(first, at, 2, version);
  if (const std::size_t at = las_wave_packet_at(parts.format)) packets.emplace(first, at, 29, version);
  for (std::size_t k = stride - parts.extra; k < stride; ++k) bytes.emplace_back(first, k, 1, version);
  for (std::size_t at = stride; at < points.size(); at += stride) {
    const Point14Encoder::Step step = point14.encode(&points[at]);
    if (colours) colours->encode(&points[at], step);
    if (infrared) infrared->encode(&points[at], step);
    if (packets) packets->encode(&points[at], step);
    for (auto& one : bytes) one.encode(&points[at], step);
  }
  std::vector<std::string> layers;
  for (EncodedLayer& layer : point14.layers) layers.push_back(layer.finish());
  if (colours) layers.push_back(colours->finish());
  if (infrared) layers.push_back(infrared->finish());
  if (packets) layers.push_back(packets->finish());
  for (auto& one : bytes) layers.push_back(one.finish());
  std::string chunk =
      points.substr(0, stride) + testing_io::bytes_of(static_cast<std::uint32_t>(points.size() / stride));
  for (const std::string& layer : layers)
    chunk += testing_io::bytes_of(static_cast<std::uint32_t>(layer.size()));
  for (const std::string& layer : layers) chunk += layer;
  return chunk;
}

/// The record that says how the points are packed.
inline std::string laszip_record(const Parts& parts, const Packing& packing) {
  const bool layered = las_is_long_format(parts.format);
  const auto version = static_cast<std::uint16_t>(packing.version);
  std::vector<std::array<std::uint16_t, 3>> items;
  items.push_back(layered ? std::array<std::uint16_t, 3>{10, 30, version}
                          : std::array<std::uint16_t, 3>{6, 20, 2});
  if (!layered && las_gps_time_at(parts.format) != 0) items.push_back({7, 8, 2});
  if (!layered && las_colours_at(parts.format) != 0) items.push_back({8, 6, 2});
  if (layered && las_infrared_at(parts.format) != 0) {
    items.push_back({12, 8, version});
  } else if (layered && las_colours_at(parts.format) != 0) {
    items.push_back({11, 6, version});
  }
  if (las_wave_packet_at(parts.format) != 0)
    items.push_back(layered ? std::array<std::uint16_t, 3>{13, 29, version}
                            : std::array<std::uint16_t, 3>{9, 29, 1});
  const auto extra = static_cast<std::uint16_t>(parts.extra);
  if (extra > 0 && layered) items.push_back({14, extra, version});
  if (extra > 0 && !layered) items.push_back({0, extra, 2});
  std::string body(34, '\0');
  testing_las::put(body, 0, static_cast<std::uint16_t>(layered ? 3 : (packing.one_run ? 1 : 2)));
  testing_las::put(body, 12, packing.variable ? 0xFFFFFFFFU : static_cast<std::uint32_t>(packing.chunk));
  testing_las::put(body, 32, static_cast<std::uint16_t>(items.size()));
  for (const auto& item : items) {
    for (const std::uint16_t number : item) body += testing_io::bytes_of(number);
  }
  return testing_las::record("laszip encoded", 22204, body);
}

/// A LAZ file with the points of `parts`.
inline std::string file(Parts parts, const Packing& packing = {}) {
  const std::size_t stride = testing_las::point_bytes(parts);
  const std::size_t count = parts.points.size() / stride;
  parts.records.push_back(laszip_record(parts, packing));
  std::string bytes = testing_las::header(parts, count);
  bytes[104] = static_cast<char>(bytes[104] | '\x80');
  for (const std::string& one : parts.records) bytes += one;
  if (packing.one_run) return bytes + pack_points(parts, parts.points);
  const std::size_t table_stated_at = bytes.size();
  bytes += testing_io::bytes_of(std::int64_t{-1});
  Encoder table;
  IntegerEncoder<32, 2> numbers;
  std::int32_t last_points = 0;
  std::int32_t last_bytes = 0;
  std::uint32_t chunks = 0;
  for (std::size_t at = 0; at < count; ++chunks) {
    const std::size_t here =
        std::min(count - at, packing.variable ? 1 + (37 * chunks) % packing.chunk : packing.chunk);
    const std::string points = parts.points.substr(at * stride, here * stride);
    const bool layered = las_is_long_format(parts.format);
    const std::string chunk =
        layered ? pack_layers(parts, points, packing.version) : pack_points(parts, points);
    bytes += chunk;
    if (packing.variable) numbers.encode(table, static_cast<std::int32_t>(here), last_points, 0);
    numbers.encode(table, static_cast<std::int32_t>(chunk.size()), last_bytes, 1);
    last_points = static_cast<std::int32_t>(here);
    last_bytes = static_cast<std::int32_t>(chunk.size());
    at += here;
  }
  const auto table_at = static_cast<std::int64_t>(bytes.size());
  bytes += testing_io::bytes_of(std::uint32_t{0}) + testing_io::bytes_of(chunks) + table.finish();
  if (packing.table_at_end) return bytes + testing_io::bytes_of(table_at);
  testing_las::put(bytes, table_stated_at, table_at);
  if (!parts.tail.empty()) {
    testing_las::put(bytes, 235, static_cast<std::uint64_t>(bytes.size()));
    testing_las::put(bytes, 243, parts.tail_records);
  }
  return bytes + parts.tail;
}

}  // namespace limen::testing_laz
