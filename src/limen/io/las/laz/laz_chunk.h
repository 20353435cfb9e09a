// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "limen/io/las/laz/laz_info.h"

namespace limen {

/// Decodes the points of one chunk, some at a time.
class LazChunk {
 public:
  LazChunk() = default;
  LazChunk(const LazChunk&) = delete;
  LazChunk& operator=(const LazChunk&) = delete;
  virtual ~LazChunk() = default;

  /// Writes the next `count` records, one behind the other, to `records`. False where the bytes are damaged:
  /// the records are worth nothing then.
  virtual bool decode(char* records, std::size_t count) = 0;
};

/// nullptr where the chunk has not even the bytes it must have.
std::unique_ptr<LazChunk> open_laz_chunk(const LazInfo& info, const LazChunkPlace& place,
                                         std::string_view file);

}  // namespace limen
