// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/bim/ifc/step_file.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "limen/base/progress.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

constexpr std::size_t kLongestType = 100;

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

bool digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether an entity begins at `at`: "#12 =".
bool entity_at(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size() || bytes[at] != '#') return false;
  std::size_t end = at + 1;
  while (end < bytes.size() && digit(bytes[end])) ++end;
  if (end == at + 1) return false;
  while (end < bytes.size() && bytes[end] == ' ') ++end;
  return end < bytes.size() && bytes[end] == '=';
}

/// Passes over a text that begins at `at`; returns the place behind its closing quotation mark. Two marks in
/// a row are one text after another, which comes to the same. A text that does not close before the next
/// entity has lost its mark and ends at the line's end.
std::size_t behind_text(std::string_view bytes, std::size_t at) {
  std::size_t end = at + 1;
  for (; end < bytes.size() && bytes[end] != '\''; ++end) {
    if (bytes[end] == '\n' && entity_at(bytes, end + 1)) return end;
  }
  return std::min(end + 1, bytes.size());
}

/// The end of the statement that begins at `at`: the place of its semicolon, or, where that is lost, the end
/// of the line before the next entity.
std::size_t end_of_statement(std::string_view bytes, const StepComments& comments, std::size_t at) {
  while (at < bytes.size() && bytes[at] != ';') {
    if (bytes[at] == '\n' && entity_at(bytes, at + 1)) return at;
    if (bytes[at] == '\'') {
      at = behind_text(bytes, at);
    } else if (comments.begins_at(at)) {
      at = comments.behind(at);
    } else {
      ++at;
    }
  }
  return std::min(at, bytes.size());
}

std::size_t begin_of_statement(std::string_view bytes, const StepComments& comments, std::size_t at) {
  while (at < bytes.size()) {
    if (blank(bytes[at])) {
      ++at;
    } else if (comments.begins_at(at)) {
      at = comments.behind(at);
    } else {
      break;
    }
  }
  return std::min(at, bytes.size());
}

/// What is in a STEP file beside entities.
bool is_keyword(const std::string& word) {
  static constexpr std::array<std::string_view, 10> kWords{
      "ISO-10303-21",    "END-ISO-10303-21", "HEADER",    "DATA",
      "ENDSEC",          "FILE_DESCRIPTION", "FILE_NAME", "FILE_SCHEMA",
      "FILE_POPULATION", "SECTION_LANGUAGE"};
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

/// Empty where an entity has several types at once; the longest of IFC has 51 characters.
bool is_type_name(std::string_view type) {
  return type.size() <= kLongestType && std::all_of(type.begin(), type.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || digit(c) || c == '_';
         });
}

/// True where every bracket in the arguments has its partner and every text its end.
bool brackets_match(std::string_view arguments) {
  const StepComments comments(arguments);
  int depth = 0;
  std::size_t at = 0;
  while (at < arguments.size() && depth >= 0) {
    if (arguments[at] == '\'') {
      at = arguments.find('\'', at + 1);
      if (at == std::string_view::npos) return false;
    } else if (comments.begins_at(at)) {
      at = comments.behind(at) - 1;
    } else {
      depth += arguments[at] == '(' ? 1 : arguments[at] == ')' ? -1 : 0;
    }
    ++at;
  }
  return depth == 0;
}

void append_utf8(std::uint32_t code, std::string& text) {
  if (code < 0x20 || code == 0x7f || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff) return;
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0U | (code >> 6U));
    text += static_cast<char>(0x80U | (code & 0x3fU));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0U | (code >> 12U));
    text += static_cast<char>(0x80U | ((code >> 6U) & 0x3fU));
    text += static_cast<char>(0x80U | (code & 0x3fU));
  } else {
    text += static_cast<char>(0xf0U | (code >> 18U));
    text += static_cast<char>(0x80U | ((code >> 12U) & 0x3fU));
    text += static_cast<char>(0x80U | ((code >> 6U) & 0x3fU));
    text += static_cast<char>(0x80U | (code & 0x3fU));
  }
}

