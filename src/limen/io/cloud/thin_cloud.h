// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "limen/io/table/point_file.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// How a cloud is to be thinned. At least one of the three must be set.
struct ThinOptions {
  std::uint64_t most_points = 0;   ///< as many are kept, or a little less; 0: any number
  double spacing_m = 0.0;          ///< one point per cube of this side; 0: as dense as the others allow
  std::uint64_t memory_bytes = 0;  ///< that the work may take, with what is kept; 0: any

  void check() const;
};

/// What is left of a cloud.
struct ThinnedCloud {
  RecordTable table;                ///< the points kept, in the order of the cloud, numbers as they were
  std::vector<std::uint64_t> rows;  ///< which ones they are, from 0
  std::uint64_t read = 0;           ///< points that came in
  std::uint64_t unusable = 0;       ///< of them: without finite coordinates
  double spacing_m = 0.0;           ///< side of the cubes with one point each
};

/// Thins a cloud that comes in pieces: space is cut into cubes, and of each one point stays, drawn by lot
/// (the least hash of its place in the cloud), never a mean: no lattice shows. Where the cubes become too
/// many they grow. What is kept depends on the cloud and its pieces, never on the number of threads.
class CloudThinner {
 public:
  /// `expected`: points that will come, at most.
  CloudThinner(const ThinOptions& options, std::uint64_t expected);
  ~CloudThinner();
  CloudThinner(const CloudThinner&) = delete;
  CloudThinner& operator=(const CloudThinner&) = delete;

  /// All pieces have the same columns; x, y and z are metres. Throws Error where one of them is missing.
  void add(const RecordTable& piece);
  /// The end; call it once.
  ThinnedCloud finish();

 private:
  class Cells;
  std::unique_ptr<Cells> cells_;
};

/// A coordinate beyond this is none: a missing return, or a broken export.
constexpr double kLargestCoordinateM = 1e8;

/// Rows per piece that readers are asked for: enough for all threads, little memory.
constexpr std::size_t kStreamRows = std::size_t{1} << 20U;

}  // namespace limen
