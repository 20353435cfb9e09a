// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

/// A header is not longer than this (bytes); a file without end_header fails soon.
constexpr std::size_t kLongestHeader = std::size_t{1} << 20U;
constexpr std::size_t kMostProperties = 10000;

using PlyTokens = std::vector<std::string_view>;

[[noreturn]] void bad_header(const std::string& what, std::size_t line, const std::string& name) {
  throw Error(what, fmt::format("{}, line {}", name, line),
              "the PLY header is damaged: export the file again");
}

std::optional<Scalar> scalar_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, Scalar>, 20> kNames{{
      {"char", Scalar::int8},      {"int8", Scalar::int8},       {"uchar", Scalar::uint8},
      {"uint8", Scalar::uint8},    {"short", Scalar::int16},     {"int16", Scalar::int16},
      {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},   {"int", Scalar::int32},
      {"int32", Scalar::int32},    {"uint", Scalar::uint32},     {"uint32", Scalar::uint32},
      {"long", Scalar::int64},     {"int64", Scalar::int64},     {"ulong", Scalar::uint64},
      {"uint64", Scalar::uint64},  {"float", Scalar::float32},   {"float32", Scalar::float32},
      {"double", Scalar::float64}, {"float64", Scalar::float64},
  }};
  for (const auto& [known, scalar] : kNames) {
    if (name == known) return scalar;
  }
  return {};
}

/// One header line being read.
struct PlyLine {
  PlyTokens tokens;
  std::size_t number;
  const std::string& name;

  [[noreturn]] void fail(const std::string& what) const { bad_header(what, number, name); }
  [[nodiscard]] Scalar scalar(std::size_t k) const {
    const std::optional<Scalar> found = scalar_named(tokens[k]);
    if (!found) fail(fmt::format("unknown number type \"{}\"", tokens[k]));
    return *found;
  }
};

PlyEncoding encoding_of(const PlyLine& line) {
  if (line.tokens.size() >= 2) {
    if (line.tokens[1] == "ascii") return PlyEncoding::ascii;
    if (line.tokens[1] == "binary_little_endian") return PlyEncoding::little_endian;
    if (line.tokens[1] == "binary_big_endian") return PlyEncoding::big_endian;
  }
  line.fail("unknown PLY format (known: ascii, binary_little_endian, binary_big_endian)");
}

PlyElement element_of(const PlyLine& line) {
  const std::optional<std::size_t> count =
      line.tokens.size() == 3 ? parse_count(line.tokens[2]) : std::nullopt;
  if (!count) line.fail("an element needs a name and a count");
  return {std::string(line.tokens[1]), *count, {}};
}

PlyProperty property_of(const PlyLine& line) {
  if (line.tokens.size() == 5 && line.tokens[1] == "list") {
    const Scalar count_type = line.scalar(2);
    if (!is_integer(count_type)) line.fail("the count of a list must be a whole number");
    return {std::string(line.tokens[4]), line.scalar(3), count_type};
  }
  if (line.tokens.size() != 3) line.fail("a property needs a type and a name");
  return {std::string(line.tokens[2]), line.scalar(1), std::nullopt};
}

/// The last three tokens as numbers.
std::optional<Vector3d> last_three(const PlyTokens& tokens) {
  if (tokens.size() < 5) return {};  // comment, topic, three numbers
  Vector3d x;
  for (int k = 0; k < 3; ++k) {
    const auto number = parse_number(tokens[tokens.size() - 3 + static_cast<std::size_t>(k)]);
    if (!number || !(std::abs(*number) < 1e9)) return {};
    x[k] = *number;
  }
  return x;
}

/// The first word of a comment without a colon or an equals sign behind it.
std::string topic_of(const PlyTokens& tokens) {
  std::string word = tokens.size() < 2 ? "" : lower_case(tokens[1]);
  while (!word.empty() && (word.back() == ':' || word.back() == '=')) word.pop_back();
  return word;
}

std::optional<Vector3d> offset_in_comment(const PlyTokens& tokens) {
  static constexpr std::array<std::string_view, 5> kTopics{"offset", "pivot", "shift", "global_shift",
                                                           "translation"};
  if (std::find(kTopics.begin(), kTopics.end(), topic_of(tokens)) == kTopics.end()) return {};
  return last_three(tokens);
}

/// Takes what a comment says about the frame; `tokens` begin with the word "comment" or "obj_info".
void read_comment(const PlyTokens& tokens, PlyHeader& header) {
  if (topic_of(tokens) == "scanner_position") {
    header.centre = last_three(tokens);
    header.centre_unknown = !header.centre;
    return;
  }
  const std::optional<Vector3d> offset = header.has_offset ? std::nullopt : offset_in_comment(tokens);
  if (!offset) return;
  header.offset = *offset;
  header.has_offset = true;
}

