// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_document.h"

#include <bit>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

/// Scans and images take about 5 KB each: thousands of them fit.
constexpr std::uint64_t kLargestXmlBytes = std::uint64_t{64} << 20U;
constexpr int kDeepestPrototype = 8;
constexpr std::size_t kMostColumns = 4096;
constexpr const char* kExportAgain = "export the file again with another program or other settings";

/// Where in the file something is, for messages.
struct ElementPlace {
  std::string text;
  [[nodiscard]] ElementPlace inside(std::string_view part) const {
    return {fmt::format("{}, {}", text, part)};
  }
};

/// All text in an element, which may be in several pieces.
std::string text_of(const pugi::xml_node& node) {
  std::string text;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) text += child.value();
  }
  return std::string(trimmed(text));
}

/// A finite number; `fallback` where the text is empty.
double number_in(std::string_view text, double fallback, const ElementPlace& place) {
  text = trimmed(text);
  if (text.empty()) return fallback;
  const std::optional<double> number = parse_number(text);
  if (number && std::isfinite(*number)) return *number;
  throw Error(fmt::format("\"{}\" is not a number", text.substr(0, 40)), place.text, kExportAgain);
}

std::int64_t integer_in(std::string_view text, std::int64_t fallback, const ElementPlace& place) {
  text = trimmed(text);
  if (text.empty()) return fallback;
  if (text.front() == '+') text.remove_prefix(1);
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc{} && stop == text.data() + text.size()) return number;
  throw Error(fmt::format("\"{}\" is not a 64-bit integer", text.substr(0, 40)), place.text, kExportAgain);
}

double number_of(const pugi::xml_node& parent, const char* child, double fallback,
                 const ElementPlace& place) {
  return number_in(parent.child(child).child_value(), fallback, place.inside(child));
}

/// A count or an offset: a whole number >= 0 that must be there.
std::uint64_t count_of(const pugi::xml_node& node, const char* attribute, const ElementPlace& place) {
  const pugi::xml_attribute found = node.attribute(attribute);
  const std::int64_t number = integer_in(found.value(), -1, place.inside(attribute));
  if (number < 0) throw Error(fmt::format("{} is missing or negative", attribute), place.text, kExportAgain);
  return static_cast<std::uint64_t>(number);
}

Vector3d vector_of(const pugi::xml_node& node, const ElementPlace& place) {
  return {number_of(node, "x", 0.0, place), number_of(node, "y", 0.0, place),
          number_of(node, "z", 0.0, place)};
}

/// A pose and the length of its quaternion.
struct Pose {
  std::optional<Rigid3> pose;
  double quaternion_length = 1.0;
};

Pose pose_of(const pugi::xml_node& node, const ElementPlace& place) {
  if (!node) return {};
  Pose result;
  Rigid3 pose;
  pose.translation = vector_of(node.child("translation"), place);
  if (const pugi::xml_node rotation = node.child("rotation")) {
    const Vector3d axis = vector_of(rotation, place);
    const Eigen::Quaterniond q(number_of(rotation, "w", 0.0, place), axis.x(), axis.y(), axis.z());
    result.quaternion_length = q.norm();
    if (!(result.quaternion_length > 1e-9 && result.quaternion_length < 1e9)) {
      throw Error("the pose's quaternion is zero or absurd: it is not a rotation", place.text, kExportAgain);
    }
    pose.rotation = q.normalized().toRotationMatrix();
  }
  result.pose = pose;
  return result;
}

void read_bounds(const pugi::xml_node& node, E57Column& column, const ElementPlace& place) {
  column.minimum = integer_in(node.attribute("minimum").value(), INT64_MIN, place);
  column.maximum = integer_in(node.attribute("maximum").value(), INT64_MAX, place);
  if (column.minimum > column.maximum) {
    throw Error(fmt::format("the least value {} is above the greatest, {}", column.minimum, column.maximum),
                place.text, kExportAgain);
  }
  column.bits = e57_bits(column.minimum, column.maximum);
}

