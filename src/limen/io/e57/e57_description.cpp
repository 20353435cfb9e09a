// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/e57/e57_description.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "limen/base/random.h"
#include "limen/base/text.h"
#include "limen/base/version.h"
#include "limen/io/table/value_tops.h"

namespace limen {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are in memory");

namespace {

template <typename Value>
void append_bytes(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void E57Encoder::append(double value) {
  range_.add(value);
  if (column_.storage == E57Storage::float32) {
    append_bytes(bytes_, static_cast<float>(value));
  } else {
    append_bytes(bytes_, value);
  }
}

bool E57Encoder::append_integer(std::int64_t value) {
  if (value < column_.minimum || value > column_.maximum) return false;
  range_.add(static_cast<double>(value));
  const std::uint64_t raw = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(column_.minimum);
  waiting_ |= filled_ < 64 ? raw << filled_ : 0;
  const unsigned room = 64 - filled_;
  filled_ += column_.bits;
  if (filled_ < 64) return true;
  append_bytes(bytes_, waiting_);
  filled_ -= 64;
  waiting_ = filled_ > 0 ? raw >> room : 0;
  return true;
}

void E57Encoder::finish() {
  for (; filled_ > 0; filled_ -= std::min(filled_, 8U), waiting_ >>= 8U) {
    bytes_ += static_cast<char>(waiting_ & 255U);
  }
}

std::string_view E57Encoder::take(std::size_t count) {
  const std::string_view bytes = std::string_view(bytes_).substr(taken_, count);
  taken_ += bytes.size();
  return bytes;
}

void E57Encoder::forget_taken() {
  bytes_.erase(0, taken_);
  taken_ = 0;
}

namespace {

constexpr const char* kNormals = "http://www.libe57.org/E57_NOR_surface_normals.txt";
constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<e57Root type=\"Structure\" xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\"";

/// Text as CDATA; what XML cannot hold becomes a blank.
std::string text_element(std::string_view name, std::string_view any_text) {
  std::string text = as_utf8(any_text);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 32 && c != '\n' && c != '\t') c = ' ';
  }
  constexpr std::string_view kSplit = "]]]]><![CDATA[>";
  for (std::size_t at = 0; (at = text.find("]]>", at)) != std::string::npos; at += kSplit.size())
    text.replace(at, 3, kSplit);
  return fmt::format("<{} type=\"String\"><![CDATA[{}]]></{}>\n", name, text, name);
}

std::string float_element(std::string_view name, double value) {
  return fmt::format("<{} type=\"Float\">{}</{}>\n", name, e57_number(value), name);
}

std::string guid_of(std::uint64_t digest) {
  const std::uint64_t a = mix64(digest);
  const std::uint64_t b = mix64(a);
  return fmt::format("{{{:08X}-{:04X}-{:04X}-{:04X}-{:012X}}}", a >> 32U, (a >> 16U) & 0xFFFFU, a & 0xFFFFU,
                     b >> 48U, b & 0xFFFFFFFFFFFFU);
}

std::string bounds_xml(const std::array<E57Range, 3>& bounds) {
  if (!bounds[0].known()) return {};
  std::string xml = "<cartesianBounds type=\"Structure\">\n";
  for (std::size_t k = 0; k < 3; ++k) {
    xml += float_element(fmt::format("{}Minimum", "xyz"[k]), bounds[k].low);
    xml += float_element(fmt::format("{}Maximum", "xyz"[k]), bounds[k].high);
  }
  return xml + "</cartesianBounds>\n";
}

std::string limits_xml(const E57Description& about) {
  std::string colours;
  std::string intensity;
  double largest = 0.0;
  bool integer = false;
  for (std::size_t k = 0; k < about.columns.size(); ++k) {
    if (about.columns[k].name.rfind("color", 0) != 0) continue;
    integer = integer || about.columns[k].storage == E57Storage::integer;
    if (about.ranges[k].known()) largest = std::max(largest, about.ranges[k].high);
  }
  for (std::size_t k = 0; k < about.columns.size(); ++k) {
    const std::string& name = about.columns[k].name;
    if (name.rfind("color", 0) == 0) {
      colours += float_element(name + "Minimum", 0.0);
      // The range of the values' kind, not of the values.
      colours += float_element(name + "Maximum", colour_top(largest, integer));
    } else if (name == "intensity" && about.ranges[k].known()) {
      intensity += float_element("intensityMinimum", about.ranges[k].low);
      intensity += float_element("intensityMaximum", about.ranges[k].high);
    }
  }
  std::string xml;
  if (!colours.empty()) xml += "<colorLimits type=\"Structure\">\n" + colours + "</colorLimits>\n";
  if (!intensity.empty())
    xml += "<intensityLimits type=\"Structure\">\n" + intensity + "</intensityLimits>\n";
  return xml;
}

std::string column_xml(const E57Column& column) {
  if (column.storage == E57Storage::float32) {
    return fmt::format("<{} type=\"Float\" precision=\"single\"/>\n", column.name);
  }
  if (column.storage == E57Storage::float64) return fmt::format("<{} type=\"Float\"/>\n", column.name);
  const bool scaled = column.scale != 1.0;
  const std::string scale = scaled ? fmt::format(" scale=\"{}\"", e57_number(column.scale)) : "";
  return fmt::format("<{} type=\"{}\" minimum=\"{}\" maximum=\"{}\"{}/>\n", column.name,
                     scaled ? "ScaledInteger" : "Integer", column.minimum, column.maximum, scale);
}

std::string scan_xml(const E57Description& about) {
  std::string xml = "<vectorChild type=\"Structure\">\n";
  xml += text_element("guid", guid_of(about.digest + 1)) + text_element("name", about.name);
  xml += text_element("limen:opticalCentre", about.centre_known ? "known" : "unknown");
  xml += e57_pose_xml({Matrix3d::Identity(), about.shift}) + bounds_xml(about.bounds) + limits_xml(about);
  xml += fmt::format("<points type=\"CompressedVector\" fileOffset=\"{}\" recordCount=\"{}\">\n",
                     about.section, about.points);
  xml += "<prototype type=\"Structure\">\n";
  for (const E57Column& column : about.columns) xml += column_xml(column);
  xml += "</prototype>\n<codecs type=\"Vector\" allowHeterogeneousChildren=\"1\"></codecs>\n</points>\n";
  return xml + "</vectorChild>\n";
}

}  // namespace

std::string e57_number(double value) {
  return fmt::format("{:.17g}", value);
}

std::string e57_pose_xml(const Rigid3& pose) {
  Eigen::Quaterniond q(pose.rotation);
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Vector3d& t = pose.translation;
  return "<pose type=\"Structure\"><rotation type=\"Structure\">\n" + float_element("w", q.w()) +
         float_element("x", q.x()) + float_element("y", q.y()) + float_element("z", q.z()) +
         "</rotation><translation type=\"Structure\">\n" + float_element("x", t.x()) +
         float_element("y", t.y()) + float_element("z", t.z()) + "</translation></pose>\n";
}

E57Entry e57_entry(const E57Description& about) {
  return {scan_xml(about),
          {},
          {{"nor", kNormals}, {"limen", std::string(kE57LimenSpace)}},
          about.georeference,
          about.digest};
}

std::string e57_panorama_xml(const E57Description& about, const E57Panorama& picture, std::uint64_t section) {
  std::string xml = "<vectorChild type=\"Structure\">\n";
  xml += text_element("guid", guid_of(about.digest + 2)) +
         text_element("associatedData3DGuid", guid_of(about.digest + 1)) +
         text_element("name", about.name + " panorama");
  xml += e57_pose_xml({Matrix3d::Identity(), about.shift});
  xml += fmt::format(
      "<sphericalRepresentation type=\"Structure\">\n<pngImage type=\"Blob\" fileOffset=\"{}\" "
      "length=\"{}\"/>\n<imageHeight type=\"Integer\">{}</imageHeight>\n<imageWidth "
      "type=\"Integer\">{}</imageWidth>\n",
      section, picture.png.size(), picture.height, picture.width);
  xml += float_element("pixelHeight", std::numbers::pi / static_cast<double>(picture.height)) +
         float_element("pixelWidth", 2.0 * std::numbers::pi / static_cast<double>(picture.width));
  return xml + "</sphericalRepresentation>\n</vectorChild>\n";
}

std::string e57_description_xml(const std::vector<E57Entry>& entries) {
  std::uint64_t digest = entries.front().digest;
  std::string scans;
  std::string images;
  std::vector<std::string> georeference;
  std::map<std::string, std::string> spaces;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const E57Entry& entry = entries[k];
    if (k > 0) digest = mix64(digest ^ entry.digest);
    scans += entry.scan;
    images += entry.images;
    for (const std::string& text : entry.georeference) {
      if (std::find(georeference.begin(), georeference.end(), text) == georeference.end())
        georeference.push_back(text);
    }
    spaces.insert(entry.spaces.begin(), entry.spaces.end());
  }
  std::string xml(kHead);
  for (const auto& [prefix, address] : spaces) xml += fmt::format(" xmlns:{}=\"{}\"", prefix, address);
  xml += ">\n" + text_element("formatName", "ASTM E57 3D Imaging Data File");
  xml += text_element("guid", guid_of(digest));
  xml += "<versionMajor type=\"Integer\">1</versionMajor>\n<versionMinor type=\"Integer\">0</versionMinor>\n";
  xml += text_element("e57LibraryVersion", fmt::format("limen {}", kVersion));
  xml += text_element("coordinateMetadata", fmt::format("{}", fmt::join(georeference, "\n")));
  xml += "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">\n" + scans + "</data3D>\n";
  return xml + "<images2D type=\"Vector\" allowHeterogeneousChildren=\"1\">" + images +
         "</images2D>\n</e57Root>\n";
}

}  // namespace limen
