// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/scan_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/table/optical_centre.h"
#include "limen/io/table/profile_topology.h"
#include "limen/io/table/time_column.h"

namespace limen {
namespace {

/// Rows per piece of parallel work, and per strip of a column that stays in the cache.
constexpr std::size_t kScannedPerPiece = 65536;
constexpr std::size_t kScannedStrip = 1024;
/// No coordinate on Earth is larger (geocentric ones reach 6.4e6 m).
constexpr double kLargestM = 1e8;
constexpr double kLargestExtentM = 1e6;
/// Points nearer to 0,0,0 than this keep it as their local origin.
constexpr double kNearZeroM = 1e4;
constexpr double kRoundM = 100.0;

using FieldTriple = std::array<const Field*, 3>;

FieldTriple find_triple(const RecordTable& table, const std::string& suffix) {
  return {table.find({"x" + suffix}), table.find({"y" + suffix}), table.find({"z" + suffix})};
}
bool whole(const FieldTriple& triple) {
  return triple[0] != nullptr && triple[1] != nullptr && triple[2] != nullptr;
}

std::string names_of(const RecordTable& table) {
  std::string names;
  for (const Field& field : table.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "none" : names;
}

FieldTriple require_coordinates(const RecordTable& table, const TableFacts& facts) {
  const FieldTriple triple = find_triple(table, "");
  for (std::size_t k = 0; k < 3; ++k) {
    if (triple[k] != nullptr) continue;
    throw Error(fmt::format("the points have no {} (their values are: {})", "xyz"[k], names_of(table)),
                facts.name, "export the points with x, y and z");
  }
  return triple;
}

bool usable(const Vector3d& x) {
  return (x.array().abs() < kLargestM).all();  // false for NaN too
}

double unit_of(const TableFacts& facts) {
  return facts.metres_per_unit.value_or(1.0);
}

/// What the file says, in metres; `metres_per_unit` stays, for the points are still in its unit.
TableFacts in_metres(TableFacts facts) {
  const double unit = unit_of(facts);
  facts.offset *= unit;
  if (facts.pose) facts.pose->translation *= unit;
  if (facts.centre) *facts.centre *= unit;
  if (facts.possible_centre) *facts.possible_centre *= unit;
  return facts;
}

/// The first usable point, world; the search is short unless the file begins with missing returns.
Vector3d first_usable(const RecordTable& table, const FieldTriple& fields, const TableFacts& facts) {
  for (std::size_t i = 0; i < table.rows; ++i) {
    Vector3d x;
    for (std::size_t k = 0; k < 3; ++k) load_numbers(table, *fields[k], {i, i + 1}, &x[static_cast<int>(k)]);
    x *= unit_of(facts);
    if (usable(x)) return facts.offset + (facts.pose ? *facts.pose * x : x);
  }
  throw Error("no usable points: every one has a coordinate that is not a number or absurdly large",
              facts.name, "check how the file was exported");
}

/// Loads three columns as points, brought from the file's unit to metres and moved.
std::vector<Vector3d> load_points(const RecordTable& table, const FieldTriple& fields, const Rigid3& motion,
                                  double metres_per_unit) {
  const bool scaled = metres_per_unit != 1.0;
  const bool turned = !motion.rotation.isIdentity(0.0);
  std::vector<Vector3d> points(table.rows);
  parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t strip = begin; strip < end; strip += kScannedStrip) {
      const RowRange rows{strip, std::min(end, strip + kScannedStrip)};
      for (int k = 0; k < 3; ++k)
        load_numbers(table, *fields[static_cast<std::size_t>(k)], rows, points[strip].data() + k, 3);
      for (std::size_t i = rows.begin; i < rows.end; ++i) {
        if (scaled) points[i] *= metres_per_unit;
        if (turned) points[i] = motion.rotation * points[i];
        points[i] += motion.translation;
      }
    }
  });
  return points;
}

template <typename Value>
std::vector<Value> load_column(const RecordTable& table, const Field* field) {
  if (field == nullptr) return {};
  std::vector<Value> column(table.rows);
  parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
    std::array<double, kScannedStrip> strip{};
    for (std::size_t at = begin; at < end; at += kScannedStrip) {
      const std::size_t stop = std::min(end, at + kScannedStrip);
      load_numbers(table, *field, {at, stop}, strip.data());
      for (std::size_t i = at; i < stop; ++i) column[i] = static_cast<Value>(strip[i - at]);
    }
  });
  return column;
}

/// Whole numbers that fit; empty where some do not.
std::vector<std::int32_t> load_integers(const RecordTable& table, const Field& field) {
  const std::vector<double> numbers = load_column<double>(table, &field);
  std::vector<std::int32_t> integers(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!(std::abs(numbers[i]) <= 2147483647.0)) return {};
    integers[i] = static_cast<std::int32_t>(numbers[i]);
  }
  return integers;
}

