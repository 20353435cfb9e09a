// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// How the numbers of a PLY file are written.
enum class PlyEncoding { ascii, little_endian, big_endian };

/// One value, or one list of values, of each record of an element.
struct PlyProperty {
  std::string name;  ///< as written
  Scalar type = Scalar::float32;
  std::optional<Scalar> count_type;  ///< set for a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_lists() const;
  /// Bytes of a record without lists; with lists: the least number.
  [[nodiscard]] std::size_t least_bytes() const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> lines;  ///< every line of the header, without its end
  std::size_t body = 0;            ///< bytes before the data
  Vector3d offset = Vector3d::Zero();
  bool has_offset = false;
  std::optional<Vector3d> centre;  ///< from "comment scanner_position X Y Z"
  bool centre_unknown = false;     ///< from "comment scanner_position unknown"

  /// Index of the element with the points; throws Error where there is none or it is empty.
  [[nodiscard]] std::size_t vertex(const std::string& name) const;
  /// True where binary numbers are in the order opposite to this machine's.
  [[nodiscard]] bool swapped() const;
};

/// Reads a PLY header. Throws Error with the line where it is not one.
///
/// Comments (and obj_info lines) that carry an offset to add to all points are understood where their first
/// word is offset, pivot, shift, global_shift or translation and three numbers end the line.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

/// The offset that a header line carries in the sense of parse_ply_header; empty where it carries none.
std::optional<Vector3d> offset_in_line(std::string_view header_line);

/// Bytes of the record at `at`, lists included; throws Error where the file ends before it.
std::size_t ply_record_bytes(std::string_view bytes, std::size_t at, const PlyElement& element, bool swapped,
                             const std::string& name);

/// Byte at which element number `which` of a binary file begins. Throws Error where the file ends before.
std::size_t ply_element_start(std::string_view bytes, const PlyHeader& header, std::size_t which,
                              const std::string& name);

}  // namespace limen
