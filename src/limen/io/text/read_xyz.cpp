// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"
#include "limen/io/table/table_stream.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

using Names = std::vector<std::string>;

/// Lines before the first row of numbers are no more than this.
constexpr std::size_t kMostHeaderLines = 1000;
/// More values than any scanner writes of a point; a whole cloud on one line has more.
constexpr std::size_t kMostTextColumns = 1000;
/// Rows that are looked at to tell colours from normals.
constexpr std::size_t kSample = 1000;

std::size_t leading_numbers(std::string_view line) {
  std::size_t count = 0;
  for (const std::string_view token : split_tokens(line)) {
    if (!parse_number(token)) break;
    ++count;
  }
  return count;
}

std::string_view without_comment_sign(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of("/#% "), line.size()));
  return line;
}

/// The column names in a line, lower case, units in brackets taken off; empty where x, y and z are not among
/// them.
Names column_names(std::string_view line) {
  Names names;
  for (const std::string_view token : split_tokens(without_comment_sign(line))) {
    names.push_back(lower_case(token.substr(0, token.find_first_of("[("))));
  }
  for (const char* wanted : {"x", "y", "z"}) {
    if (std::find(names.begin(), names.end(), wanted) == names.end()) return {};
  }
  return names;
}

/// What is before the rows.
struct TextHeader {
  Names names;            ///< of the last line that has as many as a row has numbers, else of the last line
  bool counted = false;   ///< a lone whole number: PTS
  std::size_t body = 0;   ///< bytes before the first row (or count)
  std::size_t lines = 0;  ///< lines before it
  std::string_view odd_line;  ///< the first line that is no comment, no names, no numbers
  std::size_t odd_number = 0;
  std::string_view row;            ///< the first row; empty where there is none
  bool ended_by_return = false;    ///< which is not followed by a line feed
  std::optional<Vector3d> centre;  ///< of the scanner, as the first comment before the rows states it
};

bool is_comment(std::string_view line) {
  const auto tokens = split_tokens(line);
  return tokens.empty() || tokens[0][0] == '#' || tokens[0][0] == '%' || tokens[0].substr(0, 2) == "//";
}

/// The line of names that is meant: a comment too may have the words x, y and z.
Names names_for(std::size_t numbers, const std::vector<Names>& lines) {
  const auto as_many = [numbers](const Names& names) { return names.size() == numbers; };
  const auto found = std::find_if(lines.rbegin(), lines.rend(), as_many);
  if (found != lines.rend()) return *found;
  return lines.empty() ? Names() : lines.back();
}

TextHeader parse_text_header(std::string_view bytes) {
  TextHeader header;
  std::vector<Names> lines_of_names;
  std::size_t at = bytes.size() - without_byte_order_mark(bytes).size();
  bool first_row_found = false;
  for (std::size_t line_number = 1; at < bytes.size() && line_number < kMostHeaderLines; ++line_number) {
    const TextLine line = first_line(bytes.substr(at));
    const std::size_t numbers = leading_numbers(line.text);
    if (numbers > 0 && !first_row_found) {
      first_row_found = true;
      header.body = at;
      header.lines = line_number - 1;
      header.counted = split_tokens(line.text).size() == 1 && parse_count(split_tokens(line.text)[0]);
    }
    if (numbers > 1 || (numbers == 1 && !header.counted)) {
      header.row = line.text;
      const std::string_view ending = bytes.substr(at + line.text.size(), 2);
      header.ended_by_return = ending.size() == 2 && ending[0] == '\r' && ending[1] != '\n';
      header.names = names_for(numbers, lines_of_names);
      return header;
    }
    if (!header.centre && !first_row_found) header.centre = scanner_position_in(line.text);
    Names names = numbers == 0 ? column_names(line.text) : Names();
    if (!names.empty()) lines_of_names.push_back(std::move(names));
    if (numbers == 0 && lines_of_names.empty() && !is_comment(line.text) && header.odd_number == 0) {
      header.odd_line = line.text;
      header.odd_number = line_number;
    }
    at += line.bytes;
  }
  return header;
}