E57Column column_of(const pugi::xml_node& node, const std::string& name, const ElementPlace& scan) {
  const ElementPlace place = scan.inside(name);
  const std::string_view type = node.attribute("type").value();
  E57Column column;
  column.name = name;
  if (type == "Float") {
    const std::string_view precision = node.attribute("precision").value();
    if (precision != "" && precision != "single" && precision != "double") {
      throw Error(fmt::format("\"{}\" is not a precision", precision.substr(0, 40)), place.text,
                  kExportAgain);
    }
    column.storage = precision == "single" ? E57Storage::float32 : E57Storage::float64;
    column.bits = precision == "single" ? 32 : 64;
  } else if (type == "Integer" || type == "ScaledInteger") {
    column.storage = E57Storage::integer;
    read_bounds(node, column, place);
    if (type == "ScaledInteger") {
      column.scale = number_in(node.attribute("scale").value(), 1.0, place);
      column.offset = number_in(node.attribute("offset").value(), 0.0, place);
    }
  } else if (type == "String") {
    column.storage = E57Storage::text;
    column.bits = 0;
  } else {
    throw Error(fmt::format("values of the type \"{}\" are not known", type.substr(0, 40)), place.text,
                kExportAgain);
  }
  return column;
}

/// Leaves of the prototype, in the order of their streams.
void collect_columns(const pugi::xml_node& node, const std::string& prefix, int depth,
                     const ElementPlace& place, std::vector<E57Column>& columns) {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    const std::string name = prefix + child.name();
    const std::string_view type = child.attribute("type").value();
    if (type == "Structure" || type == "Vector") {
      if (depth >= kDeepestPrototype) throw Error("values are nested too deep", place.text, kExportAgain);
      collect_columns(child, name + "/", depth + 1, place, columns);
      continue;
    }
    columns.push_back(column_of(child, name, place));
    if (columns.size() > kMostColumns) {
      throw Error(fmt::format("more than {} values per point", kMostColumns), place.text, kExportAgain);
    }
  }
}

void read_colour_limits(const pugi::xml_node& limits, E57Scan& scan, const ElementPlace& place) {
  static constexpr std::array<const char*, 3> kLow{"colorRedMinimum", "colorGreenMinimum",
                                                   "colorBlueMinimum"};
  static constexpr std::array<const char*, 3> kHigh{"colorRedMaximum", "colorGreenMaximum",
                                                    "colorBlueMaximum"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!limits.child(kHigh[k])) continue;
    scan.colour_limits[k] = {number_of(limits, kLow[k], 0.0, place), number_of(limits, kHigh[k], 0.0, place)};
  }
}

E57Scan scan_of(const pugi::xml_node& node, const ElementPlace& place) {
  E57Scan scan;
  scan.name = text_of(node.child("name"));
  const Pose pose = pose_of(node.child("pose"), place.inside("pose"));
  scan.pose = pose.pose;
  scan.quaternion_length = pose.quaternion_length;
  read_colour_limits(node.child("colorLimits"), scan, place.inside("colorLimits"));
  scan.acquisition_start_s =
      number_of(node.child("acquisitionStart"), "dateTimeValue", 0.0, place.inside("acquisitionStart"));
  scan.centre_word = text_of(node.child("limen:opticalCentre"));
  const pugi::xml_node points = node.child("points");
  if (!points) throw Error("the scan has no points element", place.text, kExportAgain);
  if (std::string_view(points.attribute("type").value()) != "CompressedVector") {
    throw Error("the scan's points are not a CompressedVector", place.text, kExportAgain);
  }
  scan.points = count_of(points, "recordCount", place);
  scan.section = count_of(points, "fileOffset", place);
  collect_columns(points.child("prototype"), "", 0, place, scan.columns);
  if (scan.columns.empty()) throw Error("the scan's points have no values", place.text, kExportAgain);
  for (const pugi::xml_node& child : points.child("codecs").children()) {
    if (child.type() != pugi::node_element) continue;
    for (const pugi::xml_node& one : child.children()) {
      const std::string_view kind = one.name();
      if (one.type() != pugi::node_element || kind == "inputs" || kind == "bitPackCodec") continue;
      throw Error(fmt::format("the points are packed by \"{}\", which is not known", kind.substr(0, 40)),
                  place.text, kExportAgain);
    }
  }
  return scan;
}