/// Bytes of the UTF-8 character at `at`, 0 where there is none.
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  const std::size_t length = lead >= 0xf0 && lead < 0xf5   ? 4
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xc2 && lead < 0xe0 ? 2
                                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((static_cast<unsigned char>(text[at + k]) & 0xc0U) != 0x80U) return 0;
  }
  return length;
}

std::optional<std::uint32_t> hexadecimal(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

/// Decodes the escapes of one text.
class TextDecoder {
 public:
  explicit TextDecoder(std::string_view text) : text_(text) {}

  std::string decode() {
    while (at_ < text_.size()) {
      if (text_[at_] == '\\' && escape()) continue;
      plain();
    }
    return std::move(result_);
  }

 private:
  void plain() {
    const auto c = static_cast<unsigned char>(text_[at_]);
    if (c < 0x80) {
      append_utf8(c, result_);
      at_ += c == '\'' && at_ + 1 < text_.size() && text_[at_ + 1] == '\'' ? 2 : 1;
      return;
    }
    const std::size_t length = utf8_length(text_, at_);
    if (length == 0) append_utf8(c, result_);
    result_ += text_.substr(at_, length);
    at_ += std::max<std::size_t>(length, 1);
  }

  [[nodiscard]] bool starts(std::string_view word) const { return text_.substr(at_, word.size()) == word; }

  bool escape() {
    if (starts("\\X2\\")) return wide(4);
    if (starts("\\X4\\")) return wide(8);
    if (starts("\\\\")) {
      result_ += '\\';
      at_ += 2;
      return true;
    }
    if (starts("\\S\\") && at_ + 3 < text_.size()) {
      append_utf8(static_cast<unsigned char>(text_[at_ + 3]) | 0x80U, result_);
      at_ += 4;
      return true;
    }
    const std::optional<std::uint32_t> code =
        starts("\\X\\") && at_ + 5 <= text_.size() ? hexadecimal(text_.substr(at_ + 3, 2)) : std::nullopt;
    if (code) {
      append_utf8(*code, result_);
      at_ += 5;
      return true;
    }
    // Which page \S\ looks up: always the first.
    if (text_.substr(at_, 2) == "\\P" && at_ + 4 <= text_.size() && text_[at_ + 3] == '\\') {
      at_ += 4;
      return true;
    }
    return false;
  }

  /// Characters of `digits` hexadecimal digits each, up to \X0\.
  bool wide(std::size_t digits) {
    std::size_t at = at_ + 4;
    std::uint32_t high = 0;
    while (at + digits <= text_.size() && text_[at] != '\\') {
      const std::optional<std::uint32_t> code = hexadecimal(text_.substr(at, digits));
      if (!code) return false;
      at += digits;
      if (*code >= 0xd800 && *code < 0xdc00) {
        high = *code;
      } else if (*code >= 0xdc00 && *code < 0xe000 && high != 0) {
        append_utf8(0x10000 + ((high - 0xd800) << 10U) + (*code - 0xdc00), result_);
        high = 0;
      } else {
        append_utf8(*code, result_);
      }
    }
    if (text_.substr(at, 4) == "\\X0\\") at += 4;
    at_ = at;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string result_;
};

}  // namespace

StepComments::StepComments(std::string_view bytes) : bytes_(bytes), last_end_(bytes.rfind("*/")) {}

bool StepComments::begins_at(std::size_t at) const {
  return bytes_[at] == '/' && at + 1 < bytes_.size() && bytes_[at + 1] == '*';
}

std::size_t StepComments::behind(std::size_t at) const {
  if (last_end_ == std::string_view::npos || last_end_ < at + 2) return at + 2;
  return bytes_.find("*/", at + 2) + 2;
}

StepFile::StepFile(std::string_view bytes) {
  const StepComments comments(bytes);
  std::size_t at = 0;
  while (at < bytes.size()) {
    CancelScope::check();
    at = begin_of_statement(bytes, comments, at);
    const std::size_t end = end_of_statement(bytes, comments, at);
    if (at < end) read_statement(bytes.substr(at, end - at));
    at = end + 1;
  }
  std::stable_sort(entities_.begin(), entities_.end(),
                   [](const StepEntity& a, const StepEntity& b) { return a.id < b.id; });
  const auto same = [](const StepEntity& a, const StepEntity& b) { return a.id == b.id; };
  entities_.erase(std::unique(entities_.begin(), entities_.end(), same), entities_.end());
  for (std::size_t i = 0; i < entities_.size(); ++i) by_id_.emplace(entities_[i].id, i);
}

const StepEntity* StepFile::find(std::int64_t id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &entities_[found->second];
}

void StepFile::read_statement(std::string_view statement) {
  if (statement.front() != '#') {
    const std::size_t open = statement.find('(');
    const std::string word = upper_case(trimmed(statement.substr(0, open)));
    if (word == "END-ISO-10303-21") whole_ = true;
    const std::size_t begin = statement.find('\'');
    if (!is_keyword(word)) ++damaged_;
    if (word != "FILE_SCHEMA" || begin == std::string_view::npos || !schema_.empty()) return;
    schema_ = upper_case(trimmed(statement.substr(begin + 1, statement.find('\'', begin + 1) - begin - 1)));
    return;
  }
  const std::size_t equals = statement.find('=');
  const std::size_t open = equals == std::string_view::npos ? equals : statement.find('(', equals);
  StepEntity entity;
  const std::string_view digits =
      trimmed(statement.substr(1, equals == std::string_view::npos ? 0 : equals - 1));
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), entity.id);
  if (open == std::string_view::npos || error != std::errc{} || end != digits.data() + digits.size() ||
      trimmed(statement).back() != ')') {
    ++damaged_;
    return;
  }
  entity.type = trimmed(statement.substr(equals + 1, open - equals - 1));
  entity.arguments = statement.substr(open + 1, statement.rfind(')') - open - 1);
  if (is_type_name(entity.type) && brackets_match(entity.arguments)) {
    entities_.push_back(entity);
  } else {
    ++damaged_;
  }
}

