// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"
#include "limen/io/ply/ply.h"
#include "limen/io/ply/ply_header.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"
#include "limen/io/table/table_stream.h"

namespace limen {
namespace {

/// A PLY file in memory and its points' element.
struct PlySource {
  std::string_view bytes;
  const std::string& name;
  const PlyHeader& header;
  std::size_t which;

  [[nodiscard]] const PlyElement& vertex() const { return header.elements[which]; }
};

[[noreturn]] void too_few(const PlySource& source, std::size_t there) {
  throw Error(
      fmt::format("the header promises {} points, the file has room for {}", source.vertex().count, there),
      source.name, "get the whole file, or correct the count");
}

/// Fields that point into the file.
RecordTable table_of_records(const PlySource& source, std::size_t start) {
  const PlyElement& vertex = source.vertex();
  const std::size_t stride = vertex.least_bytes();
  const std::size_t room = stride == 0 ? 0 : (source.bytes.size() - start) / stride;
  if (vertex.count > room) too_few(source, room);
  RecordTable table;
  table.rows = vertex.count;
  table.swapped = source.header.swapped();
  std::size_t at = start;
  for (const PlyProperty& property : vertex.properties) {
    table.fields.push_back({lower_case(property.name), property.type, source.bytes.data() + at, stride});
    at += size_of(property.type);
  }
  return table;
}

std::vector<std::string> scalar_names(const PlyElement& element) {
  std::vector<std::string> names;
  for (const PlyProperty& property : element.properties) {
    if (!property.count_type) names.push_back(lower_case(property.name));
  }
  return names;
}

/// Records of different lengths: their single values become numbers, their lists are passed over.
RecordTable table_of_listed_records(const PlySource& source, std::size_t start) {
  const PlyElement& vertex = source.vertex();
  const std::size_t room = (source.bytes.size() - start) / vertex.least_bytes();
  if (vertex.count > room) too_few(source, room);
  const bool swapped = source.header.swapped();
  const std::vector<std::string> names = scalar_names(vertex);
  auto numbers = std::make_shared<std::vector<double>>();
  numbers->reserve(vertex.count * names.size());
  std::size_t at = start;
  for (std::size_t i = 0; i < vertex.count; ++i) {
    const std::size_t end = at + ply_record_bytes(source.bytes, at, vertex, swapped, source.name);
    for (const PlyProperty& property : vertex.properties) {
      const Scalar stored = property.count_type.value_or(property.type);
      const double number = load_number(source.bytes.data() + at, stored, swapped);
      at += size_of(stored);
      if (property.count_type) {
        at += static_cast<std::size_t>(number) * size_of(property.type);
      } else {
        numbers->push_back(number);
      }
    }
    at = end;
  }
  return table_of_numbers(std::move(numbers), names);
}

/// The rows of a text body; each record is one line.
TextCloud text_of(const PlySource& source) {
  const PlyElement& vertex = source.vertex();
  TextCloud cloud;
  cloud.text = source.bytes.substr(source.header.body);
  cloud.file = source.name;
  cloud.wanted.rows = vertex.count;
  cloud.wanted.first_line_number = source.header.lines.size() + 1;
  for (std::size_t k = 0; k < source.which; ++k) {
    if (!source.header.elements[k].properties.empty()) cloud.wanted.skip += source.header.elements[k].count;
  }
  for (const PlyProperty& property : vertex.properties) {
    if (property.count_type) break;  // what follows a list has no fixed place in the line
    cloud.names.push_back(lower_case(property.name));
  }
  cloud.wanted.columns = cloud.names.size();
  return cloud;
}

RecordTable table_of_text(const PlySource& source) {
  const TextCloud cloud = text_of(source);
  if (cloud.names.empty()) return {};
  ParsedRows parsed = parse_rows(cloud.text, cloud.wanted, cloud.file);
  return table_of_numbers(std::make_shared<std::vector<double>>(std::move(parsed.numbers)), cloud.names);
}

RecordTable table_of(const PlySource& source) {
  if (source.header.encoding == PlyEncoding::ascii) return table_of_text(source);
  const std::size_t start = ply_element_start(source.bytes, source.header, source.which, source.name);
  if (source.vertex().has_lists()) return table_of_listed_records(source, start);
  return table_of_records(source, start);
}

TableFacts facts_of(const PlySource& source) {
  TableFacts facts;
  facts.name = source.name;
  facts.offset = source.header.offset;
  facts.has_offset = source.header.has_offset;
  facts.centre = source.header.centre;
  facts.centre_unknown = source.header.centre_unknown;
  return facts;
}

std::vector<std::string> field_names(const PlyElement& element) {
  std::vector<std::string> names;
  for (const PlyProperty& property : element.properties) names.push_back(property.name);
  return names;
}

const char* format_name(PlyEncoding encoding) {
  switch (encoding) {
    case PlyEncoding::ascii:
      return "PLY, ascii";
    case PlyEncoding::little_endian:
      return "PLY, binary, little-endian";
    case PlyEncoding::big_endian:
      return "PLY, binary, big-endian";
  }
  return "PLY";
}

}  // namespace

bool looks_like_ply(std::string_view bytes) {
  const auto tokens = split_tokens(first_line(bytes.substr(0, 16)).text);
  return tokens.size() == 1 && tokens[0] == "ply";
}

ScanFile read_ply(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const PlySource source{bytes, name, header, header.vertex(name)};
  ScanFile file;
  file.format = format_name(header.encoding);
  file.fields = field_names(source.vertex());
  return with_scan(std::move(file), table_of(source), facts_of(source), options);
}

std::unique_ptr<PointFile> open_ply(std::string_view bytes, const std::string& name) {
  auto header = std::make_shared<const PlyHeader>(parse_ply_header(bytes, name));
  const std::size_t which = header->vertex(name);
  const PlySource source{bytes, name, *header, which};
  CloudSource cloud;
  cloud.facts.table = facts_of(source);
  cloud.facts.points = source.vertex().count;
  cloud.facts.fields = field_names(source.vertex());
  cloud.open = [bytes, name, header, which] {
    const PlySource again{bytes, name, *header, which};
    return header->encoding == PlyEncoding::ascii ? stream_of_text(text_of(again))
                                                  : stream_of_table(table_of(again));
  };
  return make_point_file(format_name(header->encoding), {std::move(cloud)});
}

}  // namespace limen
