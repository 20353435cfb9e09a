// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// The number types that occur in point files.
enum class Scalar : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};
/// What `action` returns for a value of the C++ type of `type`.
template <typename Action>
auto with_type(Scalar type, const Action& action) {
  switch (type) {
    case Scalar::int8:
      return action(std::int8_t{});
    case Scalar::uint8:
      return action(std::uint8_t{});
    case Scalar::int16:
      return action(std::int16_t{});
    case Scalar::uint16:
      return action(std::uint16_t{});
    case Scalar::int32:
      return action(std::int32_t{});
    case Scalar::uint32:
      return action(std::uint32_t{});
    case Scalar::int64:
      return action(std::int64_t{});
    case Scalar::uint64:
      return action(std::uint64_t{});
    case Scalar::float32:
      return action(float{});
    default:
      return action(double{});
  }
}

/// Bytes of one number.
std::size_t size_of(Scalar scalar);
[[nodiscard]] bool is_integer(Scalar scalar);

/// Some bits of an integer, counted from the lowest; count 0: the whole number.
struct BitRange {
  unsigned shift = 0;
  unsigned count = 0;
};

/// One named column of numbers somewhere in memory: value i is offset + scale * n, where n are `bits` of the
/// number that lies at data + i * stride.
struct Field {
  std::string name;  ///< lower case
  Scalar type = Scalar::float64;
  const char* data = nullptr;
  std::size_t stride = 0;  ///< bytes
  double scale = 1.0;
  double offset = 0.0;
  BitRange bits = {};

  /// The stored number is the value.
  [[nodiscard]] bool plain() const { return scale == 1.0 && offset == 0.0 && bits.count == 0; }
};

/// What every reader brings its file to: columns of equal length, in the file's own bytes where they are
/// there (binary), else in numbers made from text. Records, columns and any mix of them look alike here.
struct RecordTable {
  std::size_t rows = 0;
  bool swapped = false;  ///< bytes of each number are in the order opposite to this machine's
  std::vector<Field> fields;
  std::shared_ptr<const void> keeper;  ///< keeps what `fields` point to, where not the file

  /// The first field with one of these names, in the order of the names; nullptr where there is none.
  [[nodiscard]] const Field* find(std::initializer_list<std::string_view> names) const;
};

/// Fields of a table of doubles, row after row.
RecordTable table_of_numbers(std::shared_ptr<const std::vector<double>> numbers,
                             const std::vector<std::string>& names);

/// Which values to load: [begin, end) of a column.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};
/// Writes the values of the rows to out[0], out[out_stride], ...
void load_numbers(const RecordTable& table, const Field& field, RowRange rows, double* out,
                  std::size_t out_stride = 1);

/// One number from its bytes; `swapped` as in RecordTable.
double load_number(const char* bytes, Scalar type, bool swapped);

/// The column with the time of each point, in whatever way it is called; nullptr: there is none.
const Field* find_times(const RecordTable& table);

}  // namespace limen