std::vector<std::string_view> step_arguments(std::string_view arguments) {
  const StepComments comments(arguments);
  std::vector<std::string_view> result;
  std::size_t begin = 0;
  std::size_t at = 0;
  int depth = 0;
  while (at < arguments.size()) {
    const char c = arguments[at];
    if (c == '\'') {
      at = behind_text(arguments, at);
      continue;
    }
    if (comments.begins_at(at)) {
      at = comments.behind(at);
      continue;
    }
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) {
      result.push_back(trimmed(arguments.substr(begin, at - begin)));
      begin = at + 1;
    }
    ++at;
  }
  result.push_back(trimmed(arguments.substr(std::min(begin, arguments.size()))));
  return result;
}

std::optional<std::int64_t> step_reference(std::string_view argument) {
  if (argument.empty() || argument.front() != '#') return {};
  std::int64_t id = 0;
  const auto [end, error] = std::from_chars(argument.data() + 1, argument.data() + argument.size(), id);
  if (error != std::errc{} || end != argument.data() + argument.size()) return {};
  return id;
}

std::vector<std::int64_t> step_references(std::string_view argument) {
  std::vector<std::int64_t> ids;
  if (!argument.empty() && argument.front() == '(') {
    const std::size_t close = argument.rfind(')');
    argument =
        argument.substr(1, close == std::string_view::npos || close == 0 ? argument.size() - 1 : close - 1);
  }
  for (const std::string_view part : step_arguments(argument)) {
    const std::optional<std::int64_t> id = step_reference(part);
    if (id) ids.push_back(*id);
  }
  return ids;
}

std::optional<double> step_number(std::string_view argument) {
  const std::size_t open = argument.find('(');
  if (open != std::string_view::npos && !argument.empty() && argument.back() == ')')
    argument = trimmed(argument.substr(open + 1, argument.size() - open - 2));
  return parse_number(argument);
}

std::string step_enumeration(std::string_view argument) {
  if (argument.size() < 3 || argument.front() != '.' || argument.back() != '.') return {};
  return upper_case(argument.substr(1, argument.size() - 2));
}

std::string step_text(std::string_view argument) {
  if (argument.size() < 2 || argument.front() != '\'' || argument.back() != '\'') return {};
  return TextDecoder(argument.substr(1, argument.size() - 2)).decode();
}

}  // namespace limen
