// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limen/io/las/las_header.h"
#include "limen/io/table/record_table.h"

namespace limen {

/// Bytes of a point record of formats 0 to 10 without extra bytes.
std::size_t las_point_bytes(int point_format);
/// Where colours, near infrared and wave packets begin in a record; 0 where the format has none.
std::size_t las_gps_time_at(int point_format);
std::size_t las_colours_at(int point_format);
std::size_t las_infrared_at(int point_format);
std::size_t las_wave_packet_at(int point_format);
/// Formats 6 to 10.
inline bool las_is_long_format(int point_format) {
  return point_format >= 6;
}

/// Degrees per step of the scan angle, formats 6 to 10.
inline constexpr double kLasAngleStep = 0.006;
/// Bytes of one description of extra bytes.
inline constexpr std::size_t kLasDescriptionBytes = 192;

/// One value of a record.
struct LasField {
  std::size_t at = 0;  ///< byte within the record
  Field field;         ///< name, type, scale, offset, bits; without place
};

/// The values of the records of a file.
struct LasLayout {
  std::vector<LasField> fields;
  std::vector<std::string> notes;  ///< what the description of extra bytes does not fit
};

/// All values of the file's records, extra bytes too. A described value takes the name of a standard one
/// that it repeats (then the standard one becomes "las_..."): it is there because it is more exact.
LasLayout las_layout(const LasHeader& header);

/// A table whose columns point into `count` records at `records`.
RecordTable las_table(const LasLayout& layout, const char* records, std::size_t count, std::size_t stride);

}  // namespace limen
