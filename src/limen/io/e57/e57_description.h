// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/io/e57/e57_document.h"
#include "limen/io/e57/e57_encode.h"

namespace limen {

/// What is written of one scan of a new E57 file.
struct E57Description {
  std::string name;
  std::vector<std::string> georeference;
  Vector3d shift = Vector3d::Zero();  ///< the pose
  bool centre_known = false;          ///< the pose is the optical centre
  std::array<E57Range, 3> bounds;     ///< of the points, about the shift
  std::uint64_t points = 0;
  std::uint64_t section = 0;  ///< physical offset
  std::uint64_t digest = 0;   ///< of the points
  std::vector<E57Column> columns;
  std::vector<E57Range> ranges;  ///< of the columns
};

/// The descriptions of all scans as the file's XML; at least one.
std::string e57_description_xml(const std::vector<E57Description>& scans);

/// A number with the 17 digits that bring it back.
std::string e57_number(double value);

}  // namespace limen
