// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/pcd/pcd_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

/// A packed byte expands to at most so many (three bytes to 264); guards the allocation.
constexpr std::size_t kMostExpansion = 132;

}  // namespace

std::optional<std::string> expand_lzf(std::string_view packed, std::size_t size) {
  if (size / kMostExpansion > packed.size()) return {};
  std::string out(size, '\0');
  std::size_t at = 0;
  std::size_t in = 0;
  const auto byte = [&](std::size_t k) {
    return static_cast<std::size_t>(static_cast<std::uint8_t>(packed[k]));
  };
  while (in < packed.size()) {
    const std::size_t control = byte(in++);
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > packed.size() - in || run > size - at) return {};
      std::copy_n(packed.data() + in, run, out.data() + at);
      in += run;
      at += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) {
      if (in >= packed.size()) return {};
      length += byte(in++);
    }
    length += 2;
    if (in >= packed.size()) return {};
    const std::size_t distance = ((control & 31U) << 8U) + byte(in++) + 1;
    if (distance > at || length > size - at) return {};
    // One byte at a time: the reference may overlap what it writes.
    for (std::size_t k = 0; k < length; ++k, ++at) out[at] = out[at - distance];
  }
  if (at != size) return {};
  return out;
}

namespace {

constexpr std::size_t kMostFields = 1000;
constexpr std::size_t kMostCount = 100000;
const char* const kPcdRemedy = "the PCD header is damaged: export the file again";

using PcdTokens = std::vector<std::string_view>;

/// The tokens of one header line, where it is, and how to complain about it.
struct PcdLine {
  PcdTokens tokens;
  std::size_t number;
  const std::string& name;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(what, fmt::format("{}, line {}", name, number), kPcdRemedy);
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

void read_fields(const PcdLine& line, PcdHeader& header) {
  if (line.tokens.size() < 2 || line.tokens.size() > kMostFields)
    line.fail("FIELDS needs the names of the fields");
  header.fields.clear();
  for (std::size_t k = 1; k < line.tokens.size(); ++k) header.fields.push_back({lower_case(line.tokens[k])});
}

void read_per_field(const PcdLine& line, PcdHeader& header) {
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

/// tx ty tz qw qx qy qz; without the quaternion, or with one that is none, the sensor is not turned.
std::optional<Rigid3> viewpoint_of(const PcdLine& line) {
  if (line.tokens.size() < 4) return {};
  std::array<double, 7> numbers{0, 0, 0, 1, 0, 0, 0};
  for (std::size_t k = 0; k < std::min(numbers.size(), line.tokens.size() - 1); ++k) {
    const auto number = parse_number(line.tokens[k + 1]);
    if (!number || !(std::abs(*number) < 1e8)) return {};
    numbers[k] = *number;
  }
  Rigid3 viewpoint;
  viewpoint.translation = {numbers[0], numbers[1], numbers[2]};
  const Eigen::Quaterniond turn(numbers[3], numbers[4], numbers[5], numbers[6]);
  if (std::abs(turn.norm() - 1.0) < 0.01) viewpoint.rotation = turn.normalized().toRotationMatrix();
  return viewpoint;
}

/// Takes one line; returns true at DATA, the last one.
bool read_line(const PcdLine& line, PcdHeader& header) {
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

/// The bytes of a compressed body.
std::string expand_body(std::string_view body, std::size_t wanted, const std::string& name) {
  std::uint32_t sizes[2] = {0, 0};
  if (body.size() >= sizeof sizes) std::memcpy(sizes, body.data(), sizeof sizes);
  if (body.size() < sizeof sizes || sizes[0] > body.size() - sizeof sizes) {
    throw Error("the compressed points are cut off", name, "get the whole file");
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

}  // namespace

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name) {
  PcdHeader header;
  while (header.body < bytes.size() && header.lines < 1000) {
    const TextLine text = first_line(bytes.substr(header.body));
    header.body += text.bytes;
    const PcdLine line{split_tokens(text.text), ++header.lines, name};
    if (line.tokens.empty() || line.tokens[0].front() == '#') continue;
    if (!read_line(line, header)) continue;
    if (header.fields.empty()) line.fail("the header has no line FIELDS");
    std::size_t values = 0;
    for (const PcdField& field : header.fields) values += field.count;
    if (values > kMostCount) line.fail("a point has absurdly many values");
    return header;
  }
  throw Error("the header has no line DATA", fmt::format("{}, line {}", name, header.lines), kPcdRemedy);
}

Scalar pcd_scalar(const PcdField& field, const std::string& name) {
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
              name, kPcdRemedy);
}

void throw_pcd_too_few(std::size_t points, std::size_t room, const std::string& name) {
  throw Error(fmt::format("the header promises {} points, the file has room for {}", points, room), name,
              "get the whole file, or correct the count");
}

std::size_t PcdHeader::record_bytes() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.size * field.count;
  return bytes;
}

std::size_t PcdHeader::point_count(const std::string& name) const {
  if (points && *points > 0) return *points;
  if (height > 0 && width > SIZE_MAX / height) throw_pcd_too_few(SIZE_MAX, 0, name);
  const std::size_t count = width * std::max<std::size_t>(1, height);
  if (count == 0) throw Error("there are no points: POINTS 0", name, "check how the file was exported");
  return count;
}

PcdBody open_pcd_body(std::string_view bytes, const PcdHeader& header, const std::string& name) {
  const std::size_t points = header.point_count(name);
  const std::string_view body = bytes.substr(header.body);
  const std::size_t stride = header.record_bytes();
  if (header.data == "binary") {
    const std::size_t room = stride == 0 ? 0 : body.size() / stride;
    if (points > room) throw_pcd_too_few(points, room, name);
    return {nullptr, body.data(), false};
  }
  if (stride == 0 || points > UINT32_MAX / stride) throw_pcd_too_few(points, 0, name);
  auto expanded = std::make_shared<const std::string>(expand_body(body, points * stride, name));
  const char* data = expanded->data();
  return {std::move(expanded), data, true};
}

}  // namespace limen
