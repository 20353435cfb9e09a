// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/read_pcd.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/lzf.h"
#include "limen/io/record_table.h"
#include "limen/io/scan_builder.h"
#include "limen/io/text_numbers.h"

namespace limen {
namespace {

constexpr std::size_t kMostFields = 1000;
constexpr std::size_t kMostCount = 100000;
const char* const kRemedy = "the PCD header is damaged: export the file again";

using Tokens = std::vector<std::string_view>;

struct PcdField {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t width = 0;
  std::size_t height = 0;
  std::optional<std::size_t> points;
  std::optional<Vector3d> viewpoint;
  std::string data;
  std::size_t lines = 0;
  std::size_t body = 0;

  [[nodiscard]] std::size_t record_bytes() const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += field.size * field.count;
    return bytes;
  }
};

/// The tokens of one header line, where it stands, and how to complain about it.
struct Line {
  Tokens tokens;
  std::size_t number;
  const std::string& name;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(what, fmt::format("{}, line {}", name, number), kRemedy);
  }
  [[nodiscard]] std::size_t count(std::size_t k) const {
    const auto value = k < tokens.size() ? parse_count(tokens[k]) : std::nullopt;
    if (!value) fail(fmt::format("{} needs whole numbers", tokens[0]));
    return *value;
  }
  /// One token per field is wanted after the first.
  void require_per_field(const PcdHeader& header) const {
    if (tokens.size() == header.fields.size() + 1) return;
    fail(fmt::format("{} has {} values for {} fields", tokens[0], tokens.size() - 1, header.fields.size()));
  }
};

void read_fields(const Line& line, PcdHeader& header) {
  if (line.tokens.size() < 2 || line.tokens.size() > kMostFields)
    line.fail("FIELDS needs the names of the fields");
  header.fields.clear();
  for (std::size_t k = 1; k < line.tokens.size(); ++k) header.fields.push_back({lower_case(line.tokens[k])});
}

void read_per_field(const Line& line, PcdHeader& header) {
  line.require_per_field(header);
  for (std::size_t k = 0; k < header.fields.size(); ++k) {
    PcdField& field = header.fields[k];
    if (line.tokens[0] == "TYPE") {
      field.type = line.tokens[k + 1][0];
    } else if (line.tokens[0] == "SIZE") {
      field.size = line.count(k + 1);
      if (field.size == 0 || field.size > 8) line.fail("SIZE must be 1, 2, 4 or 8");
    } else {
      field.count = line.count(k + 1);
      if (field.count > kMostCount) line.fail("COUNT is absurdly large");
    }
  }
}

std::optional<Vector3d> viewpoint_of(const Line& line) {
  if (line.tokens.size() < 4) return {};
  Vector3d x;
  for (int k = 0; k < 3; ++k) {
    const auto number = parse_number(line.tokens[static_cast<std::size_t>(k) + 1]);
    if (!number || !(std::abs(*number) < 1e8)) return {};
    x[k] = *number;
  }
  return x;
}

/// Takes one line; returns true at DATA, the last one.
bool read_line(const Line& line, PcdHeader& header) {
  const std::string_view word = line.tokens[0];
  if (word == "FIELDS" || word == "COLUMNS") {
    read_fields(line, header);
  } else if (word == "SIZE" || word == "TYPE" || word == "COUNT") {
    read_per_field(line, header);
  } else if (word == "WIDTH") {
    header.width = line.count(1);
  } else if (word == "HEIGHT") {
    header.height = line.count(1);
  } else if (word == "POINTS") {
    header.points = line.count(1);
  } else if (word == "VIEWPOINT") {
    header.viewpoint = viewpoint_of(line);
  } else if (word == "DATA") {
    header.data = line.tokens.size() > 1 ? lower_case(line.tokens[1]) : "";
    return true;
  } else if (word != "VERSION") {
    line.fail(fmt::format("unknown word \"{}\"", word.substr(0, 40)));
  }
  return false;
}

