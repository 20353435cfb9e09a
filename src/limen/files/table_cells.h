// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// What is between the columns of a table whose first line this is: a semicolon, a tab, else a comma.
char table_mark(std::string_view header);

/// The cells of a line, without blanks around; a quoted cell may hold the mark.
std::vector<std::string> table_cells(std::string_view line, char mark);

/// A text as a field of a CSV that limen writes, quoted where it must be (RFC 4180). What a spreadsheet would
/// take for a formula, because it begins with = + - @ or a tab or end of line, gets an apostrophe before it.
std::string csv_field(std::string_view text);

/// A line of a table.
struct TableRow {
  std::vector<std::string> cells;
  int line = 0;  ///< from 1
};

struct TextTable {
  char mark = ',';  ///< between the columns
  TableRow columns;
  std::vector<TableRow> rows;
};

/// Reads a table whose first line names the columns; lines that are empty or begin with # do not count. Where
/// there is none it has no columns. Throws Error that names the file, the line and both numbers where a line
/// has more cells than there are columns (empty ones at the end do not count), or says why the file cannot be
/// read.
TextTable read_text_table(const std::filesystem::path& path);

}  // namespace limen