ScanTopology stored_topology(const RecordTable& table) {
  const Field* line = table.find({"scan_line", "scanline", "scan_line_index", "column_index"});
  const Field* index = table.find({"scan_index", "scanindex", "row_index"});
  if (line == nullptr || index == nullptr) return {};
  ScanTopology topology{load_integers(table, *line), load_integers(table, *index)};
  if (topology.line.empty() || topology.index.empty()) return {};
  return topology;
}

/// A raster whose fast index runs over `length` points.
ScanTopology grid_topology(std::size_t size, std::size_t length, bool by_column) {
  ScanTopology topology;
  topology.line.resize(size);
  topology.index.resize(size);
  std::vector<std::int32_t>& slow = by_column ? topology.line : topology.index;
  std::vector<std::int32_t>& fast = by_column ? topology.index : topology.line;
  for (std::size_t i = 0; i < size; ++i) {
    slow[i] = static_cast<std::int32_t>(i / length);
    fast[i] = static_cast<std::int32_t>(i % length);
  }
  return topology;
}

ScanTopology find_topology(const RecordTable& table, const TableFacts& facts,
                           const std::vector<double>& times) {
  ScanTopology topology = stored_topology(table);
  if (topology.known()) return topology;
  if (table.rows <= INT32_MAX && facts.columns > 1) return grid_topology(table.rows, facts.columns, false);
  if (table.rows <= INT32_MAX && facts.column_length > 1) {
    return grid_topology(table.rows, facts.column_length, true);
  }
  const Field* theta = table.find({"theta", "scalar_theta"});
  if (theta == nullptr) return {};
  return recover_profiles(load_column<double>(table, theta), times);
}

/// What one column of colours holds.
struct ColourRange {
  double largest = 0.0;
  bool fractions = false;
};

ColourRange range_of(const std::vector<float>& values) {
  ColourRange range;
  for (const float value : values) {
    range.largest = std::max(range.largest, static_cast<double>(value));
    range.fractions = range.fractions || value != std::floor(value);
  }
  return range;
}

/// Brings a colour to 0..255: from 0..65535, or from 0..1.
double colour_scale(const ColourRange& range) {
  if (range.largest > 255.0) return 255.0 / 65535.0;
  return range.largest <= 1.0 && range.fractions ? 255.0 : 1.0;
}

std::vector<std::uint8_t> interleaved(const RecordTable& table, const FieldTriple& fields, double scale) {
  std::vector<std::uint8_t> colours(3 * table.rows);
  parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
    std::array<double, kScannedStrip> strip{};
    for (std::size_t at = begin; at < end; at += kScannedStrip) {
      const std::size_t stop = std::min(end, at + kScannedStrip);
      for (std::size_t k = 0; k < 3; ++k) {
        load_numbers(table, *fields[k], {at, stop}, strip.data());
        for (std::size_t i = at; i < stop; ++i) {
          const double value = scale * strip[i - at];
          colours[3 * i + k] = value > 0.0 ? static_cast<std::uint8_t>(std::min(255.0, value + 0.5)) : 0;
        }
      }
    }
  });
  return colours;
}

std::vector<std::uint8_t> load_colours(const RecordTable& table) {
  const FieldTriple fields{table.find({"red", "r", "diffuse_red"}),
                           table.find({"green", "g", "diffuse_green"}),
                           table.find({"blue", "b", "diffuse_blue"})};
  if (!whole(fields)) return {};
  ColourRange all;
  for (const Field* field : fields) {
    if (field->type == Scalar::uint8) continue;
    const ColourRange one = range_of(load_column<float>(table, field));
    all = {std::max(all.largest, one.largest), all.fractions || one.fractions};
  }
  return interleaved(table, fields, colour_scale(all));
}

/// Optical centres the file gives per point: one where all are the same, none where it gives none.
std::vector<Vector3d> load_centres(const RecordTable& table, const Rigid3& motion, double metres_per_unit) {
  const FieldTriple fields = find_triple(table, "_origin");
  if (!whole(fields)) return {};
  std::vector<Vector3d> centres = load_points(table, fields, motion, metres_per_unit);
  const bool same =
      std::all_of(centres.begin(), centres.end(), [&](const Vector3d& c) { return c == centres[0]; });
  if (same) centres.resize(1);
  return centres;
}

