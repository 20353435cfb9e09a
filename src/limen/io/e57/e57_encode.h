// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "limen/io/e57/e57_document.h"

namespace limen {

/// What the values of a written column were.
struct E57Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  [[nodiscard]] bool known() const { return low <= high; }
  void add(double value) {
    if (!std::isfinite(value)) return;
    if (value < low) low = value;
    if (value > high) high = value;
  }
};

/// One column of a scan that is being written: takes values, gives the bytes of its stream.
class E57Encoder {
 public:
  explicit E57Encoder(E57Column column) : column_(std::move(column)) {}

  [[nodiscard]] const E57Column& column() const { return column_; }
  /// Of the finite values so far, scale and offset not applied to integers.
  [[nodiscard]] const E57Range& range() const { return range_; }

  /// Appends a value to a column of floats.
  void append(double value);
  /// Appends an integer; false where it lies outside the column's bounds, and nothing is appended.
  [[nodiscard]] bool append_integer(std::int64_t value);
  /// Fills the last byte: call it once, after the last value.
  void finish();
  /// The next bytes of the stream, at most `count`; good until the next append.
  [[nodiscard]] std::string_view take(std::size_t count);
  /// Frees the room of what was taken.
  void forget_taken();

 private:
  E57Column column_;
  E57Range range_;
  std::string bytes_;
  std::size_t taken_ = 0;      ///< bytes at the front that were taken
  std::uint64_t waiting_ = 0;  ///< bits that do not fill eight bytes yet
  unsigned filled_ = 0;        ///< how many
};

}  // namespace limen
