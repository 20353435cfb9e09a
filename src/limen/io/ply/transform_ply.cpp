// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/text.h"
#include "limen/files/text_numbers.h"
#include "limen/io/ply/ply.h"
#include "limen/io/ply/ply_header.h"
#include "limen/io/table/moved_columns.h"

namespace limen {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 20U;

/// What becomes of the points of a PLY file.
struct Plan {
  PlyElement vertex;
  std::size_t reachable = 0;  ///< properties that are looked at
  std::vector<MovedColumns> moved;
  std::vector<Scalar> written;  ///< type of each property in the output
  Rigid3 target_from_source;
  Vector3d offset = Vector3d::Zero();
  bool swapped = false;

  /// The values of three columns after the motion.
  [[nodiscard]] Vector3d move(const MovedColumns& columns, const Vector3d& x) const {
    return columns.moved(target_from_source, columns.direction ? x : Vector3d(offset + x));
  }
};

std::optional<std::size_t> find_property(const Plan& plan, std::string_view name) {
  for (std::size_t k = 0; k < plan.reachable; ++k) {
    const PlyProperty& property = plan.vertex.properties[k];
    if (!property.count_type && lower_case(property.name) == name) return k;
  }
  return {};
}

/// Properties whose place in a record is known: in text none behind a list.
std::size_t reachable_properties(const PlyElement& vertex, PlyEncoding encoding) {
  const auto list = std::find_if(vertex.properties.begin(), vertex.properties.end(),
                                 [](const PlyProperty& property) { return property.count_type; });
  const bool text = encoding == PlyEncoding::ascii;
  return text ? static_cast<std::size_t>(list - vertex.properties.begin()) : vertex.properties.size();
}

Plan plan_of(const PlyHeader& header, std::size_t which, const Rigid3& target_from_source) {
  Plan plan;
  plan.vertex = header.elements[which];
  plan.reachable = reachable_properties(plan.vertex, header.encoding);
  plan.target_from_source = target_from_source;
  plan.offset = header.offset;
  plan.swapped = header.swapped();
  for (const PlyProperty& property : plan.vertex.properties) plan.written.push_back(property.type);
  plan.moved = moved_columns([&](std::string_view name, bool direction) -> std::optional<std::size_t> {
    const std::optional<std::size_t> found = find_property(plan, name);
    if (found && direction && is_integer(plan.vertex.properties[*found].type)) return {};
    return found;
  });
  for (const MovedColumns& columns : plan.moved) {
    if (columns.direction) continue;
    for (const std::size_t k : columns.column) plan.written[k] = Scalar::float64;
  }
  return plan;
}

/// A comment with the position of a static scanner after the motion.
std::string centre_line(const Scan& scan, const Rigid3& target_from_source) {
  if (!scan.centre_known()) return "comment scanner_position unknown\n";
  const Vector3d centre = target_from_source * (scan.local_origin + scan.centres[0]);
  return fmt::format("comment scanner_position {} {} {}\n", centre.x(), centre.y(), centre.z());
}

bool tells_centre(std::string_view line) {
  const auto tokens = split_tokens(line);
  return tokens.size() > 1 && tokens[0] == "comment" &&
         lower_case(tokens[1]).substr(0, 16) == "scanner_position";
}

/// The header of the output: moved coordinates as double, no offset, the scanner's new position.
std::string header_text(const PlyHeader& header, std::size_t which, const Plan& plan,
                        const std::string& centre) {
  std::string text;
  std::size_t element = 0;
  std::size_t property = 0;
  for (const std::string& line : header.lines) {
    if (offset_in_line(line) || tells_centre(line)) continue;
    const auto tokens = split_tokens(line);
    const std::string_view word = tokens.empty() ? std::string_view{} : tokens[0];
    if (word == "element" && element++ == 0) text += centre;
    const bool ours = word == "property" && element == which + 1;
    const std::size_t k = ours ? property++ : 0;
    if (ours && !plan.vertex.properties[k].count_type && plan.written[k] != plan.vertex.properties[k].type) {
      text += fmt::format("property double {}\n", plan.vertex.properties[k].name);
    } else {
      text += line + "\n";
    }
  }
  return text;
}

template <typename Value>
void append_value(std::string& out, Value value, bool swapped) {
  std::array<char, sizeof(Value)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

/// New values of one record by property; nothing where a property stays.
using MovedValues = std::vector<std::optional<double>>;

/// `number` gives the old values.
template <typename Number>
MovedValues moved_values(const Plan& plan, const Number& number) {
  MovedValues values(plan.vertex.properties.size());
  for (const MovedColumns& columns : plan.moved) {
    const Vector3d old{number(columns.column[0]), number(columns.column[1]), number(columns.column[2])};
    const Vector3d moved = plan.move(columns, old);
    for (std::size_t k = 0; k < 3; ++k) values[columns.column[k]] = moved[static_cast<int>(k)];
  }
  return values;
}

/// Where each property of a binary record begins, and its end.
std::vector<std::size_t> property_starts(std::string_view bytes, std::size_t at, const Plan& plan) {
  std::vector<std::size_t> starts;
  for (const PlyProperty& property : plan.vertex.properties) {
    starts.push_back(at);
    at += size_of(property.count_type.value_or(property.type));
    if (!property.count_type) continue;
    const double count = load_number(bytes.data() + starts.back(), *property.count_type, plan.swapped);
    at += static_cast<std::size_t>(count) * size_of(property.type);
  }
  starts.push_back(at);
  return starts;
}

/// Appends one binary record; its bytes are known to be there. Returns where the next one begins.
std::size_t append_record(std::string& out, std::string_view bytes, std::size_t at, const Plan& plan) {
  const std::vector<std::size_t> starts = property_starts(bytes, at, plan);
  const auto values = moved_values(plan, [&](std::size_t k) {
    return load_number(bytes.data() + starts[k], plan.vertex.properties[k].type, plan.swapped);
  });
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const std::optional<double> value = values[k];
    if (!value) {
      out.append(bytes.substr(starts[k], starts[k + 1] - starts[k]));
    } else if (plan.written[k] == Scalar::float32) {
      append_value(out, static_cast<float>(*value), plan.swapped);
    } else {
      append_value(out, *value, plan.swapped);
    }
  }
  return starts.back();
}

/// One line of a text file with its moved numbers replaced.
std::string moved_line(std::string_view line, const Plan& plan) {
  const auto tokens = split_tokens(line);
  const auto values =
      moved_values(plan, [&](std::size_t k) { return parse_number(tokens[k]).value_or(0.0); });
  std::string text;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    if (k > 0) text += ' ';
    const std::optional<double> value = k < values.size() ? values[k] : std::nullopt;
    if (!value) {
      text += tokens[k];
    } else if (plan.written[k] == Scalar::float32) {
      fmt::format_to(std::back_inserter(text), "{}", static_cast<float>(*value));
    } else {
      fmt::format_to(std::back_inserter(text), "{}", *value);
    }
  }
  return text + "\n";
}

