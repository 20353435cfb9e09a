// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_file.h"

namespace limen {

/// What a file says beside its table of points.
struct TableFacts {
  std::string name;                       ///< of the file, for messages
  std::optional<double> metres_per_unit;  ///< of all numbers below and of the points, where the file says so
  Vector3d offset = Vector3d::Zero();     ///< added to points and centres
  /// The frame of the file from that of x y z, offset not yet added; turns points and per-point centres.
  std::optional<Rigid3> pose;
  bool has_offset = false;                  ///< the file carries an offset: its 0,0,0 is no scanner
  std::optional<Vector3d> centre;           ///< scanner position, offset not yet added
  bool centre_unknown = false;              ///< the file says that it does not know its centre
  std::optional<Vector3d> possible_centre;  ///< taken only where it can be the scanner
  std::size_t missing = 0;                  ///< rows that the reader has counted as missing returns already
  std::size_t columns = 0;                  ///< points stored row by row, so many in a row; 0: not so
  std::size_t column_length = 0;            ///< points stored column by column, so many in one; 0: not so
};

/// Makes a scan of tables with the same columns, one after the other: picks the local origin, finds the
/// columns by their names, leaves out what is not finite, recovers the topology. Nothing of a table is needed
/// once it was added.
class ScanBuilder {
 public:
  ScanBuilder(const TableFacts& facts, const ReadOptions& options);
  ScanBuilder(ScanBuilder&&) noexcept;
  ScanBuilder& operator=(ScanBuilder&&) noexcept;
  ~ScanBuilder();

  /// Room for so many rows, made once the first come.
  void reserve(std::size_t rows);
  /// Throws Error where x, y or z is missing, or there are too many rows.
  void add(const RecordTable& table);
  /// Appends to `notes` and `dropped` of `file` and adds the scan to it. Throws Error where no point is
  /// usable. To be called once.
  /// `as_measured`: of a thinned table some of its points before, as dense as they were measured; null: it
  /// was not thinned.
  ScanFile finish(ScanFile file, const Scan* as_measured = nullptr);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The scan of one table.
ScanFile with_scan(ScanFile file, const RecordTable& table, const TableFacts& facts,
                   const ReadOptions& options, const Scan* as_measured = nullptr);

}  // namespace limen
