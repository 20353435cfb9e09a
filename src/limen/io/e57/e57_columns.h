// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/io/e57/e57_streams.h"

namespace limen {

/// The name of a column as scan_builder knows it, else as in the file; that of a column which limen wrote
/// without its namespace.
std::string e57_field_name(const std::string& column_name);

/// How the columns of a scan become the fields of a table. Coordinates come first, as x y z; texts and the
/// column that tells invalid points are left out.
class E57Fields {
 public:
  /// `scan` must outlive this.
  explicit E57Fields(const E57Scan& scan);

  /// Names in the order of the table's fields, upper case kept.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// The points are given by range, azimuth and elevation.
  [[nodiscard]] bool spherical() const { return !ball_.empty(); }
  /// The current rows of the streams, decoded on all threads.
  [[nodiscard]] RecordTable decode(const E57Streams& streams, std::size_t rows) const;

 private:
  /// One field of the table.
  struct Plan {
    std::string name;
    Scalar type = Scalar::float64;
    int column = -1;        ///< of the scan; -1: x, y or z that is computed
    bool constant = false;  ///< stored without bits
    bool as_value = false;  ///< offset and scale are applied while decoding
    double scale = 1.0;     ///< of the field
    double offset = 0.0;
  };
  struct Piece;

  void plan_coordinates();
  void plan_column(int column, bool coordinate);
  void scale_colour(Plan& plan) const;
  [[nodiscard]] int find(const char* name) const;
  void decode_part(const E57Streams& streams, const Plan& plan, RowRange rows, char* out) const;
  void mend_coordinates(const E57Streams& streams, RowRange rows, Piece& piece) const;
  [[nodiscard]] std::vector<double> values(const E57Streams& streams, int column, RowRange rows) const;

  const E57Scan* scan_;
  std::vector<Plan> plans_;
  std::vector<std::string> names_;
  std::vector<int> ball_;  ///< columns of range, azimuth, elevation where x, y, z are computed
  int state_ = -1;         ///< column that tells which points are invalid
};

}  // namespace limen