void write_in_pieces(AtomicFile& file, std::string& out, std::size_t least) {
  if (out.size() < least) return;
  file.write(out);
  out.clear();
}

void write_binary_body(AtomicFile& file, std::string_view bytes, std::size_t body, std::size_t start,
                       const Plan& plan) {
  file.write(bytes.substr(body, start - body));
  std::string out;
  std::size_t at = start;
  for (std::size_t i = 0; i < plan.vertex.count; ++i) {
    at = append_record(out, bytes, at, plan);
    write_in_pieces(file, out, kFlushBytes);
  }
  write_in_pieces(file, out, 0);
  file.write(bytes.substr(at));
}

/// `skip`: rows of other elements before the points.
void write_text_body(AtomicFile& file, std::string_view body, std::size_t skip, const Plan& plan) {
  std::string out;
  std::size_t row = 0;
  while (!body.empty() && row < skip + plan.vertex.count) {
    const TextLine line = first_line(body);
    if (holds_row(line.text)) {
      out += row < skip ? std::string(body.substr(0, line.bytes)) : moved_line(line.text, plan);
      ++row;
    }
    body.remove_prefix(line.bytes);
    write_in_pieces(file, out, kFlushBytes);
  }
  write_in_pieces(file, out, 0);
  file.write(body);
}

std::size_t rows_before(const PlyHeader& header, std::size_t which) {
  std::size_t rows = 0;
  for (std::size_t k = 0; k < which; ++k)
    rows += header.elements[k].properties.empty() ? 0 : header.elements[k].count;
  return rows;
}

}  // namespace

TransformedCloud transform_ply(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output, const ReadOptions& options) {
  // Reading the file proves that it is whole, and tells where its scanner stood.
  const ScanFile read = read_ply(input.bytes, input.name, options);
  const PlyHeader header = parse_ply_header(input.bytes, input.name);
  const std::size_t which = header.vertex(input.name);
  const Plan plan = plan_of(header, which, target_from_source);
  const bool centres_per_point = find_property(plan, "x_origin").has_value();
  TransformedCloud result;
  result.format = read.format;
  result.points = plan.vertex.count;
  for (const PlyElement& element : header.elements) {
    if (element.name == "camera")
      result.notes.emplace_back("the element camera is kept as it was, not moved");
  }
  AtomicFile file(output);
  const std::string centre = centres_per_point ? "" : centre_line(read.scans.front(), target_from_source);
  file.write(header_text(header, which, plan, centre));
  if (header.encoding == PlyEncoding::ascii) {
    write_text_body(file, input.bytes.substr(header.body), rows_before(header, which), plan);
  } else {
    const std::size_t start = ply_element_start(input.bytes, header, which, input.name);
    write_binary_body(file, input.bytes, header.body, start, plan);
  }
  file.commit();
  return result;
}

}  // namespace limen
