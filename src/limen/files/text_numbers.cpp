// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/text_numbers.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"

namespace limen {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;

bool separates(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// What a line is, recognised by its first characters.
enum class LineKind { nothing, count, row };

LineKind kind_of(std::string_view line) {
  std::size_t begin = 0;
  while (begin < line.size() && separates(line[begin])) ++begin;
  if (begin == line.size()) return LineKind::nothing;
  if (line[begin] == '#' || line[begin] == '%' || line.substr(begin, 2) == "//") return LineKind::nothing;
  std::size_t end = begin;
  while (end < line.size() && !separates(line[end])) ++end;
  while (end < line.size() && separates(line[end])) ++end;
  return end == line.size() ? LineKind::count : LineKind::row;
}

/// Calls action(line, line number within `text`, from 0) for each line.
template <typename Action>
void for_each_line(std::string_view text, const Action& action) {
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    action(text.substr(0, end), number++);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

/// A stretch of whole lines and what lies before it.
struct Piece {
  std::string_view text;
  std::size_t rows = 0;
  std::size_t lines = 0;
  std::size_t promised = 0;
  std::size_t rows_before = 0;
  std::size_t lines_before = 0;
};

std::vector<Piece> cut(std::string_view text) {
  std::vector<Piece> pieces;
  while (!text.empty()) {
    std::size_t end = std::min(kPieceBytes, text.size());
    const std::size_t newline = text.find('\n', end - 1);
    end = newline == std::string_view::npos ? text.size() : newline + 1;
    pieces.push_back({text.substr(0, end)});
    text.remove_prefix(end);
  }
  return pieces;
}

[[noreturn]] void bad_row(std::string_view line, std::size_t number, const std::string& name,
                          const char* what) {
  const std::string_view shown = line.substr(0, std::min<std::size_t>(line.size(), 40));
  std::string clean;
  for (const char c : shown) clean += c >= ' ' && c < 127 ? c : ' ';
  throw Error(fmt::format("{}: \"{}\"", what, clean), fmt::format("{}, line {}", name, number),
              "correct or remove the line");
}

void count_rows(Piece& piece, const TextRows& wanted) {
  for_each_line(piece.text, [&](std::string_view line, std::size_t) {
    const LineKind kind = kind_of(line);
    ++piece.lines;
    if (kind == LineKind::count && wanted.counts_allowed) {
      const auto tokens = split_tokens(line);
      piece.promised += tokens.empty() ? 0 : parse_count(tokens[0]).value_or(0);
    } else if (kind != LineKind::nothing) {
      ++piece.rows;
    }
  });
}

constexpr std::array<double, 16> kPowersOfTen{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// Reads a plain decimal of at most 15 digits, which is exact: digits and power of ten are whole doubles, so
/// their quotient is rounded once. Returns where it ends, or nullptr for any other spelling.
const char* read_plain_decimal(const char* at, const char* end, double& out) {
  const bool negative = at < end && *at == '-';
  if (negative) ++at;
  const char* const begin = at;
  const char* point = nullptr;
  std::int64_t digits = 0;
  for (; at < end && at - begin <= 16; ++at) {
    if (*at == '.' && point == nullptr) {
      point = at;
    } else if (*at >= '0' && *at <= '9') {
      digits = 10 * digits + (*at - '0');
    } else {
      break;
    }
  }
  const auto count = at - begin - (point != nullptr ? 1 : 0);
  if (count < 1 || count > 15 || (at < end && !separates(*at))) return nullptr;
  const auto decimals = point == nullptr ? std::size_t{0} : static_cast<std::size_t>(at - point - 1);
  const double value = static_cast<double>(digits) / kPowersOfTen[decimals];
  out = negative ? -value : value;
  return at;
}

/// Reads the numbers of one line; returns how many there were, at most `columns`.
std::size_t read_row(std::string_view line, std::size_t columns, double* out) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (std::size_t k = 0; k < columns; ++k) {
    while (at < end && (separates(*at) || *at == '"')) ++at;
    if (at < end && *at == '+') ++at;
    if (const char* const plain = read_plain_decimal(at, end, out[k])) {
      at = plain;
      continue;
    }
    const auto [stop, error] = std::from_chars(at, end, out[k]);
    if (error == std::errc::result_out_of_range) {
      out[k] = 0.0;  // denormal: from_chars leaves the value alone
    } else if (error != std::errc{}) {
      return k;
    }
    if (stop < end && !separates(*stop) && *stop != '"') return k;
    at = stop;
  }
  return columns;
}

void read_piece(const Piece& piece, const TextRows& wanted, const std::string& name, ParsedRows& result) {
  std::size_t row = piece.rows_before;
  for_each_line(piece.text, [&](std::string_view line, std::size_t number) {
    const LineKind kind = kind_of(line);
    if (kind == LineKind::nothing || (kind == LineKind::count && wanted.counts_allowed)) return;
    const std::size_t at = row++;
    if (at < wanted.skip || at - wanted.skip >= result.rows) return;
    double* out = result.numbers.data() + (at - wanted.skip) * wanted.columns;
    if (read_row(line, wanted.columns, out) == wanted.columns) return;
    bad_row(line, wanted.first_line_number + piece.lines_before + number, name,
            fmt::format("each line must have {} numbers, not", wanted.columns).c_str());
  });
}

}  // namespace

std::optional<double> parse_number(std::string_view token) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  double number = 0.0;
  const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), number);
  if (error != std::errc{} || stop != token.data() + token.size()) return {};
  return number;
}

std::optional<std::size_t> parse_count(std::string_view token) {
  std::size_t count = 0;
  const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), count);
  if (error != std::errc{} || stop != token.data() + token.size()) return {};
  return count;
}

std::vector<std::string_view> split_tokens(std::string_view line) {
  std::vector<std::string_view> tokens;
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && (separates(line[at]) || line[at] == '"')) ++at;
    std::size_t end = at;
    while (end < line.size() && !separates(line[end]) && line[end] != '"') ++end;
    if (end > at) tokens.push_back(line.substr(at, end - at));
    at = end;
  }
  return tokens;
}

bool holds_row(std::string_view line) {
  return kind_of(line) != LineKind::nothing;
}

TextLine first_line(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  if (end == std::string_view::npos) return {text, text.size()};
  const bool two = text.substr(end, 2) == "\r\n";
  return {text.substr(0, end), end + (two ? 2 : 1)};
}

ParsedRows parse_rows(std::string_view text, const TextRows& wanted, const std::string& name) {
  std::vector<Piece> pieces = cut(text);
  parallel_for(pieces.size(), 1, [&](std::size_t i, std::size_t) { count_rows(pieces[i], wanted); });
  ParsedRows result;
  std::size_t rows = 0;
  std::size_t lines = 0;
  for (Piece& piece : pieces) {
    piece.rows_before = rows;
    piece.lines_before = lines;
    rows += piece.rows;
    lines += piece.lines;
    result.promised += piece.promised;
  }
  result.lines = lines;
  const std::size_t there = rows - std::min(rows, wanted.skip);
  result.rows = wanted.rows.value_or(there);
  if (result.rows > there) {
    throw Error(fmt::format("the file ends after {} of {} points", there, result.rows), name,
                "get the whole file, or correct the count");
  }
  result.numbers.resize(result.rows * wanted.columns);
  parallel_for(pieces.size(), 1,
               [&](std::size_t i, std::size_t) { read_piece(pieces[i], wanted, name, result); });
  return result;
}

}  // namespace limen