Scan load_scan(const RecordTable& table, const TableFacts& facts, const FieldTriple& fields) {
  Scan scan;
  scan.name = facts.name;
  scan.local_origin = round_origin_near(first_usable(table, fields, facts));
  Rigid3 motion = facts.pose.value_or(Rigid3{});
  motion.translation += facts.offset - scan.local_origin;
  scan.points = load_points(table, fields, motion, unit_of(facts));
  scan.centres = load_centres(table, motion, unit_of(facts));
  scan.times_s = load_column<double>(table, find_times(table));
  scan.intensities = load_column<float>(
      table, table.find({"intensity", "reflectance", "scalar_intensity", "scalar_reflectance", "amplitude"}));
  scan.colours = load_colours(table);
  scan.topology = find_topology(table, facts, scan.times_s);
  return scan;
}

/// The scan without points that are no points, and how many those were.
std::pair<Scan, std::size_t> without_unusable(Scan scan) {
  const auto good = [&](std::size_t i) {
    const bool seen_from = !scan.mobile() || usable(scan.centres[i] + scan.local_origin);
    return seen_from && usable(scan.points[i] + scan.local_origin);
  };
  const std::size_t bad = parallel_reduce(
      scan.size(), kScannedPerPiece, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += good(i) ? 0U : 1U;
        return count;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
  if (bad == 0) return {std::move(scan), 0};
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (good(i)) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return {subset(scan, kept), bad};
}

std::string told(const Vector3d& x) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", x.x(), x.y(), x.z());
}

/// The optical centre of a scan whose points carry none, and a sentence about how it was found.
std::string settle_centre(Scan& scan, const TableFacts& facts, const ReadOptions& options) {
  if (options.origin) {
    scan.centres = {*options.origin - scan.local_origin};
    scan.centre_source = PlaceSource::told_by_user;
    return {};
  }
  if (!scan.centres.empty() || options.trajectory) return {};
  if (facts.centre_unknown) return "the file says that its optical centre is not known";
  if (facts.centre) {
    scan.centres = {facts.offset + *facts.centre - scan.local_origin};
    return {};
  }
  if (facts.possible_centre) {
    const Vector3d candidate = facts.offset + *facts.possible_centre - scan.local_origin;
    if (can_be_scanner(scan.points, candidate)) {
      scan.centres = {candidate};
      // PCD writes 0 0 0 where nobody said anything.
      if (facts.possible_centre->isZero()) scan.centre_source = PlaceSource::assumed;
      return "the scanner is taken to stand at the view point of the file, " +
             told(candidate + scan.local_origin);
    }
  }
  const bool zero_is_near = !facts.has_offset && scan.local_origin.isZero();
  if (zero_is_near && can_be_scanner(scan.points, Vector3d::Zero())) {
    scan.centres = {Vector3d::Zero()};
    scan.centre_source = PlaceSource::assumed;
    return "the scanner is taken to stand at 0 0 0";
  }
  return "the optical centre is not known: 0 0 0 cannot be the scanner (give it with --origin if you know "
         "it)";
}

void check_extent(const Scan& scan) {
  const Extent extent = extent_of(scan.points);
  if (extent.diagonal() <= kLargestExtentM) return;
  throw Error(fmt::format("absurd extent: the points lie between {} and {}",
                          told(extent.low + scan.local_origin), told(extent.high + scan.local_origin)),
              scan.name, "check the unit, the types and the offset of the file");
}

}  // namespace

Vector3d round_origin_near(const Vector3d& x) {
  if ((x.array().abs() < kNearZeroM).all()) return Vector3d::Zero();
  return (x / kRoundM).array().round() * kRoundM;
}

ScanFile with_scan(ScanFile file, const RecordTable& table, const TableFacts& said,
                   const ReadOptions& options) {
  options.check();
  TableFacts facts = said;
  if (options.metres_per_unit) facts.metres_per_unit = options.metres_per_unit;
  facts = in_metres(std::move(facts));
  file.metres_per_unit = unit_of(facts);
  const FieldTriple fields = require_coordinates(table, facts);
  if (table.rows == 0) throw Error("there are no points", facts.name, "check how the file was exported");
  if (table.rows > 0xFFFFFFFFU) {
    throw Error(fmt::format("{} points are too many for one scan", table.rows), facts.name,
                "thin or split the file");
  }
  auto [scan, unusable] = without_unusable(load_scan(table, facts, fields));
  if (scan.points.empty()) {
    throw Error("no usable points: none has finite coordinates and a finite optical centre", facts.name,
                "check how the file was exported");
  }
  check_extent(scan);
  scan.level = options.level;
  if (unusable > facts.missing) {
    file.notes.push_back(fmt::format("{} points without finite coordinates below 100 000 km are left out",
                                     unusable - facts.missing));
  }
  std::string note = settle_centre(scan, facts, options);
  if (!note.empty()) file.notes.push_back(std::move(note));
  file.dropped += unusable;
  file.scans.push_back(std::move(scan));
  return file;
}

}  // namespace limen
