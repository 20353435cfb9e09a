// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/table_cells.h"

#include <fstream>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/mapped_file.h"

namespace limen {
namespace {

/// Cells up to the last that holds something.
std::size_t filled(const std::vector<std::string>& cells) {
  std::size_t count = cells.size();
  while (count > 0 && cells[count - 1].empty()) --count;
  return count;
}

const char* remedy_for(char mark) {
  return mark == ','
             ? "write decimal points; for decimal commas put semicolons between the columns, in all lines"
             : "name all columns in the first line, or remove what is too much";
}

}  // namespace

char table_mark(std::string_view header) {
  for (const char mark : {';', '\t'}) {
    if (header.find(mark) != std::string_view::npos) return mark;
  }
  return ',';
}

std::vector<std::string> table_cells(std::string_view line, char mark) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == mark && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) cell = std::string(trimmed(cell));
  return cells;
}

std::string csv_field(std::string_view text) {
  constexpr std::string_view kFormulaMarks = "=+-@\t\r\n";
  std::string field;
  if (!text.empty() && kFormulaMarks.find(text.front()) != std::string_view::npos) field += '\'';
  field += text;
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

TextTable read_text_table(const std::filesystem::path& path) {
  require_readable(path, "give a text file whose first line names the columns", "table");
  std::ifstream stream(path, std::ios::binary);
  TextTable table;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::string_view text = trimmed(number == 1 ? without_byte_order_mark(line) : line);
    if (!is_utf8(text))
      throw Error("is not UTF-8 text", fmt::format("{}, line {}", path.string(), number),
                  "save it as CSV UTF-8");
    if (text.empty() || text.front() == '#') continue;
    if (table.columns.line == 0) {
      table.mark = table_mark(text);
      table.columns = {table_cells(text, table.mark), number};
      continue;
    }
    table.rows.push_back({table_cells(text, table.mark), number});
    const std::size_t fields = filled(table.rows.back().cells);
    if (fields > table.columns.cells.size())
      throw Error(fmt::format("{} fields, {} columns", fields, table.columns.cells.size()),
                  fmt::format("{}, line {}", path.string(), number), remedy_for(table.mark));
  }
  return table;
}

}  // namespace limen
