// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/laz/laz_info.h"

#include <algorithm>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/las/las_fields.h"
#include "limen/io/las/laz/laz_integer.h"
#include "limen/io/las/laz/laz_pack.h"

// Source: M. Isenburg, LASzip; the LASzip specification of ASPRS' LAZ format (variable length record 22204).

namespace limen {
namespace {

using laz::ItemPlan;
using laz::ItemType;

constexpr std::size_t kRecordHead = 34;
constexpr std::size_t kItemBytes = 6;

/// The adaptive models give no symbol more than all but a 32768th per other symbol: a point takes at least
/// 0.007 bits. A count beyond that is damaged, and must not make anybody reserve memory for it.
bool can_hold(std::uint64_t bytes, std::uint64_t points) {
  constexpr std::uint64_t kPointsPerByte = 4096;
  return points / kPointsPerByte <= bytes;
}

/// What the LASzip record says.
struct Compression {
  unsigned compressor = 0;  ///< 1: one run, 2: chunks, 3: layered chunks
  std::uint32_t chunk_points = 0;
};

/// The file and where its points lie.
struct InfoSource {
  std::string_view bytes;
  const std::string& name;
  const LasHeader& header;

  [[noreturn]] void damaged(const std::string& what) const {
    throw Error(what, name, "get the whole file, or export it again");
  }
};

Compression parse_compression(const InfoSource& source, std::string_view body) {
  Compression compression;
  compression.compressor = las_number<std::uint16_t>(body, 0);
  const auto coder = las_number<std::uint16_t>(body, 2);
  compression.chunk_points = las_number<std::uint32_t>(body, 12);
  const bool known = compression.compressor >= 1 && compression.compressor <= 3 && coder == 0;
  if (!known) {
    throw Error(fmt::format("compression {} with coder {} is not known", compression.compressor, coder),
                source.name, "export it as LAS, or as LAZ with a current program");
  }
  if (compression.compressor > 1 && compression.chunk_points == 0)
    source.damaged("chunks of 0 points cannot be");
  return compression;
}

std::vector<ItemPlan> parse_items(const InfoSource& source, std::string_view body) {
  const std::size_t count = las_number<std::uint16_t>(body, 32);
  if (count == 0 || body.size() < kRecordHead + count * kItemBytes)
    source.damaged(fmt::format("the LASzip record has no room for its {} items", count));
  std::vector<ItemPlan> items;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = kRecordHead + k * kItemBytes;
    items.push_back({static_cast<ItemType>(las_number<std::uint16_t>(body, at)),
                     las_number<std::uint16_t>(body, at + 2), las_number<std::uint16_t>(body, at + 4)});
    bytes += items.back().bytes;
  }
  if (bytes != source.header.point_bytes) {
    source.damaged(fmt::format("the LASzip record describes points of {} bytes, the header of {}", bytes,
                               source.header.point_bytes));
  }
  return items;
}

/// True where an item is what formats of that kind have, in the length it must have.
bool fits(const ItemPlan& item, bool layered, bool first) {
  if (first) {
    const ItemType head = layered ? ItemType::point14 : ItemType::point10;
    return item.type == head && item.bytes == (layered ? 30U : 20U);
  }
  switch (item.type) {
    case ItemType::gps_time11:
      return !layered && item.bytes == 8;
    case ItemType::rgb12:
      return !layered && item.bytes == 6;
    case ItemType::wave_packet13:
      return !layered && item.bytes == 29;
    case ItemType::byte:
      return !layered && item.bytes > 0;
    case ItemType::rgb14:
      return layered && item.bytes == 6;
    case ItemType::rgb_nir14:
      return layered && item.bytes == 8;
    case ItemType::wave_packet14:
      return layered && item.bytes == 29;
    case ItemType::byte14:
      return layered && item.bytes > 0;
    default:
      return false;
  }
}

void check_items(const InfoSource& source, const LazInfo& info) {
  for (std::size_t k = 0; k < info.items.size(); ++k) {
    const ItemPlan& item = info.items[k];
    const bool version = info.layered ? item.version == 3 || item.version == 4 : item.version <= 2;
    if (version && fits(item, info.layered, k == 0)) continue;
    throw Error(fmt::format("points whose part {} is of type {}, version {}, with {} bytes are not known",
                            k + 1, static_cast<int>(item.type), item.version, item.bytes),
                source.name, "export it as LAS, or as LAZ with a current program");
  }
  if (info.layered != las_is_long_format(source.header.point_format)) {
    source.damaged(
        fmt::format("point format {} is not coded as the LASzip record says", source.header.point_format));
  }
}

/// Where the table of chunks begins: stated before the first chunk, or at the end of the file by writers that
/// could not go back.
std::uint64_t table_place(const InfoSource& source) {
  const std::size_t begin = source.header.points_begin;
  const std::size_t size = source.bytes.size();
  if (size - begin < 8) source.damaged("the file ends before its compressed points");
  auto place = las_number<std::int64_t>(source.bytes, begin);
  if (place == -1) place = las_number<std::int64_t>(source.bytes, size - 8);
  const bool inside =
      place >= static_cast<std::int64_t>(begin + 8) && place <= static_cast<std::int64_t>(size) - 8;
  if (!inside) {
    source.damaged(fmt::format(
        "the table of its compressed chunks should lie at byte {}, the file has {}: it was not finished",
        place, size));
  }
  return static_cast<std::uint64_t>(place);
}

/// Chunk lengths, and numbers of points where they vary.
void parse_table(const InfoSource& source, const Compression& compression, LazInfo& info) {
  const std::uint64_t place = table_place(source);
  const std::size_t count = las_number<std::uint32_t>(source.bytes, place + 4);
  const std::uint64_t begin = source.header.points_begin + 8;
  // Each chunk begins with a whole point.
  if (las_number<std::uint32_t>(source.bytes, place) != 0 ||
      count > (place - begin) / source.header.point_bytes) {
    source.damaged(fmt::format("its table of {} compressed chunks cannot be", count));
  }
  laz::Decoder decoder(source.bytes.substr(place + 8));
  laz::IntegerDecoder<32, 2> numbers;
  std::int32_t points = 0;
  std::int32_t length = 0;
  std::uint64_t at = begin;
  std::uint64_t left = source.header.points;
  for (std::size_t k = 0; k < count; ++k) {
    const bool variable = compression.chunk_points == laz::kVaryingChunks;
    if (variable) points = numbers.decode(decoder, points, 0);
    length = numbers.decode(decoder, length, 1);
    const std::uint64_t here = variable ? static_cast<std::uint32_t>(points)
                                        : std::min<std::uint64_t>(left, compression.chunk_points);
    const auto bytes = static_cast<std::uint32_t>(length);
    if (bytes > place - at || here > left || !can_hold(bytes, here) || !decoder.sound(false)) {
      source.damaged(fmt::format("compressed chunk {} of {} ({} points in {} bytes) cannot be", k + 1, count,
                                 here, bytes));
    }
    if (here > 0) info.chunks.push_back({at, at + bytes, here});
    at += bytes;
    left -= here;
  }
  if (left > 0) {
    source.damaged(fmt::format("the header promises {} points, the compressed chunks hold {}",
                               source.header.points, source.header.points - left));
  }
}

}  // namespace

LazInfo parse_laz_info(std::string_view bytes, const std::string& name, const LasHeader& header) {
  const InfoSource source{bytes, name, header};
  const LasRecord* record = header.find(kLasZipUser, kLasZipNumber);
  if (record == nullptr || record->body.size() < kRecordHead)
    source.damaged("the points are compressed, but no LASzip record says how");
  const Compression compression = parse_compression(source, record->body);
  LazInfo info;
  info.layered = compression.compressor == 3;
  info.chunk_ends_known = compression.compressor != 1;
  info.items = parse_items(source, record->body);
  check_items(source, info);
  if (header.points == 0) return info;
  if (compression.compressor == 1) {
    if (!can_hold(bytes.size() - header.points_begin, header.points))
      source.damaged(
          fmt::format("{} points cannot be in {} bytes", header.points, bytes.size() - header.points_begin));
    info.chunks.push_back({header.points_begin, bytes.size(), header.points});
  } else {
    parse_table(source, compression, info);
  }
  return info;
}

}  // namespace limen
