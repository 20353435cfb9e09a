// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/files/text_numbers.h"
#include "limen/io/ptx/ptx.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"
#include "limen/io/table/table_stream.h"

namespace limen {
namespace {

/// Numbers in each of the ten header lines.
constexpr std::array<std::size_t, 10> kHeaderNumbers{1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
constexpr std::size_t kMostSide = 10000000;
/// The matrices are written with six digits, or fewer.
constexpr double kRigidTolerance = 2e-3;

/// How far the reading has come.
struct Cursor {
  std::string_view rest;
  std::size_t line = 1;  ///< of the rest's beginning

  void skip_blank() {
    for (TextLine next = first_line(rest); next.bytes > 0 && split_tokens(next.text).empty();
         next = first_line(rest)) {
      rest.remove_prefix(next.bytes);
      ++line;
    }
  }
};

struct PtxHeader {
  std::size_t columns = 0;
  std::size_t rows = 0;
  Rigid3 world_from_scan;
};

/// The numbers of one header line; empty where it has others.
std::optional<std::vector<double>> header_numbers(std::string_view line, std::size_t wanted) {
  const auto tokens = split_tokens(line);
  if (tokens.size() != wanted) return {};
  std::vector<double> numbers;
  for (const std::string_view token : tokens) {
    const auto number = parse_number(token);
    if (!number || !std::isfinite(*number)) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::size_t side_of(double number, const std::string& where) {
  if (number >= 0.0 && number <= static_cast<double>(kMostSide) && number == std::floor(number)) {
    return static_cast<std::size_t>(number);
  }
  throw Error(fmt::format("{} is not a number of columns or rows", number), where, "export the file again");
}

/// The matrix of a PTX header is written for row vectors: it is the transpose of what we use.
Rigid3 pose_of(const Matrix4d& transposed, const std::string& where) {
  Rigid3 pose;
  try {
    pose = from_matrix(transposed.transpose(), kRigidTolerance);
  } catch (const Error& error) {
    if (error.fault() != Fault::input) throw;
    throw Error("the matrix of the scan is not a rigid motion: " + error.problem(), where,
                "export the scan without scale or shear");
  }
  // Six digits turn a rotation into a slightly sheared one: 0.1 mm at 100 m.
  const Matrix3d skew = pose.rotation.transpose() * pose.rotation - Matrix3d::Identity();
  if (skew.cwiseAbs().maxCoeff() > 1e-12) pose.rotation = nearest_rotation(pose.rotation);
  return pose;
}

PtxHeader take_header(Cursor& cursor, const std::string& name) {
  std::array<std::vector<double>, 10> lines;
  const std::size_t first = cursor.line;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const TextLine line = first_line(cursor.rest);
    const auto numbers = header_numbers(line.text, kHeaderNumbers[k]);
    if (!numbers) {
      throw Error(fmt::format("line {} of a PTX header needs {} numbers", k + 1, kHeaderNumbers[k]),
                  fmt::format("{}, line {}", name, cursor.line), "get the whole file, or export it again");
    }
    lines[k] = *numbers;
    cursor.rest.remove_prefix(line.bytes);
    ++cursor.line;
  }
  const std::string where = fmt::format("{}, line {}", name, first);
  Matrix4d transposed;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      transposed(row, column) = lines[6 + static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  }
  return {side_of(lines[0][0], where), side_of(lines[1][0], where), pose_of(transposed, where)};
}

/// Lines of points, and empty ones among them.
struct PointLines {
  std::string_view text;
  std::size_t points = 0;
};

/// The next `rows` lines that are not empty; less where the file ends.
PointLines take_lines(Cursor& cursor, std::size_t rows) {
  std::size_t end = 0;
  std::size_t lines = 0;
  std::size_t taken = 0;
  for (; taken < rows && end < cursor.rest.size(); ++lines) {
    const std::size_t newline = cursor.rest.find('\n', end);
    const std::size_t stop = newline == std::string_view::npos ? cursor.rest.size() : newline + 1;
    if (stop - end > 3 || !split_tokens(cursor.rest.substr(end, stop - end - 1)).empty()) ++taken;
    end = stop;
  }
  const std::string_view text = cursor.rest.substr(0, end);
  cursor.rest.remove_prefix(end);
  cursor.line += lines;
  return {text, taken};
}

/// Moves the points to the world and makes missing returns not-a-number; returns how many those were.
std::size_t move_to_world(std::vector<double>& numbers, std::size_t columns, const Rigid3& world_from_scan) {
  const std::size_t rows = numbers.size() / columns;
  const double missing = std::numeric_limits<double>::quiet_NaN();
  return parallel_reduce(
      rows, std::size_t{65536}, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
          Eigen::Map<Vector3d> point(numbers.data() + i * columns);
          count += point.isZero(0.0) ? 1U : 0U;
          point = point.isZero(0.0) ? Vector3d::Constant(missing) : world_from_scan * Vector3d(point);
        }
        return count;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
}

std::vector<std::string> names_of(std::string_view first_row) {
  std::vector<std::string> names{"x", "y", "z", "intensity", "red", "green", "blue"};
  const std::size_t there = split_tokens(first_row).size();
  names.resize(there >= 7 ? 7 : std::clamp<std::size_t>(there, 3, 4));
  return names;
}

/// One scan of the file.
struct Station {
  std::string name;
  PtxHeader header;
  std::size_t at;  ///< byte of the file at which its header begins
  PointLines rows;
  std::size_t line;  ///< of the file at which they begin

  [[nodiscard]] std::size_t points() const { return header.columns * header.rows; }
};

TableFacts facts_of(const Station& station) {
  TableFacts facts;
  facts.name = station.name;
  facts.column_length = station.header.rows;
  const bool placed = to_matrix(station.header.world_from_scan) != Matrix4d::Identity();
  if (placed) facts.centre = station.header.world_from_scan.translation;
  return facts;
}

ScanFile with_station(ScanFile file, const Station& station, const ReadOptions& options) {
  const std::size_t points = station.points();
  const std::vector<std::string> names = names_of(first_line(station.rows.text).text);
  TextRows wanted;
  wanted.columns = names.size();
  wanted.rows = points;
  wanted.first_line_number = station.line;
  auto numbers =
      std::make_shared<std::vector<double>>(parse_rows(station.rows.text, wanted, station.name).numbers);
  const std::size_t missing = move_to_world(*numbers, names.size(), station.header.world_from_scan);
  if (missing > 0) file.notes.push_back(fmt::format("{}: {} missing returns", station.name, missing));
  if (missing == points) {
    file.dropped += missing;
    return file;
  }
  TableFacts facts = facts_of(station);
  facts.missing = missing;
  file.fields = names;
  return with_scan(std::move(file), table_of_numbers(std::move(numbers), names), facts, options);
}

/// The scans of a file one after the other, not read yet.
std::vector<Station> stations_of(std::string_view bytes, const std::string& name) {
  std::vector<Station> stations;
  Cursor cursor{bytes};
  for (cursor.skip_blank(); !cursor.rest.empty(); cursor.skip_blank()) {
    Station station;
    station.at = bytes.size() - cursor.rest.size();
    station.header = take_header(cursor, name);
    station.line = cursor.line;
    station.rows = take_lines(cursor, station.points());
    station.name = name;
    cursor.skip_blank();
    if (!stations.empty() || !cursor.rest.empty())
      station.name += fmt::format(", scan {}", stations.size() + 1);
    stations.push_back(std::move(station));
  }
  return stations;
}

/// A scan as a cloud that is read in pieces.
CloudSource source_of(const Station& station) {
  TextCloud text;
  text.text = station.rows.text;
  text.file = station.name;
  text.names = names_of(first_line(station.rows.text).text);
  text.wanted.columns = text.names.size();
  text.wanted.rows = station.points();
  text.wanted.first_line_number = station.line;
  text.change = [names = text.names, pose = station.header.world_from_scan](std::vector<double>& numbers) {
    move_to_world(numbers, names.size(), pose);
    return names;
  };
  CloudSource source;
  source.facts.table = facts_of(station);
  source.facts.points = station.points();
  source.facts.fields = text.names;
  source.open = [text] { return stream_of_text(text); };
  return source;
}

}  // namespace

bool looks_like_ptx(std::string_view bytes) {
  std::string_view rest = bytes.substr(0, 4096);
  for (const std::size_t wanted : kHeaderNumbers) {
    const TextLine line = first_line(rest);
    if (!header_numbers(line.text, wanted)) return false;
    rest.remove_prefix(line.bytes);
  }
  return true;
}

ScanFile read_ptx(std::string_view bytes, const std::string& name, const ReadOptions& options) {
  ScanFile file;
  file.format = "PTX";
  for (const Station& station : stations_of(bytes, name))
    file = with_station(std::move(file), station, options);
  if (file.scans.empty())
    throw Error("there are no points: all returns are missing", name, "export the file again");
  return file;
}

std::unique_ptr<PointFile> open_ptx(std::string_view bytes, const std::string& name) {
  std::vector<CloudSource> clouds;
  for (const Station& station : stations_of(bytes, name)) clouds.push_back(source_of(station));
  return make_point_file("PTX", std::move(clouds));
}

std::vector<PtxPlace> ptx_places(std::string_view bytes, const std::string& name) {
  std::vector<PtxPlace> places;
  for (const Station& station : stations_of(bytes, name)) {
    if (station.rows.points < station.points()) {
      throw Error(
          fmt::format("the file ends {} points before its time", station.points() - station.rows.points),
          name, "get the whole file, or correct the count");
    }
    const auto body = static_cast<std::size_t>(station.rows.text.data() - bytes.data());
    places.push_back({station.at, body, station.points()});
  }
  return places;
}

}  // namespace limen
