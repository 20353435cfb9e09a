// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/atomic_file.h"
#include "limen/io/las/laz/laz_items.h"
#include "limen/io/las/laz/laz_pack.h"

namespace limen {

/// Points per chunk of written files: what all programs take.
inline constexpr std::uint32_t kLazChunkPoints = 50000;
/// Whether a file of this name is to be packed.
bool is_laz_ending(const std::filesystem::path& path);

/// Takes the records of points and writes them packed.
class PointPacker {
 public:
  PointPacker() = default;
  PointPacker(const PointPacker&) = delete;
  PointPacker& operator=(const PointPacker&) = delete;
  virtual ~PointPacker() = default;

  /// The next records, one behind the other.
  virtual void write(std::string_view records) = 0;
  /// Writes what is left. Call it once, last; tells how many bytes are in the file then.
  virtual std::uint64_t finish() = 0;
};

/// Writes the points of a LAZ file, whose header and records are written already: chunks, packed on all
/// threads, then their table. The same records give the same bytes however they are cut into pieces.
class LazWriter : public PointPacker {
 public:
  /// `points_begin`: how many bytes are in the file.
  LazWriter(AtomicFile& file, std::uint64_t points_begin, std::vector<laz::ItemPlan> items);

  void write(std::string_view records) override;
  /// The last chunk and the table.
  std::uint64_t finish() override;

 private:
  void pack_pending(std::size_t chunks);

  AtomicFile& file_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::vector<laz::ItemPlan> items_;
  std::size_t chunk_bytes_ = 0;  ///< of the records of a whole chunk
  std::string pending_;          ///< records that are not packed yet
  std::vector<laz::ChunkSize> sizes_;
};

}  // namespace limen