/// Takes one line; returns true at end_header.
bool read_line(const PlyLine& line, PlyHeader& header) {
  const std::string_view word = line.tokens.empty() ? std::string_view{} : line.tokens[0];
  if (word == "end_header") return true;
  if (word == "format") {
    header.encoding = encoding_of(line);
  } else if (word == "element") {
    header.elements.push_back(element_of(line));
  } else if (word == "property") {
    if (header.elements.empty()) line.fail("a property comes before the first element");
    if (header.elements.back().properties.size() >= kMostProperties) line.fail("too many properties");
    header.elements.back().properties.push_back(property_of(line));
  } else if (word == "comment" || word == "obj_info") {
    read_comment(line.tokens, header);
  } else if (!word.empty()) {
    line.fail(fmt::format("unknown word \"{}\"", word.substr(0, 40)));
  }
  return false;
}

[[noreturn]] void truncated(const PlyElement& element, const std::string& name, std::size_t at) {
  throw Error(fmt::format("the file ends within its {} elements named {}", element.count, element.name),
              fmt::format("{}, byte {}", name, at), "get the whole file, or correct the count");
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.count_type; });
}

std::size_t PlyElement::least_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.count_type.value_or(property.type));
  return bytes;
}

std::size_t PlyHeader::vertex(const std::string& name) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [](const PlyElement& element) { return element.name == "vertex"; });
  if (found == elements.end()) {
    throw Error("there are no points: the header has no element \"vertex\"", name,
                "export the points with it");
  }
  if (found->count == 0)
    throw Error("there are no points: element vertex 0", name, "check how it was exported");
  return static_cast<std::size_t>(found - elements.begin());
}

bool PlyHeader::swapped() const {
  return encoding !=
         (std::endian::native == std::endian::little ? PlyEncoding::little_endian : PlyEncoding::big_endian);
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  PlyHeader header;
  const std::string_view head = bytes.substr(0, std::min(bytes.size(), kLongestHeader));
  bool has_format = false;
  while (header.body < head.size()) {
    const TextLine text = first_line(head.substr(header.body));
    header.body += text.bytes;
    header.lines.emplace_back(text.text);
    const PlyLine line{split_tokens(text.text), header.lines.size(), name};
    if (line.number == 1) {
      if (line.tokens.size() != 1 || line.tokens[0] != "ply")
        line.fail("a PLY file begins with the line \"ply\"");
      continue;
    }
    has_format = has_format || (!line.tokens.empty() && line.tokens[0] == "format");
    if (!read_line(line, header)) continue;
    if (!has_format) line.fail("the header has no line \"format\"");
    return header;
  }
  bad_header("the header has no line \"end_header\"", header.lines.size(), name);
}

std::optional<Vector3d> offset_in_line(std::string_view header_line) {
  const PlyTokens tokens = split_tokens(header_line);
  if (tokens.empty() || (tokens[0] != "comment" && tokens[0] != "obj_info")) return {};
  return offset_in_comment(tokens);
}

std::size_t ply_record_bytes(std::string_view bytes, std::size_t at, const PlyElement& element, bool swapped,
                             const std::string& name) {
  std::size_t end = at;
  const auto take = [&](std::size_t count, std::size_t size) {
    if (end > bytes.size() || (size > 0 && count > (bytes.size() - end) / size)) truncated(element, name, at);
    end += count * size;
  };
  for (const PlyProperty& property : element.properties) {
    if (!property.count_type) {
      take(1, size_of(property.type));
      continue;
    }
    const std::size_t count_at = end;
    take(1, size_of(*property.count_type));
    const double count = load_number(bytes.data() + count_at, *property.count_type, swapped);
    if (count < 0.0) truncated(element, name, at);
    take(count < 1e15 ? static_cast<std::size_t>(count) : bytes.size() + 1, size_of(property.type));
  }
  return end - at;
}

std::size_t ply_element_start(std::string_view bytes, const PlyHeader& header, std::size_t which,
                              const std::string& name) {
  std::size_t at = header.body;
  for (std::size_t k = 0; k < which; ++k) {
    const PlyElement& element = header.elements[k];
    const std::size_t least = element.least_bytes();
    if (least == 0) continue;
    if (element.count > (bytes.size() - at) / least) truncated(element, name, at);
    if (!element.has_lists()) {
      at += element.count * least;
      continue;
    }
    for (std::size_t i = 0; i < element.count; ++i)
      at += ply_record_bytes(bytes, at, element, header.swapped(), name);
  }
  return at;
}

}  // namespace limen
