// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// With the letters of ASCII in one case; all other bytes stay.
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);

/// Without spaces, tabs and ends of lines at either end.
std::string_view trimmed(std::string_view text);

/// Without the byte order mark that some programs put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// With a question mark for every byte that is neither a printable character nor part of one in UTF-8: what
/// a damaged file holds must not command a terminal. Characters that change the direction of what follows, or
/// end its line, are written as \u202E: a name must not look like another.
std::string printable(std::string_view text);

/// The same of several lines: their ends and tabs stay.
std::string printable_lines(std::string_view text);

/// In at most so many bytes: of a longer text its beginning and its end, and how much is between.
std::string shortened(std::string_view text, std::size_t most_bytes);

/// Whether all bytes are characters in UTF-8; JSON tells no others.
bool is_utf8(std::string_view text);
/// The same text with U+FFFD for each byte that belongs to no character.
std::string as_utf8(std::string_view text);

/// With spaces for ends of lines and zero bytes.
std::string one_line(std::string text);

/// A probability for a reader: "97.3 %", "12 %", "0.03 %". Near 1 it is cut, not rounded: what is not certain
/// does not read as if it were.
std::string percent_words(double probability);

/// Text as a shell takes it for one word.
std::string shell_word(const std::string& text);

/// Words that `shell_word` made, with blanks between them.
std::vector<std::string> shell_words(const std::string& line);

/// "a, b, c and 4 more": what `words_of` says of the first `most` items of a list.
template <typename List, typename WordsOf>
std::string listed(const List& items, std::size_t most, const WordsOf& words_of) {
  std::string text;
  for (std::size_t k = 0; k < items.size() && k < most; ++k)
    text.append(k == 0 ? "" : ", ").append(words_of(items[k]));
  return items.size() > most ? text + " and " + std::to_string(items.size() - most) + " more" : text;
}

/// The lines that `line_of` makes of the first `most` items of a list, and how many items follow.
template <typename List, typename LineOf>
std::string first_lines(const List& items, std::size_t most, const LineOf& line_of) {
  std::string text;
  for (std::size_t k = 0; k < items.size() && k < most; ++k) text += line_of(items[k]);
  return items.size() > most ? text + "... " + std::to_string(items.size() - most) + " more\n" : text;
}

/// What the system says of an error number (errno), in words.
std::string reason_of(int error_number);

}  // namespace limen
