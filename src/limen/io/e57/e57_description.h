// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limen/geometry/rigid.h"
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

/// What is written of one scan of a new E57 file.
struct E57Description {
  std::string name;
  std::vector<std::string> georeference;
  Vector3d shift = Vector3d::Zero();  ///< the pose
  bool centre_known = false;          ///< the pose is the scanner position
  std::array<E57Range, 3> bounds;     ///< of the points, about the shift
  std::uint64_t points = 0;
  std::uint64_t section = 0;  ///< physical offset
  std::uint64_t digest = 0;   ///< of the points
  std::vector<E57Column> columns;
  std::vector<E57Range> ranges;  ///< of the columns
};

/// A namespace of columns and elements that the standard does not know: "nor" and its address.
using E57Space = std::pair<std::string, std::string>;

/// A scan and its images as they are named in the description of a file.
struct E57Entry {
  std::string scan;    ///< XML
  std::string images;  ///< XML
  std::vector<E57Space> spaces;
  std::vector<std::string> georeference;
  std::uint64_t digest = 0;  ///< of the points
};
E57Entry e57_entry(const E57Description& about);

/// A picture of all that is round the scanner, a PNG: azimuth falls from left to right by a whole turn with
/// the scan's x axis in the middle, elevation from top to bottom by half a turn.
struct E57Panorama {
  std::string png;
  std::size_t width = 0;
  std::size_t height = 0;
};
/// The description of the panorama of a scan; `section`: where its bytes are, physical offset.
std::string e57_panorama_xml(const E57Description& about, const E57Panorama& picture, std::uint64_t section);

/// The file's XML; at least one scan.
std::string e57_description_xml(const std::vector<E57Entry>& entries);

/// A pose as an element.
std::string e57_pose_xml(const Rigid3& pose);

/// A number with the 17 digits that bring it back.
std::string e57_number(double value);

}  // namespace limen
