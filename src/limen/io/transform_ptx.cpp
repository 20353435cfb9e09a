// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/io/read_ptx.h"
#include "limen/io/text_numbers.h"
#include "limen/io/transform_text.h"

namespace limen {
namespace {

constexpr std::size_t kHeaderLines = 10;

/// The numbers of a line of a header that was read before.
template <std::size_t count>
std::array<double, count> numbers_of(std::string_view line) {
  std::array<double, count> numbers{};
  const auto tokens = split_tokens(line);
  for (std::size_t k = 0; k < count && k < tokens.size(); ++k)
    numbers[k] = parse_number(tokens[k]).value_or(0.0);
  return numbers;
}

Vector3d vector_of(std::string_view line) {
  const auto numbers = numbers_of<3>(line);
  return {numbers[0], numbers[1], numbers[2]};
}

std::string triple(const Vector3d& x) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", x.x(), x.y(), x.z());
}

/// The ten lines of a header and the bytes they take.
struct HeaderText {
  std::array<TextLine, kHeaderLines> lines;
  std::size_t bytes = 0;
};

HeaderText header_at(std::string_view rest) {
  HeaderText header;
  for (TextLine& line : header.lines) {
    line = first_line(rest.substr(header.bytes));
    header.bytes += line.bytes;
  }
  return header;
}

/// The header moved: scanner and matrix (for row vectors) to the target, its axes turned.
std::string moved_header(const HeaderText& header, std::string_view rest, const Rigid3& motion) {
  std::string text(rest.substr(0, header.lines[0].bytes + header.lines[1].bytes));
  const std::string end(
      rest.substr(header.lines[0].text.size(), header.lines[0].bytes - header.lines[0].text.size()));
  text += triple(motion * vector_of(header.lines[2].text)) + end;
  for (std::size_t k = 3; k < 6; ++k) text += triple(motion.rotation * vector_of(header.lines[k].text)) + end;
  for (std::size_t k = 6; k < 9; ++k)
    text += triple(motion.rotation * vector_of(header.lines[k].text)) + " 0" + end;
  text += triple(motion * vector_of(header.lines[9].text)) + " 1" + end;
  return text;
}

/// Bytes of the next `rows` lines that are not blank, and of blank ones behind them. Throws Error where the
/// text ends before.
std::size_t bytes_of_rows(std::string_view text, std::size_t rows, const std::string& name) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t newline = text.find('\n', at);
    const std::size_t stop = newline == std::string_view::npos ? text.size() : newline + 1;
    const bool blank = stop - at <= 3 && split_tokens(text.substr(at, stop - at - 1)).empty();
    if (!blank && rows == 0) break;
    if (!blank) --rows;
    at = stop;
  }
  if (rows > 0) {
    throw Error(fmt::format("the file ends {} points before its time", rows), name,
                "get the whole file, or correct the count");
  }
  return at;
}

}  // namespace

TransformedCloud transform_ptx(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output) {
  const auto whole = open_ptx(input.bytes, input.name);  // proves every header
  TransformedCloud result;
  result.format = whole->format();
  AtomicFile file(output);
  std::string_view rest = input.bytes;
  const std::size_t before = bytes_of_rows(rest, 0, input.name);
  file.write(rest.substr(0, before));
  rest.remove_prefix(before);
  for (const CloudFacts& cloud : whole->clouds()) {
    const HeaderText header = header_at(rest);
    file.write(moved_header(header, rest, target_from_source));
    rest.remove_prefix(header.bytes);
    const std::size_t rows = bytes_of_rows(rest, cloud.points, input.name);
    file.write(rest.substr(0, rows));
    rest.remove_prefix(rows);
    result.points += cloud.points;
  }
  file.commit();
  return result;
}

}  // namespace limen
