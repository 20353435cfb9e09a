// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A number that fills the whole token; a leading plus is allowed, nan and inf too.
std::optional<double> parse_number(std::string_view token);
/// A whole number >= 0 that fills the whole token.
std::optional<std::size_t> parse_count(std::string_view token);

/// The pieces of `line` between blanks, tabs, commas and semicolons; quotation marks are taken off.
std::vector<std::string_view> split_tokens(std::string_view line);

/// The line at the front of `text` without its end (LF, CR LF or CR), and the bytes it takes with its end.
struct TextLine {
  std::string_view text;
  std::size_t bytes = 0;
};
TextLine first_line(std::string_view text);

/// False for lines that hold nothing: empty ones and comments that begin with #, % or //.
bool holds_row(std::string_view line);

/// Rows of numbers in a text.
struct TextRows {
  std::size_t columns = 0;            ///< numbers wanted of each row; further ones are ignored
  std::size_t skip = 0;               ///< rows to pass over at the beginning
  std::optional<std::size_t> rows;    ///< rows wanted; empty: all
  std::size_t first_line_number = 1;  ///< of the text in its file, for messages
  bool counts_allowed = false;        ///< a lone number is a count of points (PTS), not a row
};

struct ParsedRows {
  std::vector<double> numbers;  ///< row after row
  std::size_t rows = 0;
  std::size_t promised = 0;  ///< sum of the counts
  std::size_t lines = 0;     ///< of the text, rows or not
};

/// Reads rows of numbers on all threads. Lines of which holds_row() is false are passed over.
/// Throws Error with file and line where a row is too short or holds a word, and where rows are missing.
ParsedRows parse_rows(std::string_view text, const TextRows& wanted, const std::string& name);

}  // namespace limen