/// "1,5;2,5;3" or "1,5 2,5 3": every piece between semicolons or blanks has one comma at most and no point.
bool has_decimal_commas(std::string_view row) {
  std::size_t pieces = 0;
  bool any = false;
  while (!row.empty()) {
    const std::size_t end = std::min(row.find_first_of("; \t\r"), row.size());
    std::string_view piece = row.substr(0, end);
    row.remove_prefix(std::min(row.size(), end + 1));
    if (!row.empty() && !piece.empty() && piece.back() == ',') piece.remove_suffix(1);  // "1,5, 2,5"
    if (piece.empty()) continue;
    const auto commas = std::count(piece.begin(), piece.end(), ',');
    if (piece.find('.') != std::string_view::npos || commas > 1) return false;
    if (piece.front() == ',' || piece.back() == ',') return false;
    any = any || commas == 1;
    ++pieces;
  }
  return any && pieces >= 3;
}

/// Whether columns 3 to 5 are colours: whole numbers from 0 to 255, not all of them 0 or 1.
bool are_colours(const std::vector<double>& numbers, std::size_t columns) {
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(kSample, numbers.size() / columns); ++i) {
    for (std::size_t k = 3; k < 6; ++k) {
      const double value = numbers[i * columns + k];
      if (!(value >= 0.0 && value <= 255.0) || value != std::floor(value)) return false;
      largest = std::max(largest, value);
    }
  }
  return largest > 1.0;
}

Names names_by_position(const std::vector<double>& numbers, std::size_t columns) {
  Names names{"x", "y", "z"};
  if (columns == 4 || columns == 7) names.emplace_back("intensity");
  if (columns == 7 || (columns == 6 && are_colours(numbers, columns))) {
    for (const char* colour : {"red", "green", "blue"}) names.emplace_back(colour);
  }
  while (names.size() < columns) names.push_back(fmt::format("column{}", names.size() + 1));
  return names;
}

/// Bytes of the first `count` lines.
std::size_t first_lines(std::string_view text, std::size_t count) {
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < count && bytes < text.size(); ++k)
    bytes += first_line(text.substr(bytes)).bytes;
  return bytes;
}

void require_rows(const TextHeader& header, const std::string& name) {
  if (header.odd_number > 0) {
    std::string shown;
    for (const char c : header.odd_line.substr(0, 40)) shown += c >= ' ' && c < 127 ? c : ' ';
    throw Error(fmt::format("neither rows of numbers nor names of columns with x, y and z: \"{}\"", shown),
                fmt::format("{}, line {}", name, header.odd_number),
                "give points as lines of numbers, or a PLY, PCD or PTX file");
  }
  if (header.row.empty()) throw Error("there are no points", name, "check how the file was exported");
  const std::string where = fmt::format("{}, line {}", name, header.lines + 1);
  if (header.ended_by_return)
    throw Error("the lines end with a carriage return alone", where,
                "save the file with line ends of Linux or Windows");
  if (has_decimal_commas(header.row)) {
    throw Error("the numbers have decimal commas", where, "write them with decimal points");
  }
  const std::size_t columns = leading_numbers(header.row);
  if (columns < 3) throw Error("a row of points needs three numbers", where, "give points as x y z");
  if (columns > kMostTextColumns) {
    throw Error(
        fmt::format("a row of {} numbers is not a point: at most {} are possible", columns, kMostTextColumns),
        where, "write each point on a line of its own");
  }
}

