// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::array<std::size_t, 11> kPointBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kGpsTimeAt{0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22};
constexpr std::array<std::size_t, 11> kColoursAt{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
constexpr std::array<std::size_t, 11> kInfraredAt{0, 0, 0, 0, 0, 0, 0, 0, 36, 0, 36};
constexpr std::array<std::size_t, 11> kWavePacketAt{0, 0, 0, 0, 28, 34, 0, 0, 0, 30, 38};

constexpr std::size_t kMostDescribed = 1000;  ///< more extra values are damage

std::size_t at(const std::array<std::size_t, 11>& places, int point_format) {
  return places[static_cast<std::size_t>(point_format)];
}

class Columns {
 public:
  void add(std::size_t place, const char* name, Scalar type, BitRange bits = {}) {
    LasField value{place, {}};
    value.field.name = name;
    value.field.type = type;
    value.field.bits = bits;
    fields_.push_back(std::move(value));
  }
  void add(LasField value) { fields_.push_back(std::move(value)); }
  LasField& last() { return fields_.back(); }
  [[nodiscard]] std::vector<LasField>& all() { return fields_; }

 private:
  std::vector<LasField> fields_;
};

void add_short_head(Columns& columns) {
  columns.add(14, "return_number", Scalar::uint8, {0, 3});
  columns.add(14, "number_of_returns", Scalar::uint8, {3, 3});
  columns.add(14, "scan_direction_flag", Scalar::uint8, {6, 1});
  columns.add(14, "edge_of_flight_line", Scalar::uint8, {7, 1});
  columns.add(15, "classification", Scalar::uint8, {0, 5});
  columns.add(15, "synthetic", Scalar::uint8, {5, 1});
  columns.add(15, "key_point", Scalar::uint8, {6, 1});
  columns.add(15, "withheld", Scalar::uint8, {7, 1});
  columns.add(16, "scan_angle", Scalar::int8);
  columns.add(17, "user_data", Scalar::uint8);
  columns.add(18, "point_source_id", Scalar::uint16);
}

void add_long_head(Columns& columns) {
  columns.add(14, "return_number", Scalar::uint8, {0, 4});
  columns.add(14, "number_of_returns", Scalar::uint8, {4, 4});
  columns.add(15, "synthetic", Scalar::uint8, {0, 1});
  columns.add(15, "key_point", Scalar::uint8, {1, 1});
  columns.add(15, "withheld", Scalar::uint8, {2, 1});
  columns.add(15, "overlap", Scalar::uint8, {3, 1});
  columns.add(15, "scanner_channel", Scalar::uint8, {4, 2});
  columns.add(15, "scan_direction_flag", Scalar::uint8, {6, 1});
  columns.add(15, "edge_of_flight_line", Scalar::uint8, {7, 1});
  columns.add(16, "classification", Scalar::uint8);
  columns.add(17, "user_data", Scalar::uint8);
  columns.add(18, "scan_angle", Scalar::int16);
  columns.last().field.scale = kLasAngleStep;
  columns.add(20, "point_source_id", Scalar::uint16);
}

void add_wave_packet(Columns& columns, std::size_t place) {
  columns.add(place, "wave_packet_index", Scalar::uint8);
  columns.add(place + 1, "wave_packet_offset", Scalar::uint64);
  columns.add(place + 9, "wave_packet_size", Scalar::uint32);
  columns.add(place + 13, "wave_packet_return_location", Scalar::float32);
  columns.add(place + 17, "wave_packet_x", Scalar::float32);
  columns.add(place + 21, "wave_packet_y", Scalar::float32);
  columns.add(place + 25, "wave_packet_z", Scalar::float32);
}

void add_standard(Columns& columns, const LasHeader& header) {
  static constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    columns.add(4 * k, kAxes[k], Scalar::int32);
    columns.last().field.scale = header.scale[static_cast<int>(k)];
    columns.last().field.offset = header.offset[static_cast<int>(k)];
  }
  columns.add(12, "intensity", Scalar::uint16);
  const int format = header.point_format;
  las_is_long_format(format) ? add_long_head(columns) : add_short_head(columns);
  if (const std::size_t place = las_gps_time_at(format)) columns.add(place, "gps_time", Scalar::float64);
  if (const std::size_t place = las_colours_at(format)) {
    columns.add(place, "red", Scalar::uint16);
    columns.add(place + 2, "green", Scalar::uint16);
    columns.add(place + 4, "blue", Scalar::uint16);
  }
  if (const std::size_t place = las_infrared_at(format)) columns.add(place, "nir", Scalar::uint16);
  if (const std::size_t place = las_wave_packet_at(format)) add_wave_packet(columns, place);
}

/// What one description of extra bytes says.
struct ExtraValue {
  std::string name;
  Scalar type = Scalar::uint8;
  std::size_t elements = 1;
  bool described = true;  ///< false: plain bytes
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  std::array<double, 3> offset{0.0, 0.0, 0.0};
};

