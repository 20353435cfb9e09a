// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/text/read_segments.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/bounded_json.h"
#include "limen/files/mapped_file.h"
#include "limen/files/text_numbers.h"

namespace limen {
namespace {

using nlohmann::json;

constexpr const char* kSegmentsRemedy =
    "give the JSON of limen segments or limen openings, or a text of p, O and L lines";
constexpr std::size_t kMostBytes = 512U << 20U;
constexpr double kUnseenM = 1.0;  // a side of an opening known no better was not seen
constexpr double kNoLengthM = 1e-6;

enum class Form { unknown, keyed, letters, collinear };

std::string place(const std::string& name, std::size_t line) {
  return fmt::format("{}, line {}", name, line);
}

/// `count` numbers of a line from token `first`; throws Error.
std::vector<double> numbers_of(const std::vector<std::string_view>& tokens, std::size_t first,
                               std::size_t count, const std::string& where) {
  if (tokens.size() < first + count) {
    throw Error(fmt::format("the line must have {} numbers, but has {}", count,
                            tokens.size() - std::min(first, tokens.size())),
                where, "complete or remove the line");
  }
  std::vector<double> numbers;
  for (std::size_t k = first; k < first + count; ++k) {
    const auto number = parse_number(tokens[k]);
    if (!number || !std::isfinite(*number))
      throw Error(fmt::format("\"{}\" is not a number", tokens[k].substr(0, 40)), where,
                  "correct or remove the line");
    numbers.push_back(*number);
  }
  return numbers;
}

Segment segment_of(const double* numbers) {
  return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
}

/// Whether a line has the form "n, n segments, m, m image lines".
bool is_collinear_line(const std::vector<std::string_view>& tokens) {
  if (tokens.empty()) return false;
  const auto pieces = parse_count(tokens[0]);
  if (!pieces || *pieces < 1 || *pieces > tokens.size() || tokens.size() < 2 + 6 * *pieces) return false;
  const auto images = parse_count(tokens[1 + 6 * *pieces]);
  return images && *images >= 1 && *images < tokens.size() && tokens.size() == 2 + 6 * *pieces + 6 * *images;
}

bool is_letter_line(const std::vector<std::string_view>& tokens) {
  if (tokens[0] == "p") return tokens.size() >= 5;
  return (tokens[0] == "O" && tokens.size() >= 2) || (tokens[0] == "L" && tokens.size() >= 7);
}

/// The form of a text by its first lines that say something.
Form form_of(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos) return Form::unknown;
  if (text[start] == '{') {
    const bool named = text.find("\"segments\"") != std::string_view::npos ||
                       text.find("\"openings\"") != std::string_view::npos;
    return named ? Form::keyed : Form::unknown;
  }
  constexpr std::size_t kWanted = 3;
  std::size_t letters = 0;
  std::size_t collinear = 0;
  std::size_t rows = 0;
  while (!text.empty() && rows < kWanted) {
    const TextLine line = first_line(text);
    text.remove_prefix(line.bytes);
    const auto tokens = split_tokens(line.text);
    if (tokens.empty() || !holds_row(line.text)) continue;
    ++rows;
    if (is_letter_line(tokens)) ++letters;
    if (is_collinear_line(tokens)) ++collinear;
  }
  if (rows > 0 && letters == rows) return Form::letters;
  return rows > 0 && collinear == rows ? Form::collinear : Form::unknown;
}

std::vector<Segment> from_text(std::string_view text, Form form, const std::string& name) {
  std::vector<Segment> segments;
  text = without_byte_order_mark(text);
  for (std::size_t number = 1; !text.empty(); ++number) {
    const TextLine line = first_line(text);
    text.remove_prefix(line.bytes);
    const auto tokens = split_tokens(line.text);
    if (tokens.empty() || !holds_row(line.text)) continue;
    const std::string where = place(name, number);
    if (form == Form::collinear) {
      const auto pieces = parse_count(tokens[0]);
      if (!pieces || *pieces < 1)
        throw Error("the line begins with no count of pieces", where, "correct or remove the line");
      const auto numbers = numbers_of(tokens, 1, 6 * std::min(*pieces, tokens.size()), where);
      for (std::size_t k = 0; k + 6 <= numbers.size(); k += 6) segments.push_back(segment_of(&numbers[k]));
    } else if (tokens[0] == "L") {
      segments.push_back(segment_of(numbers_of(tokens, 1, 6, where).data()));
    } else if (tokens[0] != "p" && tokens[0] != "O") {
      throw Error(fmt::format("\"{}\" is not p, O or L", tokens[0].substr(0, 40)), where,
                  "correct or remove the line");
    }
  }
  return segments;
}

Vector3d point_of(const json& list, const std::string& where) {
  const bool good = list.is_array() && list.size() == 3 &&
                    std::all_of(list.begin(), list.end(), [](const json& x) { return x.is_number(); });
  if (!good) throw Error("is not a point of three numbers", where, kSegmentsRemedy);
  const Vector3d point(list[0].get<double>(), list[1].get<double>(), list[2].get<double>());
  if (!point.allFinite()) throw Error("is not finite", where, kSegmentsRemedy);
  return point;
}

std::vector<Segment> from_segment_list(const json& list, const std::string& name) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("{}: segments[{}]", name, i);
    if (!list[i].is_object() || !list[i].contains("a") || !list[i].contains("b"))
      throw Error("has no ends a and b", where, kSegmentsRemedy);
    segments.push_back({point_of(list[i]["a"], where + ".a"), point_of(list[i]["b"], where + ".b")});
  }
  return segments;
}