bool is_name_byte(char c, bool first) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  return letter || (!first && ((c >= '0' && c <= '9') || c == '-' || c == '.'));
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// The byte that an escape _xHH_ at `at` represents, or -1.
int escaped_at(std::string_view name, std::size_t at) {
  const std::string_view part = name.substr(at, 5);
  if (part.size() < 5 || part.substr(0, 2) != "_x" || part[4] != '_') return -1;
  const int high = hex_digit(part[2]);
  const int low = hex_digit(part[3]);
  return high < 0 || low < 0 ? -1 : 16 * high + low;
}

}  // namespace

unsigned e57_bits(std::int64_t minimum, std::int64_t maximum) {
  const std::uint64_t span = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
  return static_cast<unsigned>(std::bit_width(span));
}

std::string e57_escaped_name(std::string_view name) {
  if (name == "_x_") return "_x5f_x_";  // "_x_" stands for no name at all
  std::string escaped;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (is_name_byte(name[i], i == 0) && escaped_at(name, i) < 0) {
      escaped += name[i];
    } else {
      escaped += fmt::format("_x{:02x}_", static_cast<unsigned char>(name[i]));
    }
  }
  return escaped.empty() ? "_x_" : escaped;
}

std::string e57_plain_name(std::string_view escaped) {
  if (escaped == "_x_") return {};
  std::string name;
  for (std::size_t i = 0; i < escaped.size(); ++i) {
    const int byte = escaped_at(escaped, i);
    name += byte < 0 ? escaped[i] : static_cast<char>(byte);
    if (byte >= 0) i += 4;
  }
  return name;
}

std::string e57_xml(const E57Pages& pages) {
  const E57Head& head = pages.head();
  // The head itself is what the first page's check sum guards.
  pages.check(0, 1);
  const std::uint64_t begin = pages.logical_of(head.xml_offset, "the description (XML)");
  if (head.xml_bytes == 0 || head.xml_bytes > pages.logical_size() - begin) {
    throw Error(fmt::format("the description (XML) would have {} bytes, which do not fit into the file",
                            head.xml_bytes),
                pages.name() + ", byte 32", "get the whole file, or export it again");
  }
  if (head.xml_bytes > kLargestXmlBytes) {
    throw Error(fmt::format("the description (XML) has {} bytes, more than {} MB are not read",
                            head.xml_bytes, kLargestXmlBytes >> 20U),
                pages.name(), "split the file into fewer scans");
  }
  pages.check(pages.page_of(begin), pages.page_of(begin + head.xml_bytes - 1) + 1);
  std::string xml(head.xml_bytes, '\0');
  pages.copy(begin, xml.size(), xml.data());
  return xml;
}

E57Document parse_e57_document(std::string_view xml, const std::string& name) {
  pugi::xml_document tree;
  // Trailing zero bytes are padding to some writers.
  while (!xml.empty() && xml.back() == '\0') xml.remove_suffix(1);
  const pugi::xml_parse_result parsed =
      tree.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    throw Error(fmt::format("the description (XML) is damaged at its byte {}: {}", parsed.offset,
                            parsed.description()),
                name, kExportAgain);
  }
  const pugi::xml_node root = tree.child("e57Root");
  if (!root) throw Error("the description (XML) holds no e57Root", name, kExportAgain);
  E57Document document;
  document.coordinates = text_of(root.child("coordinateMetadata"));
  for (const pugi::xml_node& child : root.child("images2D").children()) {
    if (child.type() != pugi::node_element) continue;
    const ElementPlace place{fmt::format("{}, image {}", name, document.images.size() + 1)};
    const bool projected = child.child("pinholeRepresentation") || child.child("sphericalRepresentation") ||
                           child.child("cylindricalRepresentation");
    document.images.push_back({pose_of(child.child("pose"), place.inside("pose")).pose, projected});
  }
  for (const pugi::xml_node& child : root.child("data3D").children()) {
    if (child.type() != pugi::node_element) continue;
    document.scans.push_back(scan_of(child, {fmt::format("{}, scan {}", name, document.scans.size() + 1)}));
  }
  return document;
}

}  // namespace limen
