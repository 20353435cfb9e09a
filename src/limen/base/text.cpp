// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

namespace limen {
namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Bytes of the UTF-8 character that `text` begins with; 0 where it begins with none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
  }
  // What is longer than it need be, half of a pair or beyond Unicode is none.
  const bool wrong = (first == 0xE0U && byte(1) < 0xA0U) || (first == 0xEDU && byte(1) > 0x9FU) ||
                     (first == 0xF0U && byte(1) < 0x90U) || (first == 0xF4U && byte(1) > 0x8FU);
  return wrong ? 0 : length;
}

/// U+061C, 200E, 200F, 2028 to 202E and 2066 to 2069 as \uXXXX: they steer how the rest of a line is shown.
/// Nothing for other characters.
std::string steering_character(std::string_view character) {
  std::uint32_t code = 0;
  if (character.size() == 2) code = static_cast<unsigned char>(character[0]) & 0x1FU;
  if (character.size() == 3) code = static_cast<unsigned char>(character[0]) & 0x0FU;
  for (std::size_t k = 1; k < character.size(); ++k)
    code = code << 6U | (static_cast<unsigned char>(character[k]) & 0x3FU);
  const bool steers = code == 0x061CU || code == 0x200EU || code == 0x200FU ||
                      (code >= 0x2028U && code <= 0x202EU) || (code >= 0x2066U && code <= 0x2069U);
  return steers && character.size() < 4 ? fmt::format("\\u{:04X}", code) : std::string();
}

/// The same; 0 also for a character that commands a terminal.
std::size_t printable_length(std::string_view text) {
  const std::size_t length = utf8_length(text);
  const auto first = static_cast<unsigned char>(text[0]);
  if (length == 1) return first >= 0x20U && first != 0x7FU ? 1 : 0;
  // U+0080 to U+009F are controls.
  return length == 2 && first == 0xC2U && static_cast<unsigned char>(text[1]) < 0xA0U ? 0 : length;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    const std::string steering = steering_character(text.substr(0, length));
    if (length == 0)
      shown += '?';
    else if (steering.empty())
      shown += text.substr(0, length);
    else
      shown += steering;
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return shown;
}

std::string printable_lines(std::string_view text) {
  std::string shown;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of("\n\t", begin), text.size());
    shown += printable(text.substr(begin, end - begin));
    if (end < text.size()) shown += text[end];
    begin = end + 1;
  }
  return shown;
}

std::string shortened(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return std::string(text);
  constexpr std::size_t kRoomForNumber = 40;
  const std::size_t kept = most_bytes > kRoomForNumber ? most_bytes - kRoomForNumber : 0;
  const auto within = [&](std::size_t k) {
    return k < text.size() && (static_cast<unsigned char>(text[k]) & 0xC0U) == 0x80U;
  };
  std::size_t head = kept - kept / 3;
  std::size_t tail = text.size() - kept / 3;
  while (head > 0 && within(head)) --head;
  while (within(tail)) ++tail;
  return fmt::format("{} [{} bytes left out] {}", text.substr(0, head), tail - head, text.substr(tail));
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0)
      valid += "\xEF\xBF\xBD";
    else
      valid += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r' || c == '\0') c = ' ';
  }
  return text;
}

std::string percent_words(double probability) {
  if (!(probability >= 0.0 && probability <= 1.0)) return "—";
  if (probability > 0.9999) return "more than 99.99 %";
  if (probability < 0.0001) return "less than 0.01 %";
  const int digits = probability >= 0.99   ? 2
                     : probability >= 0.9  ? 1
                     : probability >= 0.1  ? 0
                     : probability >= 0.01 ? 1
                                           : 2;
  if (probability < 0.9) return fmt::format("{:.{}f} %", 100.0 * probability, digits);
  const double scale = digits == 2 ? 1e4 : 1e3;
  return fmt::format("{:.{}f} %", 100.0 * std::floor(scale * probability + 1e-9) / scale, digits);
}

std::string shell_word(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += c;
    }
  }
  return word + "'";
}

std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words;
  bool quoted = false;
  bool within = false;  // of a word
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (!quoted && line[k] == ' ') {
      within = false;
      continue;
    }
    if (!within) words.emplace_back();
    within = true;
    if (line[k] == '\'') {
      quoted = !quoted;
    } else if (!quoted && line[k] == '\\' && k + 1 < line.size()) {
      words.back() += line[++k];
    } else {
      words.back() += line[k];
    }
  }
  return words;
}

std::string reason_of(int error_number) {
  return std::generic_category().message(error_number);
}

}  // namespace limen
