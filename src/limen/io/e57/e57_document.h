// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/io/e57/e57_pages.h"

namespace limen {

/// How the values of one column of an E57 scan are stored.
enum class E57Storage : std::uint8_t { float32, float64, integer, text };

/// One column (a leaf of the prototype). An integer n is stored as n - minimum in as few bits as the bounds
/// need, none where they are equal; its value is offset + scale * n.
struct E57Column {
  std::string name;  ///< as in the file, with the names of its parents: "cartesianX", "nor:normalX"
  E57Storage storage = E57Storage::float64;
  std::int64_t minimum = INT64_MIN;
  std::int64_t maximum = INT64_MAX;
  double scale = 1.0;
  double offset = 0.0;
  unsigned bits = 64;  ///< per value; 0 for text too, which is not read
};
/// Bits that n - minimum takes.
unsigned e57_bits(std::int64_t minimum, std::int64_t maximum);

/// The least and the largest value of a colour.
struct E57Limits {
  double low = 0.0;
  double high = 0.0;
};

/// One scan (Data3D) as the description tells it.
struct E57Scan {
  std::string name;
  std::optional<Rigid3> pose;  ///< file from scan
  double quaternion_length = 1.0;
  double acquisition_start_s = 0.0;  ///< GPS time, 0: not stated
  std::array<std::optional<E57Limits>, 3> colour_limits;
  std::string centre_word;  ///< what limen wrote of the scanner position: "known", "unknown" or nothing
  std::uint64_t points = 0;
  std::uint64_t section = 0;  ///< physical offset of the points
  std::vector<E57Column> columns;
};

/// One image: only where it is.
struct E57Image {
  std::optional<Rigid3> pose;  ///< file from image
  bool projected = false;      ///< it has a projection, so that its place matters (no pose: the identity)
};

/// The description (XML) of an E57 file.
struct E57Document {
  std::vector<E57Scan> scans;
  std::vector<E57Image> images;
  std::string coordinates;  ///< its coordinate system (WKT) or nothing
};

/// The bytes of the description, their check sums verified. Throws Error.
std::string e57_xml(const E57Pages& pages);
/// Throws Error where it is not what the standard asks for; `name` is the file's, for messages.
E57Document parse_e57_document(std::string_view xml, const std::string& name);

/// The namespace of columns that limen adds.
inline constexpr std::string_view kE57LimenSpace = "urn:limen:e57";
/// A name as an XML name, and back: what may not stand there becomes _xHH_.
std::string e57_escaped_name(std::string_view name);
std::string e57_plain_name(std::string_view escaped);

}  // namespace limen
