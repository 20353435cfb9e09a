// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"

namespace limen {

/// One cloud of a point file, before its points are read.
struct CloudFacts {
  TableFacts table;                 ///< name, offset, pose, scanner position
  std::uint64_t points = 0;         ///< as the file says
  std::vector<std::string> fields;  ///< names of the values per point, as the file has them
  std::vector<std::string> notes;   ///< sentences about what was assumed
};

/// Reads one cloud piece after piece.
class PointStream {
 public:
  PointStream() = default;
  PointStream(const PointStream&) = delete;
  PointStream& operator=(const PointStream&) = delete;
  virtual ~PointStream() = default;

  /// The next rows, at most about `most_rows`, in the order of the file, decoded on all threads; nullopt at
  /// the end. Rows that the file marks invalid have coordinates that are not numbers. The table may point
  /// into the stream: it is good until the next call. Throws Error for damaged bytes.
  virtual std::optional<RecordTable> next(std::size_t most_rows) = 0;
};

/// A point file that is open: what it says of itself, and its clouds to be read one after the other.
/// It may refer to the bytes it was opened on, which the caller keeps.
class PointFile {
 public:
  PointFile() = default;
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;
  virtual ~PointFile() = default;

  [[nodiscard]] virtual std::string format() const = 0;  ///< in a user's words: "LAS 1.4, point format 6"
  [[nodiscard]] virtual const std::vector<CloudFacts>& clouds() const = 0;
  /// A stream from the first point of cloud `index`; several may be open at once.
  [[nodiscard]] virtual std::unique_ptr<PointStream> read(std::size_t index) const = 0;
};

}  // namespace limen
