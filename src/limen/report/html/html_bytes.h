// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/report/html/html_scene.h"

namespace limen {

/// Points as three 16-bit numbers each within their box: x = low + step * number, along every axis. What is
/// lost is at most half a step.
struct QuantisedPoints {
  Vector3d low = Vector3d::Zero();
  Vector3d step = Vector3d::Zero();  ///< metres; 0 along an axis without extent
  std::vector<std::uint16_t> numbers;
};
QuantisedPoints quantise(const std::vector<Vector3d>& points);
QuantisedPoints quantise(const std::vector<Triangle3>& faces);

/// Little-endian bytes.
std::vector<std::uint8_t> bytes_of(const std::vector<std::uint16_t>& numbers);

/// Red, green, blue of 8 bits each as one number of 5 + 6 + 5 bits.
std::vector<std::uint16_t> packed_colours(const std::vector<std::uint8_t>& colours);

/// 0 to 255 between the 2nd and the 98th percentile.
std::vector<std::uint8_t> stretched(const std::vector<float>& intensities);

/// RFC 4648, section 4, with padding, on one line.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// Text for HTML content and quoted attributes. Bytes that are not UTF-8 become U+FFFD. Control characters
/// are written as printable_lines() writes them.
std::string escaped(const std::string& text);

}  // namespace limen
