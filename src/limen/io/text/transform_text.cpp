// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20U;
constexpr std::size_t kPiecesAtOnce = 16;
/// Digits behind the point: a tenth of a millimetre at least, and no more than a double has.
constexpr int kLeastDecimals = 4;
constexpr int kMostDecimals = 15;

std::string written_like(double value, std::string_view old) {
  const std::size_t point = old.find('.');
  const int there = point == std::string_view::npos ? 0 : static_cast<int>(old.size() - point - 1);
  if (old.find_first_of("eE") != std::string_view::npos || !std::isfinite(value))
    return fmt::format("{}", value);
  return fmt::format("{:.{}f}", value, std::clamp(there, kLeastDecimals, kMostDecimals));
}

/// Whole lines, no longer than a piece where they allow.
std::string_view take_piece(std::string_view& text) {
  std::size_t end = std::min(kPieceBytes, text.size());
  if (end < text.size()) {
    const std::size_t newline = text.find('\n', end - 1);
    end = newline == std::string_view::npos ? text.size() : newline + 1;
  }
  const std::string_view piece = text.substr(0, end);
  text.remove_prefix(end);
  return piece;
}

/// The lines before the rows; a comment that states the scanner's position states the new one.
std::string moved_head(std::string_view head, const Rigid3& target_from_source) {
  const std::string_view lines = without_byte_order_mark(head);
  std::string moved(head.substr(0, head.size() - lines.size()));
  for (std::string_view rest = lines; !rest.empty();) {
    const TextLine line = first_line(rest);
    const std::optional<Vector3d> centre = scanner_position_in(line.text);
    moved += centre ? scanner_position_line(target_from_source * *centre) : std::string(line.text);
    moved += rest.substr(line.text.size(), line.bytes - line.text.size());
    rest.remove_prefix(line.bytes);
  }
  return moved;
}

}  // namespace

LineMover::LineMover(const std::vector<std::string>& names, const Rigid3& motion)
    : triples_(moved_columns([&](std::string_view name, bool) -> std::optional<std::size_t> {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return {};
        return static_cast<std::size_t>(found - names.begin());
      })),
      motion_(motion) {}

void LineMover::append(std::string& out, std::string_view line, const std::string& where) const {
  const std::vector<std::string_view> tokens = split_tokens(line);
  std::vector<std::optional<double>> values(tokens.size());
  for (const MovedColumns& triple : triples_) {
    Vector3d x;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto number =
          triple.column[k] < tokens.size() ? parse_number(tokens[triple.column[k]]) : std::nullopt;
      if (!number) {
        throw Error(fmt::format("a row lacks its numbers: \"{}\"", line.substr(0, 40)), where,
                    "correct or remove the line");
      }
      x[static_cast<int>(k)] = *number;
    }
    x = triple.moved(motion_, x);
    for (std::size_t k = 0; k < 3; ++k) values[triple.column[k]] = x[static_cast<int>(k)];
  }
  const char* at = line.data();
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    if (!values[k]) continue;
    out.append(at, tokens[k].data());
    out += written_like(*values[k], tokens[k]);
    at = tokens[k].data() + tokens[k].size();
  }
  out.append(at, line.data() + line.size());
}

std::string LineMover::moved(std::string_view text, bool counts_allowed, const std::string& where) const {
  std::vector<std::string_view> pieces;
  while (!text.empty()) pieces.push_back(take_piece(text));
  std::vector<std::string> out(pieces.size());
  parallel_for(pieces.size(), 1, [&](std::size_t i, std::size_t) {
    for (std::string_view rest = pieces[i]; !rest.empty();) {
      const std::size_t newline = rest.find('\n');
      const std::string_view line = rest.substr(0, newline == std::string_view::npos ? newline : newline + 1);
      const std::string_view plain = line.substr(0, line.find_first_of("\r\n"));
      const bool count = counts_allowed && split_tokens(plain).size() == 1;
      if (holds_row(plain) && !count) {
        append(out[i], plain, where);
        out[i] += line.substr(plain.size());
      } else {
        out[i] += line;
      }
      rest.remove_prefix(line.size());
    }
  });
  std::string all;
  for (const std::string& part : out) all += part;
  return all;
}

TransformedCloud transform_text(const NamedBytes& input, const Rigid3& target_from_source,
                                const std::filesystem::path& output) {
  const TextLayout layout = text_layout(input.bytes, input.name);
  const LineMover mover(layout.names, target_from_source);
  TransformedCloud result;
  result.format = layout.counted ? "PTS text" : "XYZ text";
  // Reading all rows proves the file before anything is written.
  const auto file_in_pieces = open_xyz(input.bytes, input.name);
  const auto stream = file_in_pieces->read(0);
  while (const auto piece = stream->next(std::size_t{1} << 18U)) result.points += piece->rows;
  AtomicFile file(output);
  file.write(moved_head(input.bytes.substr(0, layout.body), target_from_source));
  std::string_view rest = input.bytes.substr(layout.body);
  while (!rest.empty()) {
    const char* const begin = rest.data();
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < kPiecesAtOnce && !rest.empty(); ++k) bytes += take_piece(rest).size();
    file.write(mover.moved({begin, bytes}, layout.counted, input.name));
  }
  file.commit();
  return result;
}

}  // namespace limen