/// The rows of a file, with the names of their columns.
TextCloud text_of(std::string_view bytes, const TextHeader& header, const std::string& name) {
  TextCloud cloud;
  cloud.text = bytes.substr(header.body);
  cloud.file = name;
  cloud.wanted.columns = leading_numbers(header.row);
  if (!header.names.empty()) cloud.wanted.columns = std::min(cloud.wanted.columns, header.names.size());
  cloud.wanted.first_line_number = header.lines + 1;
  cloud.wanted.counts_allowed = header.counted;
  cloud.names = header.names;
  if (cloud.names.empty()) {
    const std::size_t sample = first_lines(cloud.text, 2 * kSample);
    const ParsedRows parsed = parse_rows(cloud.text.substr(0, sample), cloud.wanted, name);
    cloud.names = names_by_position(parsed.numbers, cloud.wanted.columns);
  }
  cloud.names.resize(cloud.wanted.columns);
  return cloud;
}

const char* format_name(const TextHeader& header) {
  return header.counted ? "PTS text" : "XYZ text";
}

/// Lines of a text, which are no fewer than its rows.
std::size_t line_count(std::string_view text) {
  const auto ends = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  return ends + (!text.empty() && text.back() != '\n' ? 1 : 0);
}

}  // namespace

std::optional<Vector3d> scanner_position_in(std::string_view line) {
  if (!is_comment(line)) return {};
  const std::vector<std::string_view> tokens = split_tokens(without_comment_sign(line));
  if (tokens.size() != 4 || lower_case(tokens[0]) != "scanner_position") return {};
  Vector3d x;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<double> number = parse_number(tokens[k + 1]);
    if (!number || !std::isfinite(*number)) return {};
    x[static_cast<Eigen::Index>(k)] = *number;
  }
  return x;
}

bool looks_like_xyz(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 65536);
  if (head.substr(0, 4096).find('\0') != std::string_view::npos) return false;
  const TextHeader header = parse_text_header(head);
  return header.odd_number == 0 && leading_numbers(header.row) >= 3;
}

ScanFile read_xyz(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const TextHeader header = parse_text_header(bytes);
  require_rows(header, name);
  const TextCloud cloud = text_of(bytes, header, name);
  ParsedRows parsed = parse_rows(cloud.text, cloud.wanted, name);
  if (header.counted && parsed.promised > parsed.rows) {
    throw Error(fmt::format("the file ends after {} of {} points", parsed.rows, parsed.promised), name,
                "get the whole file, or correct the count");
  }
  ScanFile file;
  file.format = format_name(header);
  file.fields = cloud.names;
  if (const std::size_t numbers = leading_numbers(header.row); numbers > cloud.names.size()) {
    file.notes.push_back(
        fmt::format("its rows have {} numbers, but {} columns have names: the rest is unused", numbers,
                    cloud.names.size()));
  }
  if (header.counted && parsed.promised < parsed.rows) {
    file.notes.push_back(
        fmt::format("the count says {}, the file holds {} points", parsed.promised, parsed.rows));
  }
  TableFacts facts;
  facts.name = name;
  facts.centre = header.centre;
  auto numbers = std::make_shared<std::vector<double>>(std::move(parsed.numbers));
  return with_scan(std::move(file), table_of_numbers(std::move(numbers), cloud.names), facts, options);
}

TextLayout text_layout(std::string_view bytes, const std::string& name) {
  const TextHeader header = parse_text_header(bytes);
  require_rows(header, name);
  return {header.body, header.counted, text_of(bytes, header, name).names};
}

std::unique_ptr<PointFile> open_xyz(std::string_view bytes, const std::string& name) {
  const TextHeader header = parse_text_header(bytes);
  require_rows(header, name);
  const TextCloud text = text_of(bytes, header, name);
  CloudSource cloud;
  cloud.facts.table.name = name;
  cloud.facts.table.centre = header.centre;
  cloud.facts.points = line_count(text.text);
  cloud.facts.fields = text.names;
  cloud.open = [text] { return stream_of_text(text); };
  return make_point_file(format_name(header), {std::move(cloud)});
}

}  // namespace limen