PcdHeader parse_header(std::string_view bytes, const std::string& name) {
  PcdHeader header;
  while (header.body < bytes.size() && header.lines < 1000) {
    const TextLine text = first_line(bytes.substr(header.body));
    header.body += text.bytes;
    const Line line{split_tokens(text.text), ++header.lines, name};
    if (line.tokens.empty() || line.tokens[0].front() == '#') continue;
    if (!read_line(line, header)) continue;
    if (header.fields.empty()) line.fail("the header has no line FIELDS");
    return header;
  }
  throw Error("the header has no line DATA", fmt::format("{}, line {}", name, header.lines), kRemedy);
}

Scalar scalar_of(const PcdField& field, const std::string& name) {
  const auto pick = [&](Scalar one, Scalar two, Scalar four, Scalar eight) -> std::optional<Scalar> {
    if (field.size == 1) return one;
    if (field.size == 2) return two;
    if (field.size == 4) return four;
    if (field.size == 8) return eight;
    return {};
  };
  std::optional<Scalar> scalar;
  if (field.type == 'I') scalar = pick(Scalar::int8, Scalar::int16, Scalar::int32, Scalar::int64);
  if (field.type == 'U') scalar = pick(Scalar::uint8, Scalar::uint16, Scalar::uint32, Scalar::uint64);
  if (field.type == 'F' && field.size == 4) scalar = Scalar::float32;
  if (field.type == 'F' && field.size == 8) scalar = Scalar::float64;
  if (scalar) return *scalar;
  throw Error(fmt::format("field {} has the unknown type {} of {} bytes", field.name, field.type, field.size),
              name, kRemedy);
}

bool packs_colour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.size == 4;
}

/// A field and, where it packs a colour, the three in it. The bytes of a packed colour are blue, green, red.
void add_field(RecordTable& table, const PcdField& field, const Field& placed) {
  if (field.count != 1) return;  // histograms and padding
  table.fields.push_back(placed);
  if (!packs_colour(field)) return;
  const char* const names[] = {"blue", "green", "red"};
  for (std::size_t k = 0; k < 3; ++k)
    table.fields.push_back({names[k], Scalar::uint8, placed.data + k, placed.stride});
}

/// Points in memory: where the values of each field lie.
struct Layout {
  const char* data;
  bool by_field;  ///< all x, then all y, ... (compressed), else point after point
};

RecordTable table_of_bytes(const PcdHeader& header, std::size_t points, const Layout& layout,
                           const std::string& name) {
  RecordTable table;
  table.rows = points;
  table.swapped = std::endian::native == std::endian::big;
  const char* at = layout.data;
  for (const PcdField& field : header.fields) {
    const std::size_t bytes = field.size * field.count;
    if (field.name != "_") {
      add_field(table, field,
                {field.name, scalar_of(field, name), at, layout.by_field ? bytes : header.record_bytes()});
    }
    at += layout.by_field ? bytes * points : bytes;
  }
  return table;
}

/// Splits the packed colours of a text file, which are numbers there, into three columns of their own.
void split_colours(const PcdHeader& header, std::vector<std::string>& names, std::vector<double>& numbers) {
  const auto found = std::find_if(header.fields.begin(), header.fields.end(), packs_colour);
  if (found == header.fields.end()) return;
  const auto column =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), found->name) - names.begin());
  const std::size_t columns = names.size();
  std::vector<double> wider;
  wider.reserve(numbers.size() / columns * (columns + 3));
  for (std::size_t i = 0; i + columns <= numbers.size(); i += columns) {
    const double value = numbers[i + column];
    std::uint32_t packed = 0;
    if (found->type == 'F') {
      packed = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    } else if (value >= 0.0 && value <= 4294967295.0) {
      packed = static_cast<std::uint32_t>(value);
    }
    wider.insert(wider.end(), numbers.begin() + static_cast<std::ptrdiff_t>(i),
                 numbers.begin() + static_cast<std::ptrdiff_t>(i + columns));
    for (const unsigned shift : {16U, 8U, 0U}) wider.push_back(static_cast<double>((packed >> shift) & 255U));
  }
  numbers = std::move(wider);
  for (const char* colour : {"red", "green", "blue"}) names.emplace_back(colour);
}

RecordTable table_of_text(std::string_view bytes, const PcdHeader& header, std::size_t points,
                          const std::string& name) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) names.push_back(field.count == 1 ? field.name : "_");
  }
  TextRows wanted;
  wanted.columns = names.size();
  wanted.rows = points;
  wanted.first_line_number = header.lines + 1;
  ParsedRows parsed = parse_rows(bytes.substr(header.body), wanted, name);
  split_colours(header, names, parsed.numbers);
  return table_of_numbers(std::make_shared<std::vector<double>>(std::move(parsed.numbers)), names);
}

