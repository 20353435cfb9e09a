// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// Expands bytes in the LZF format (as in PCD "binary_compressed"): literal runs of up to 32 bytes, and
/// back references of 3 to 264 bytes over at most 8 KiB. Empty where the bytes are damaged or do not expand
/// to exactly `size` bytes.
std::optional<std::string> expand_lzf(std::string_view packed, std::size_t size);

/// One line "FIELDS" entry with its SIZE, TYPE and COUNT.
struct PcdField {
  std::string name;  ///< lower case
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t width = 0;
  std::size_t height = 0;
  std::optional<std::size_t> points;
  std::optional<Rigid3> viewpoint;  ///< of the sensor in the file's frame
  std::string data;                 ///< "ascii", "binary", "binary_compressed" or what is there
  std::size_t lines = 0;
  std::size_t body = 0;  ///< bytes before the data

  [[nodiscard]] std::size_t record_bytes() const;
  /// Points in the file as POINTS says, or WIDTH and HEIGHT where it says none (files with WIDTH 0 and POINTS
  /// above 0 are met). Throws Error where there are none.
  [[nodiscard]] std::size_t point_count(const std::string& name) const;
};

/// Reads the header of a PCD file, version 0.5 to 0.7. Throws Error with the line where it is none.
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name);

/// The number type of a field; throws Error for one that is not known.
Scalar pcd_scalar(const PcdField& field, const std::string& name);

/// The bytes of the points, after the header: `data` of the file, or what a compressed body expands to, which
/// lies in `expanded` then. Throws Error where the points do not fit.
struct PcdBody {
  std::shared_ptr<const std::string> expanded;
  const char* data = nullptr;
  bool by_field = false;  ///< all x, then all y, ... (compressed), else point after point
};
PcdBody open_pcd_body(std::string_view bytes, const PcdHeader& header, const std::string& name);

[[noreturn]] void throw_pcd_too_few(std::size_t points, std::size_t room, const std::string& name);

}  // namespace limen
