// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

struct SheetCell {
  std::string text;  ///< of a number as it is written: with a point, without blanks
  bool number = false;
};
using SheetRow = std::vector<SheetCell>;

SheetCell text_cell(std::string_view text);
/// With so many digits after the point; empty where it is not finite.
SheetCell number_cell(double value, int digits);
/// With three digits that count.
SheetCell short_number_cell(double value);
SheetCell count_cell(std::size_t count);

/// A table as spreadsheets take it, written as CSV or as a part of a workbook.
struct Sheet {
  std::string name;  ///< up to 31 characters, none of []:*?/\ among them
  std::vector<std::string> columns;
  std::vector<SheetRow> rows;  ///< as many cells as there are columns
};

/// The cells of a row with commas between them (RFC 4180), without an end of line.
std::string csv_line(const SheetRow& row);
/// The head and all rows, each ends with CR LF.
std::string csv_of(const Sheet& sheet);

/// The bytes of an Office Open XML workbook (ECMA-376), .xlsx; the same sheets give the same bytes. Heads are
/// bold and stay in sight, and each column can be filtered.
std::string workbook_of(const std::vector<Sheet>& sheets);

}  // namespace limen
