// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
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

/// The file's XML; at least one scan.
std::string e57_description_xml(const std::vector<E57Entry>& entries);

/// A pose as an element.
std::string e57_pose_xml(const Rigid3& pose);

/// A number with the 17 digits that bring it back.
std::string e57_number(double value);

}  // namespace limen
