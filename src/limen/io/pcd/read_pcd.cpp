// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/files/text_numbers.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/pcd/pcd_header.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"
#include "limen/io/table/table_stream.h"

namespace limen {
namespace {

bool packs_colour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4 && field.count == 1;
}

/// A field and, where it packs a colour, the three in it. The bytes of a packed colour are blue, green, red.
void add_field(RecordTable& table, const PcdField& field, const Field& placed) {
  if (field.count != 1) return;  // histograms and padding
  table.fields.push_back(placed);
  if (!packs_colour(field)) return;
  const char* const names[] = {"blue", "green", "red"};
  for (std::size_t k = 0; k < 3; ++k)
    table.fields.push_back({names[k], Scalar::uint8, placed.data + k, placed.stride});
}

RecordTable table_of_bytes(const PcdHeader& header, std::size_t points, const PcdBody& layout,
                           const std::string& name) {
  RecordTable table;
  table.rows = points;
  table.keeper = layout.expanded;
  table.swapped = std::endian::native == std::endian::big;
  const char* at = layout.data;
  for (const PcdField& field : header.fields) {
    const std::size_t bytes = field.size * field.count;
    if (field.name != "_") {
      add_field(table, field,
                {field.name, pcd_scalar(field, name), at, layout.by_field ? bytes : header.record_bytes()});
    }
    at += layout.by_field ? bytes * points : bytes;
  }
  return table;
}

/// Splits the packed colours of a text file, which are numbers there, into three columns of their own.
void split_colours(const PcdHeader& header, std::vector<std::string>& names, std::vector<double>& numbers) {
  const auto found = std::find_if(header.fields.begin(), header.fields.end(), packs_colour);
  if (found == header.fields.end()) return;
  const auto column =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), found->name) - names.begin());
  const std::size_t columns = names.size();
  std::vector<double> wider;
  wider.reserve(numbers.size() / columns * (columns + 3));
  for (std::size_t i = 0; i + columns <= numbers.size(); i += columns) {
    const double value = numbers[i + column];
    std::uint32_t packed = 0;
    if (found->type == 'F') {
      packed = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    } else if (value >= 0.0 && value <= 4294967295.0) {
      packed = static_cast<std::uint32_t>(value);
    }
    wider.insert(wider.end(), numbers.begin() + static_cast<std::ptrdiff_t>(i),
                 numbers.begin() + static_cast<std::ptrdiff_t>(i + columns));
    for (const unsigned shift : {16U, 8U, 0U}) wider.push_back(static_cast<double>((packed >> shift) & 255U));
  }
  numbers = std::move(wider);
  for (const char* colour : {"red", "green", "blue"}) names.emplace_back(colour);
}

/// The rows of a text body.
TextCloud text_of(std::string_view bytes, const PcdHeader& header, const std::string& name) {
  TextCloud cloud;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) cloud.names.push_back(field.count == 1 ? field.name : "_");
  }
  cloud.text = bytes.substr(header.body);
  cloud.file = name;
  cloud.wanted.columns = cloud.names.size();
  cloud.wanted.rows = header.point_count(name);
  cloud.wanted.first_line_number = header.lines + 1;
  cloud.change = [header, names = cloud.names](std::vector<double>& numbers) {
    std::vector<std::string> wider = names;
    split_colours(header, wider, numbers);
    return wider;
  };
  return cloud;
}

RecordTable table_of_text(std::string_view bytes, const PcdHeader& header, const std::string& name) {
  const TextCloud cloud = text_of(bytes, header, name);
  std::vector<double> numbers = parse_rows(cloud.text, cloud.wanted, name).numbers;
  const std::vector<std::string> names = cloud.change(numbers);
  return table_of_numbers(std::make_shared<std::vector<double>>(std::move(numbers)), names);
}

RecordTable table_of(std::string_view bytes, const PcdHeader& header, const std::string& name) {
  if (header.data == "ascii") return table_of_text(bytes, header, name);
  if (header.data == "binary" || header.data == "binary_compressed")
    return table_of_bytes(header, header.point_count(name), open_pcd_body(bytes, header, name), name);
  throw Error(fmt::format("unknown PCD data \"{}\" (known: ascii, binary, binary_compressed)", header.data),
              fmt::format("{}, line {}", name, header.lines), "export the file again");
}

TableFacts facts_of(const PcdHeader& header, const std::string& name) {
  TableFacts facts;
  facts.name = name;
  if (header.height > 1 && header.width > 0 && header.width == header.point_count(name) / header.height) {
    facts.columns = header.width;
  }
  if (header.viewpoint && !header.viewpoint->translation.isZero())
    facts.possible_centre = header.viewpoint->translation;
  return facts;
}

std::vector<std::string> field_names(const PcdHeader& header) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) names.push_back(field.name);
  return names;
}

std::vector<std::string> notes_of(const PcdHeader& header) {
  constexpr double kTurnedRad = 1e-6;
  if (!header.viewpoint || rotation_angle(header.viewpoint->rotation) < kTurnedRad) return {};
  return {fmt::format(
      "the view point of the file is turned by {:.3f} degrees: the points are taken to lie in the "
      "file's frame, as they are",
      degrees(rotation_angle(header.viewpoint->rotation)))};
}

}  // namespace

bool looks_like_pcd(std::string_view bytes) {
  std::string_view head = bytes.substr(0, 4096);
  while (!head.empty()) {
    const TextLine line = first_line(head);
    const auto tokens = split_tokens(line.text);
    if (!tokens.empty() && tokens[0].front() != '#') {
      return tokens[0] == "VERSION" || tokens[0] == "FIELDS" || tokens[0] == "COLUMNS";
    }
    if (line.text.substr(0, 6) == "# .PCD") return true;
    head.remove_prefix(line.bytes);
  }
  return false;
}

ScanFile read_pcd(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const PcdHeader header = parse_pcd_header(bytes, name);
  const RecordTable table = table_of(bytes, header, name);
  ScanFile file;
  file.format = "PCD, " + header.data;
  file.fields = field_names(header);
  file.notes = notes_of(header);
  return with_scan(std::move(file), table, facts_of(header, name), options);
}

std::unique_ptr<PointFile> open_pcd(std::string_view bytes, const std::string& name) {
  auto header = std::make_shared<const PcdHeader>(parse_pcd_header(bytes, name));
  CloudSource cloud;
  cloud.facts = {facts_of(*header, name), header->point_count(name), field_names(*header), notes_of(*header)};
  cloud.open = [bytes, name, header] {
    return header->data == "ascii" ? stream_of_text(text_of(bytes, *header, name))
                                   : stream_of_table(table_of(bytes, *header, name));
  };
  return make_point_file("PCD, " + header->data, {std::move(cloud)});
}

}  // namespace limen