ExtraValue extra_value(std::string_view about) {
  static constexpr std::array<Scalar, 10> kTypes{
      Scalar::uint8, Scalar::int8,   Scalar::uint16, Scalar::int16,   Scalar::uint32,
      Scalar::int32, Scalar::uint64, Scalar::int64,  Scalar::float32, Scalar::float64};
  const unsigned type = static_cast<unsigned char>(about[2]);
  const unsigned options = static_cast<unsigned char>(about[3]);
  ExtraValue value;
  const std::string_view name = about.substr(4, 32);
  value.name = lower_case(name.substr(0, name.find('\0')));
  while (!value.name.empty() && value.name.back() == ' ') value.name.pop_back();
  std::replace(value.name.begin(), value.name.end(), ' ', '_');
  if (type == 0 || type > 30) {
    value.described = false;
    value.elements = type == 0 ? options : 0;
    return value;
  }
  value.type = kTypes[(type - 1) % 10];
  value.elements = 1 + (type - 1) / 10;
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = las_number<double>(about, 112 + 8 * k);
    const double offset = las_number<double>(about, 136 + 8 * k);
    if ((options & 8U) != 0 && std::isfinite(scale) && scale != 0.0) value.scale[k] = scale;
    if ((options & 16U) != 0 && std::isfinite(offset)) value.offset[k] = offset;
  }
  return value;
}

/// The name is a standard value's: that one steps back.
void give_name(Columns& columns, std::string& name) {
  for (LasField& other : columns.all()) {
    if (other.field.name != name) continue;
    const bool coordinate = name == "x" || name == "y" || name == "z";
    std::string& renamed = coordinate ? name : other.field.name;
    renamed.insert(0, coordinate ? "extra_" : "las_");
    return;
  }
}

/// Bytes without a name that are worth a column each: more are padding, or a damaged header.
constexpr std::size_t kMostUnnamed = 64;

void add_extra(Columns& columns, const ExtraValue& value, std::size_t place, std::size_t& unnamed) {
  if (!value.described && unnamed + value.elements > kMostUnnamed) {
    unnamed += value.elements;
    return;
  }
  for (std::size_t k = 0; k < value.elements; ++k) {
    LasField column{place + k * size_of(value.type), {}};
    const bool named = value.described && !value.name.empty();
    column.field.name = named ? value.name : fmt::format("extra_bytes_{}", ++unnamed);
    if (named && value.elements > 1) column.field.name += fmt::format("_{}", k);
    column.field.type = value.type;
    column.field.scale = value.scale[std::min<std::size_t>(k, 2)];
    column.field.offset = value.offset[std::min<std::size_t>(k, 2)];
    give_name(columns, column.field.name);
    columns.add(std::move(column));
  }
}

}  // namespace

std::size_t las_point_bytes(int point_format) {
  return at(kPointBytes, point_format);
}
std::size_t las_gps_time_at(int point_format) {
  return at(kGpsTimeAt, point_format);
}
std::size_t las_colours_at(int point_format) {
  return at(kColoursAt, point_format);
}
std::size_t las_infrared_at(int point_format) {
  return at(kInfraredAt, point_format);
}
std::size_t las_wave_packet_at(int point_format) {
  return at(kWavePacketAt, point_format);
}

LasLayout las_layout(const LasHeader& header) {
  Columns columns;
  add_standard(columns, header);
  LasLayout layout;
  std::size_t place = las_point_bytes(header.point_format);
  std::size_t unnamed = 0;
  const LasRecord* about = header.find("LASF_Spec", 4);
  const std::size_t count = about == nullptr ? 0 : about->body.size() / kLasDescriptionBytes;
  for (std::size_t k = 0; k < std::min(count, kMostDescribed); ++k) {
    const ExtraValue value = extra_value(about->body.substr(k * kLasDescriptionBytes, kLasDescriptionBytes));
    const std::size_t bytes = value.elements * size_of(value.type);
    if (bytes > header.point_bytes - place) {
      layout.notes.push_back(
          fmt::format("{} extra values per point are described, but only {} are present", count, k));
      break;
    }
    add_extra(columns, value, place, unnamed);
    place += bytes;
  }
  ExtraValue rest;
  rest.described = false;
  rest.elements = header.point_bytes - place;
  add_extra(columns, rest, place, unnamed);
  if (unnamed > kMostUnnamed) {
    layout.notes.push_back(fmt::format(
        "{} bytes per point are not described by the header, and not all of them are read as values",
        unnamed));
  }
  layout.fields = std::move(columns.all());
  return layout;
}

RecordTable las_table(const LasLayout& layout, const char* records, std::size_t count, std::size_t stride) {
  RecordTable table;
  table.rows = count;
  for (const LasField& value : layout.fields) {
    table.fields.push_back(value.field);
    table.fields.back().data = records + value.at;
    table.fields.back().stride = stride;
  }
  return table;
}

}  // namespace limen
