// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// GeoTIFF keys: OGC GeoTIFF Standard 19-008r4, 7.1.4 (linear units) and annex B.
#include "limen/io/las/las_unit.h"

#include <charconv>
#include <cmath>
#include <string>

namespace limen {
namespace {

constexpr std::uint16_t kKeyDirectory = 34735;
constexpr std::uint16_t kDoubles = 34736;
constexpr std::uint16_t kModelType = 1024;
constexpr std::uint16_t kRasterType = 1025;
constexpr std::uint16_t kProjectedSystem = 3072;
constexpr std::uint16_t kUserDefined = 32767;
constexpr std::uint16_t kProjLinearUnits = 3076;
constexpr std::uint16_t kProjLinearUnitSize = 3077;

bool plausible(double metres) {
  return std::isfinite(metres) && metres > 1e-6 && metres < 1e6;
}

/// EPSG codes of units of length.
std::optional<double> metres_of_code(std::uint16_t code) {
  switch (code) {
    case 9001:
      return 1.0;
    case 9002:
      return 0.3048;
    case 9003:
      return 1200.0 / 3937.0;
    default:
      return std::nullopt;
  }
}

std::optional<double> double_at(const LasHeader& header, std::size_t index) {
  const LasRecord* record = header.find("LASF_Projection", kDoubles);
  if (record == nullptr || record->body.size() < 8 * (index + 1)) return std::nullopt;
  return las_number<double>(record->body, 8 * index);
}

std::optional<double> unit_of_keys(const LasHeader& header) {
  const LasRecord* record = header.find("LASF_Projection", kKeyDirectory);
  if (record == nullptr) return std::nullopt;
  const std::string_view body = record->body;
  std::optional<double> unit;
  // Four numbers each: key, where its value is (0: here), how many, value or place.
  for (std::size_t at = 8; at + 8 <= body.size(); at += 8) {
    const auto key = las_number<std::uint16_t>(body, at);
    const auto place = las_number<std::uint16_t>(body, at + 2);
    const auto value = las_number<std::uint16_t>(body, at + 6);
    if (key == kProjLinearUnits && place == 0) unit = metres_of_code(value);
    if (key == kProjLinearUnitSize && place == kDoubles) unit = double_at(header, value);
  }
  return unit && plausible(*unit) ? unit : std::nullopt;
}

/// The text between the bracket at `open` and the one that closes it.
std::string_view bracketed(std::string_view text, std::size_t open) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t at = open; at < text.size(); ++at) {
    if (text[at] == '"') quoted = !quoted;
    if (quoted) continue;
    if (text[at] == '[' || text[at] == '(') ++depth;
    if (text[at] == ']' || text[at] == ')') --depth;
    if (depth == 0) return text.substr(open + 1, at - open - 1);
  }
  return {};
}

/// The number behind the first comma outside quotes.
std::optional<double> second_value(std::string_view inside) {
  bool quoted = false;
  for (std::size_t at = 0; at < inside.size(); ++at) {
    if (inside[at] == '"') quoted = !quoted;
    if (quoted || inside[at] != ',') continue;
    ++at;
    while (at < inside.size() && inside[at] == ' ') ++at;
    double number = 0.0;
    const auto read = std::from_chars(inside.data() + at, inside.data() + inside.size(), number);
    return read.ec == std::errc() ? std::optional(number) : std::nullopt;
  }
  return std::nullopt;
}

/// The last UNIT or LENGTHUNIT directly within a system: that of its axes, behind those of what it is made
/// from.
std::optional<double> own_unit(std::string_view system) {
  std::optional<double> unit;
  int depth = 0;
  bool quoted = false;
  std::string word;
  for (std::size_t at = 0; at < system.size(); ++at) {
    const char c = system[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') {
      if (depth == 0 && (word == "UNIT" || word == "LENGTHUNIT")) unit = second_value(bracketed(system, at));
      ++depth;
    }
    if (c == ']' || c == ')') --depth;
    if (c >= 'A' && c <= 'Z') {
      word += c;
    } else if (c != '_' && c != ' ') {
      word.clear();
    }
  }
  return unit;
}

}  // namespace

std::optional<double> wkt_metres_per_unit(std::string_view wkt) {
  for (const std::string_view name : {"PROJCS", "PROJCRS", "LOCAL_CS", "ENGCRS"}) {
    const std::size_t at = wkt.find(name);
    if (at == std::string_view::npos) continue;
    const std::size_t open = wkt.find_first_of("[(", at);
    if (open == std::string_view::npos) return std::nullopt;
    std::optional<double> unit = own_unit(bracketed(wkt, open));
    // ISO 19162 may give each axis its own.
    if (!unit) {
      const std::size_t axis = wkt.rfind("LENGTHUNIT");
      if (axis != std::string_view::npos && axis > at && axis + 10 < wkt.size())
        unit = second_value(bracketed(wkt, axis + 10));
    }
    return unit && plausible(*unit) ? unit : std::nullopt;
  }
  return std::nullopt;
}

std::optional<double> las_metres_per_unit(const LasHeader& header) {
  for (const std::string& text : las_coordinate_systems(header)) {
    if (const auto unit = wkt_metres_per_unit(text)) return unit;
  }
  return unit_of_keys(header);
}

std::string las_projected_code(const LasHeader& header) {
  const LasRecord* record = header.find("LASF_Projection", kKeyDirectory);
  if (record == nullptr) return {};
  for (std::size_t at = 8; at + 8 <= record->body.size(); at += 8) {
    if (las_number<std::uint16_t>(record->body, at) != kProjectedSystem) continue;
    const auto place = las_number<std::uint16_t>(record->body, at + 2);
    const auto value = las_number<std::uint16_t>(record->body, at + 6);
    if (place == 0 && value != 0 && value != kUserDefined) return "EPSG:" + std::to_string(value);
  }
  return {};
}

std::string las_key_directory(const std::string& code) {
  const auto number = static_cast<std::uint16_t>(std::stoul(code.substr(code.find(':') + 1)));
  constexpr std::uint16_t kProjected = 1;
  constexpr std::uint16_t kPixelIsArea = 1;
  constexpr std::uint16_t kMetre = 9001;
  // Version 1.1.0, then keys in ascending order, each with its value in place.
  const std::uint16_t numbers[] = {1,
                                   1,
                                   0,
                                   4,
                                   kModelType,
                                   0,
                                   1,
                                   kProjected,
                                   kRasterType,
                                   0,
                                   1,
                                   kPixelIsArea,
                                   kProjectedSystem,
                                   0,
                                   1,
                                   number,
                                   kProjLinearUnits,
                                   0,
                                   1,
                                   kMetre};
  std::string body;
  for (const std::uint16_t value : numbers) {
    body += static_cast<char>(value & 0xFFU);
    body += static_cast<char>(value >> 8U);
  }
  return body;
}

}  // namespace limen
