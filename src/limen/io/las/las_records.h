// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "limen/io/las/las_header.h"

namespace limen {

/// Point records one behind the other, each as long as the header says.
struct LasPiece {
  const char* data = nullptr;
  std::size_t count = 0;
};

/// The point records of a LAS or LAZ file, piece by piece, in the order of the file.
class LasRecords {
 public:
  LasRecords() = default;
  LasRecords(const LasRecords&) = delete;
  LasRecords& operator=(const LasRecords&) = delete;
  virtual ~LasRecords() = default;

  /// At most about `most_rows` records, good until the next call; none at the end. Throws Error for damaged
  /// bytes.
  virtual LasPiece next(std::size_t most_rows) = 0;
};

/// The records as they are in the file, or decoded where it is a LAZ.
std::unique_ptr<LasRecords> open_las_records(std::string_view bytes, const std::string& name,
                                             const LasHeader& header);

}  // namespace limen
