// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/files/text_numbers.h"
#include "limen/io/ptx/ptx.h"

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

using HeaderLines = std::array<TextLine, kHeaderLines>;

HeaderLines lines_of(std::string_view text) {
  HeaderLines lines;
  for (TextLine& line : lines) {
    line = first_line(text);
    text.remove_prefix(line.bytes);
  }
  return lines;
}

/// The header moved: scanner and matrix (for row vectors) to the target, its axes turned.
std::string moved_header(std::string_view header, const Rigid3& motion) {
  const HeaderLines lines = lines_of(header);
  std::string text(header.substr(0, lines[0].bytes + lines[1].bytes));
  const std::string end(header.substr(lines[0].text.size(), lines[0].bytes - lines[0].text.size()));
  text += triple(motion * vector_of(lines[2].text)) + end;
  for (std::size_t k = 3; k < 6; ++k) text += triple(motion.rotation * vector_of(lines[k].text)) + end;
  for (std::size_t k = 6; k < 9; ++k) text += triple(motion.rotation * vector_of(lines[k].text)) + " 0" + end;
  text += triple(motion * vector_of(lines[9].text)) + " 1" + end;
  return text;
}

}  // namespace

TransformedCloud transform_ptx(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output) {
  const std::vector<PtxPlace> places = ptx_places(input.bytes, input.name);  // proves every header
  TransformedCloud result;
  result.format = "PTX";
  AtomicFile file(output);
  std::size_t written = 0;
  for (const PtxPlace& place : places) {
    file.write(input.bytes.substr(written, place.header - written));
    file.write(moved_header(input.bytes.substr(place.header, place.body - place.header), target_from_source));
    written = place.body;
    result.points += place.points;
  }
  file.write(input.bytes.substr(written));
  file.commit();
  return result;
}

}  // namespace limen
