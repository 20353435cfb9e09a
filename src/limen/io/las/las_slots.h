// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// How a number is stored in a LAS record.
enum class LasStore : std::uint8_t {
  coordinate,  ///< int32, steps from an offset; `axis` says which
  bits,        ///< some bits of a byte
  byte,
  word,    ///< uint16, rounded
  colour,  ///< uint16, spread from the range of the column
  angle,   ///< int16, steps of 0.006 degrees
  time,    ///< float64
  extra    ///< the column's own type
};

/// A column of a cloud and its place in the records of point formats 6 to 8.
struct LasSlot {
  std::size_t column = 0;  ///< of the plan
  LasStore store = LasStore::extra;
  std::size_t at = 0;  ///< byte within the record
  BitRange bits = {};
  int axis = 0;
  Scalar type = Scalar::uint8;  ///< for extra
};

/// Where all columns of a cloud go.
struct LasSlots {
  int point_format = 6;
  std::size_t point_bytes = 30;
  std::vector<LasSlot> slots;
  std::string extra_bytes;  ///< body of the record that describes the extra bytes; empty: there are none
};

/// Columns with a name of the format go to their places. Those that may not fit there exactly (wider
/// integers, fractions) and all others become extra bytes, too. `name` is of the file, for messages. Throws
/// Error where x, y or z is missing or there are more columns than a file can hold.
LasSlots las_slots(const CloudPlan& plan, const std::string& name);

}  // namespace limen
