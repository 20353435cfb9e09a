// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limen/extract/cells/morton_order.h"

namespace limen {

/// The level whose cubes have an edge nearest to `cell_m`: the edge is finest_m * 2^level, level >= 0.
int level_of(double cell_m, double finest_m);

/// Up to 26 indices.
class CellNeighbours {
 public:
  void add(std::int32_t index) { indices_[count_++] = index; }
  [[nodiscard]] const std::int32_t* begin() const { return indices_.data(); }
  [[nodiscard]] const std::int32_t* end() const { return indices_.data() + count_; }

 private:
  std::array<std::int32_t, 26> indices_{};
  std::size_t count_ = 0;
};

/// The occupied cubes of one level: runs of a list of points along the curve, and a hash from blocks of 4 x 4
/// x 4 cubes to their runs, so that the cubes around one are found with one to eight look-ups, mostly few.
class CellRuns {
 public:
  /// Over the points at the positions `active` along the curve, ascending.
  CellRuns(const MortonOrder& sorted, const std::vector<std::uint32_t>& active, int level);
  /// Over all points.
  CellRuns(const MortonOrder& sorted, int level);

  [[nodiscard]] std::size_t size() const { return codes_.size(); }
  /// Morton code at the runs' level.
  [[nodiscard]] std::uint64_t code(std::size_t i) const { return codes_[i]; }
  /// The run's first place in the list, and the one past its last.
  [[nodiscard]] std::uint32_t begin(std::size_t i) const { return begins_[i]; }
  [[nodiscard]] std::uint32_t end(std::size_t i) const { return begins_[i + 1]; }
  /// The occupied ones of the 26 cubes around cube i, in a fixed order.
  [[nodiscard]] CellNeighbours neighbours(std::size_t i) const;

 private:
  /// Of `places` points along the curve; code_at(k): the cube of the k-th.
  template <typename CodeAt>
  void make_runs(std::size_t places, const CodeAt& code_at);
  void finish(std::uint32_t places);
  /// The cubes of one block, which follow each other.
  struct Block {
    std::uint64_t code = 0;
    std::int32_t first = -1;  ///< run of its first occupied cube; -1: an empty slot of the table
    std::uint64_t mask = 0;   ///< bit per cube: occupied
  };
  [[nodiscard]] std::uint64_t slot_of(std::uint64_t block_code) const;
  [[nodiscard]] const Block* find(std::uint64_t block_code) const;

  std::vector<std::uint64_t> codes_;
  std::vector<std::uint32_t> begins_;
  std::vector<Block> table_;
  std::uint64_t mask_ = 0;
};

}  // namespace limen
