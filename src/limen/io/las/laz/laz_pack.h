// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/las/laz/laz_items.h"

/// How points are packed: the other direction of laz_records.cpp and laz_info.h.
namespace limen::laz {

/// The parts of the records of a point format, in the newest versions that all readers know: 2 for formats 0
/// to 5 (wave packets 1), 3 for 6 to 10. Bytes behind those of the format are a part of their own.
std::vector<ItemPlan> items_of(int point_format, std::size_t point_bytes);

/// For laszip_record(): the table of chunks tells the number of points of each.
inline constexpr std::uint32_t kVaryingChunks = 0xFFFFFFFFU;

/// Body of the LASzip record that tells of the parts and of chunks of so many points.
std::string laszip_record(const std::vector<ItemPlan>& items, std::uint32_t chunk_points);

/// One chunk from its records, one behind the other, at least one: the first as it is, then the message of
/// all parts, or the lengths of all layers and the layers.
std::string pack_chunk(const std::vector<ItemPlan>& items, std::string_view records);

struct ChunkSize {
  std::uint32_t points = 0;
  std::uint32_t bytes = 0;  ///< packed
};

/// Table of chunks. `varying`: their numbers of points too; else all but the last have the same.
std::string pack_table(const std::vector<ChunkSize>& chunks, bool varying);

/// Some of pack_chunk: formats 6 to 10.
std::string pack_layered_chunk(const std::vector<ItemPlan>& items, std::string_view records,
                               std::size_t stride);

}  // namespace limen::laz
