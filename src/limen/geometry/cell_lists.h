// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limen {

/// Which things stand in each cell of a grid (cell_key.h), in flat arrays: a fifth of the memory that a map
/// of lists takes.
class CellLists {
 public:
  CellLists() = default;
  /// `cells_of[k]`: the cells that thing k is in, each once.
  explicit CellLists(std::vector<std::vector<std::int64_t>> cells_of);

  /// The things in a cell, ascending.
  [[nodiscard]] std::span<const std::int32_t> at(std::int64_t cell) const;

 private:
  static constexpr std::int64_t kEmpty = -1;  // keys of cells are 63 bits
  struct Slot {
    std::int64_t cell = kEmpty;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };

  /// Where the cell is, or would be.
  [[nodiscard]] std::size_t slot_of(std::int64_t cell) const;

  std::vector<std::int32_t> things_;  ///< cell by cell
  std::vector<Slot> slots_;           ///< open addressing, at most half full; as many as a power of two
};

}  // namespace limen
