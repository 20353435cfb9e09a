// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limen/io/las/las_header.h"
#include "limen/io/las/laz/laz_writer.h"

namespace limen {

/// Whether a file of this name is to be a cloud optimised one (COPC): "house.copc.laz".
bool is_copc_ending(const std::filesystem::path& path);

/// The record that must be the first of a COPC; its values are known in the end.
std::string copc_info_record();

struct CopcExtent;
struct CopcNode;
struct CopcTree;

/// Writes the points of a COPC 1.0 file, formats 6 to 8: a LAZ whose chunks are the nodes of an octree. A
/// node that has more than a few points keeps one of each cell, 128 cells an edge, and leaves the others to
/// its eight children. All records stay in memory until the end, with 36 bytes more for each.
class CopcWriter : public PointPacker {
 public:
  /// The header of 375 bytes and copc_info_record() are in the file already, and all other records; so many
  /// bytes. `grid`: of the records' coordinates.
  CopcWriter(AtomicFile& file, std::uint64_t points_begin, std::vector<laz::ItemPlan> items,
             const LasGrid& grid);

  void write(std::string_view records) override;
  /// The nodes, their table, the hierarchy as an extended record; the header points to it then.
  std::uint64_t finish() override;

 private:
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] const char* record(std::uint32_t index) const;
  [[nodiscard]] Vector3d point(std::size_t index) const;
  [[nodiscard]] CopcExtent extent() const;
  [[nodiscard]] CopcTree tree_in(const CopcExtent& extent) const;
  /// Chunks and their table; tells where the file ends then, as the next does.
  std::uint64_t write_nodes(CopcTree& tree);
  std::uint64_t write_hierarchy(const std::vector<CopcNode>& nodes, const CopcExtent& extent,
                                std::uint64_t at);

  AtomicFile& file_;
  std::uint64_t begin_;
  std::vector<laz::ItemPlan> items_;
  LasGrid grid_;
  std::size_t point_bytes_;
  std::vector<std::string> blocks_;  ///< of records; all but the last are full
};

}  // namespace limen