/// The sides of openings that were seen.
std::vector<Segment> from_openings(const json& list, const std::string& name) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string where = fmt::format("{}: openings[{}]", name, i);
    const json corners = list[i].is_object() ? list[i].value("corners", json()) : json();
    if (!corners.is_array() || corners.size() != 4)
      throw Error("has no four corners", where, kSegmentsRemedy);
    const json sigmas = list[i].value("edge_sigma_m", json());
    for (std::size_t k = 0; k < 4; ++k) {
      const bool unseen = sigmas.is_array() && sigmas.size() == 4 && sigmas[k].is_number() &&
                          sigmas[k].get<double>() >= kUnseenM;
      const Segment side = {point_of(corners[k], where), point_of(corners[(k + 1) % 4], where)};
      if (!unseen) segments.push_back(side);
    }
  }
  return segments;
}

std::vector<Segment> from_json(std::string_view text, const std::string& name) {
  text = without_byte_order_mark(text);
  json object;
  try {
    object = parsed_json<json>(text);
  } catch (const json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = static_cast<std::size_t>(std::count(text.begin(), end, '\n')) + 1;
    throw Error("is not JSON", place(name, line), "correct the file, or write it anew");
  } catch (const json::out_of_range&) {
    throw Error("has a number that is too large", name, "correct the file, or write it anew");
  } catch (const JsonTooDeep& deep) {
    throw Error(deep.what(), name, "correct the file, or write it anew");
  }
  for (const char* key : {"segments", "openings"}) {
    if (!object.contains(key)) continue;
    const json& list = object[key];
    if (!list.is_array()) throw Error(fmt::format("{} is not a list", key), name, kSegmentsRemedy);
    return std::string_view(key) == "segments" ? from_segment_list(list, name) : from_openings(list, name);
  }
  throw Error("has neither segments nor openings", name, kSegmentsRemedy);
}

/// About a whole-metre origin near the middle, those of no length left out.
SegmentSet localised(const std::vector<Segment>& segments) {
  SegmentSet set;
  Vector3d low = Vector3d::Constant(1e300);
  Vector3d high = Vector3d::Constant(-1e300);
  for (const Segment& segment : segments) {
    low = low.cwiseMin(segment.a.cwiseMin(segment.b));
    high = high.cwiseMax(segment.a.cwiseMax(segment.b));
  }
  for (Eigen::Index k = 0; k < 3; ++k) set.local_origin[k] = std::round(0.5 * low[k] + 0.5 * high[k]);
  for (const Segment& segment : segments) {
    const Segment local = {segment.a - set.local_origin, segment.b - set.local_origin};
    if (local.length() > kNoLengthM) set.segments.push_back(local);
  }
  return set;
}

}  // namespace

bool is_segment_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;  // a pipe can be read only once
  try {
    const MappedFile file(path);
    return form_of(file.bytes()) != Form::unknown;
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    return false;
  }
}

SegmentSet read_segments(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string name = path.string();
  if (file.bytes().size() > kMostBytes)
    throw Error("is far too large for a list of segments", name, kSegmentsRemedy);
  const Form form = form_of(file.bytes());
  if (form == Form::unknown) throw Error("holds no segments that limen can read", name, kSegmentsRemedy);
  const std::vector<Segment> segments = with_whole_inputs([&] {
    return form == Form::keyed ? from_json(file.bytes(), name) : from_text(file.bytes(), form, name);
  });
  SegmentSet set;
  if (!segments.empty()) set = localised(segments);
  if (set.segments.empty()) throw Error("holds no segment", name, kSegmentsRemedy);
  return set;
}

}  // namespace limen
