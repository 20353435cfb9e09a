// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/io/table/record_table.h"

namespace limen {

/// Whether two columns hold the same kind of value under one name: their rows can be mixed as they are.
bool same_kind(const Field& a, const Field& b);

/// Rows taken from tables of the same columns, one behind the other in one piece of memory, their numbers as
/// they were stored.
class PackedRows {
 public:
  [[nodiscard]] std::size_t size() const { return record_bytes_ == 0 ? 0 : bytes_.size() / record_bytes_; }
  [[nodiscard]] std::size_t record_bytes() const { return record_bytes_; }
  /// Takes the columns from the first table that is given; throws Error where they are not the ones before.
  void require_columns(const RecordTable& like);
  void reserve(std::size_t rows) { bytes_.reserve(rows * record_bytes_); }

  void append(const RecordTable& table, std::size_t row);
  void replace(std::size_t at, const RecordTable& table, std::size_t row);
  /// Row `to` becomes the same as row `from`.
  void copy(std::size_t from, std::size_t to);
  void shrink(std::size_t rows) { bytes_.resize(rows * record_bytes_); }

  /// The rows as a table that points into this object.
  [[nodiscard]] RecordTable view() const;
  /// The rows of these places in their order, as a table that keeps its memory.
  [[nodiscard]] RecordTable taken(const std::vector<std::uint32_t>& order) const;

 private:
  [[nodiscard]] RecordTable table_at(const char* first, std::size_t rows) const;
  void write(char* to, const RecordTable& table, std::size_t row) const;

  std::vector<Field> columns_;   ///< what they are; data and stride of no meaning
  std::vector<std::size_t> at_;  ///< of each column in a record
  std::vector<std::size_t> bytes_of_;
  bool swapped_ = false;
  std::size_t record_bytes_ = 0;
  std::vector<char> bytes_;
};

}  // namespace limen
