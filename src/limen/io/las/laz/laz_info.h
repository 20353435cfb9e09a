// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/las/las_header.h"
#include "limen/io/las/laz/laz_items.h"

namespace limen {

/// A chunk of points that is coded by itself.
struct LazChunkPlace {
  std::uint64_t begin = 0;  ///< bytes from the beginning of the file
  std::uint64_t end = 0;
  std::uint64_t points = 0;
};

/// How the points of a LAZ file are coded.
struct LazInfo {
  bool layered = false;           ///< formats 6 to 10
  bool chunk_ends_known = false;  ///< false: one run that ends somewhere in the file
  std::vector<laz::ItemPlan> items;
  std::vector<LazChunkPlace> chunks;
};

/// Name of the record that tells how the points are packed.
inline constexpr const char* kLasZipUser = "laszip encoded";
inline constexpr std::uint16_t kLasZipNumber = 22204;
/// In the byte of the point format: the points are packed.
inline constexpr unsigned kPackedBit = 0x80;

/// Reads the LASzip record and the table of chunks; all chunks lie in the file and their points add up.
/// A file coded as one run has one chunk. Throws Error where that is not so.
LazInfo parse_laz_info(std::string_view bytes, const std::string& name, const LasHeader& header);

}  // namespace limen