[[noreturn]] void too_few(std::size_t points, std::size_t room, const std::string& name) {
  throw Error(fmt::format("the header promises {} points, the file has room for {}", points, room), name,
              "get the whole file, or correct the count");
}

std::size_t count_points(const PcdHeader& header, const std::string& name) {
  if (header.points && *header.points > 0) return *header.points;
  if (header.height > 0 && header.width > SIZE_MAX / header.height) too_few(SIZE_MAX, 0, name);
  const std::size_t points = header.width * std::max<std::size_t>(1, header.height);
  if (points == 0) throw Error("there are no points: POINTS 0", name, "check how the file was exported");
  return points;
}

/// The bytes of a compressed body.
std::string expand_body(std::string_view body, std::size_t wanted, const std::string& name) {
  std::uint32_t sizes[2] = {0, 0};
  if (body.size() >= sizeof sizes) std::memcpy(sizes, body.data(), sizeof sizes);
  if (body.size() < sizeof sizes || sizes[0] > body.size() - sizeof sizes) {
    throw Error("the compressed points end before their time", name, "get the whole file");
  }
  auto expanded = expand_lzf(body.substr(sizeof sizes, sizes[0]), sizes[1]);
  if (!expanded) throw Error("the compressed points are damaged", name, "export the file again");
  if (expanded->size() < wanted) {
    throw Error(
        fmt::format("the header promises {} bytes of points, the file holds {}", wanted, expanded->size()),
        name, "get the whole file, or correct the count");
  }
  return std::move(*expanded);
}

/// What every encoding gives: a table, and the memory it may point into.
struct Body {
  std::shared_ptr<const std::string> expanded;
  RecordTable table;
};

Body read_body(std::string_view bytes, const PcdHeader& header, const std::string& name) {
  const std::size_t points = count_points(header, name);
  const std::string_view body = bytes.substr(header.body);
  const std::size_t stride = header.record_bytes();
  Body read;
  if (header.data == "ascii") {
    read.table = table_of_text(bytes, header, points, name);
  } else if (header.data == "binary") {
    const std::size_t room = stride == 0 ? 0 : body.size() / stride;
    if (points > room) too_few(points, room, name);
    read.table = table_of_bytes(header, points, {body.data(), false}, name);
  } else if (header.data == "binary_compressed") {
    if (stride == 0 || points > UINT32_MAX / stride) too_few(points, 0, name);
    read.expanded = std::make_shared<const std::string>(expand_body(body, points * stride, name));
    read.table = table_of_bytes(header, points, {read.expanded->data(), true}, name);
  } else {
    throw Error(fmt::format("unknown PCD data \"{}\" (known: ascii, binary, binary_compressed)", header.data),
                fmt::format("{}, line {}", name, header.lines), "export the file again");
  }
  return read;
}

}  // namespace

bool looks_like_pcd(std::string_view bytes) {
  std::string_view head = bytes.substr(0, 4096);
  while (!head.empty()) {
    const TextLine line = first_line(head);
    const auto tokens = split_tokens(line.text);
    if (!tokens.empty() && tokens[0].front() != '#') {
      return tokens[0] == "VERSION" || tokens[0] == "FIELDS" || tokens[0] == "COLUMNS";
    }
    if (line.text.substr(0, 6) == "# .PCD") return true;
    head.remove_prefix(line.bytes);
  }
  return false;
}

ScanFile read_pcd(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  const PcdHeader header = parse_header(bytes, name);
  const Body body = read_body(bytes, header, name);
  TableFacts facts;
  facts.name = name;
  if (header.height > 1 && header.width > 0 && header.width == body.table.rows / header.height) {
    facts.columns = header.width;
  }
  if (header.viewpoint && !header.viewpoint->isZero()) facts.possible_centre = header.viewpoint;
  ScanFile file;
  file.format = "PCD, " + header.data;
  for (const PcdField& field : header.fields) file.fields.push_back(field.name);
  return with_scan(std::move(file), body.table, facts, options);
}

}  // namespace limen
