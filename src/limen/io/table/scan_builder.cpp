// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/table/scan_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/io/table/optical_centre.h"
#include "limen/io/table/profile_topology.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/value_tops.h"

namespace limen {
namespace {

/// Rows per piece of parallel work, and per strip of a column that stays in the cache.
constexpr std::size_t kScannedPerPiece = 65536;
constexpr std::size_t kScannedStrip = 1024;
/// No coordinate on Earth is larger (geocentric ones reach 6.4e6 m).
constexpr double kLargestM = 1e8;
constexpr double kLargestExtentM = 1e6;

using FieldTriple = std::array<const Field*, 3>;

FieldTriple find_triple(const RecordTable& table, const std::string& suffix) {
  return {table.find({"x" + suffix}), table.find({"y" + suffix}), table.find({"z" + suffix})};
}
bool whole(const FieldTriple& triple) {
  return triple[0] != nullptr && triple[1] != nullptr && triple[2] != nullptr;
}

FieldTriple find_colours(const RecordTable& table) {
  return {table.find({"red", "r", "diffuse_red"}), table.find({"green", "g", "diffuse_green"}),
          table.find({"blue", "b", "diffuse_blue"})};
}
const Field* find_intensities(const RecordTable& table) {
  return table.find({"intensity", "reflectance", "scalar_intensity", "scalar_reflectance", "amplitude"});
}
const Field* find_lines(const RecordTable& table) {
  return table.find({"scan_line", "scanline", "scan_line_index", "column_index"});
}
const Field* find_line_indices(const RecordTable& table) {
  return table.find({"scan_index", "scanindex", "row_index"});
}
const Field* find_angles(const RecordTable& table) {
  return table.find({"theta", "scalar_theta"});
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
    throw Error(fmt::format("the points have no {} (their columns are: {})", "xyz"[k], names_of(table)),
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

/// The first usable point, world, that is not 0 0 0, if there is one; the search is short unless the table
/// begins with missing returns.
std::optional<Vector3d> first_usable(const RecordTable& table, const FieldTriple& fields,
                                     const TableFacts& facts) {
  std::optional<Vector3d> first;
  for (std::size_t i = 0; i < table.rows; ++i) {
    Vector3d x;
    for (std::size_t k = 0; k < 3; ++k) load_numbers(table, *fields[k], {i, i + 1}, &x[static_cast<int>(k)]);
    x *= unit_of(facts);
    if (!usable(x)) continue;
    first = facts.offset + (facts.pose ? *facts.pose * x : x);
    if (!x.isZero(0.0)) break;
  }
  return first;
}

/// Appends three columns as points, brought from the file's unit to metres and moved.
void append_points(const RecordTable& table, const FieldTriple& fields, const Rigid3& motion,
                   double metres_per_unit, std::vector<Vector3d>& points) {
  const bool scaled = metres_per_unit != 1.0;
  const bool turned = !motion.rotation.isIdentity(0.0);
  const std::size_t before = points.size();
  points.resize(before + table.rows);
  parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t strip = begin; strip < end; strip += kScannedStrip) {
      const RowRange rows{strip, std::min(end, strip + kScannedStrip)};
      Vector3d* const to = points.data() + before;
      for (int k = 0; k < 3; ++k)
        load_numbers(table, *fields[static_cast<std::size_t>(k)], rows, to[strip].data() + k, 3);
      for (std::size_t i = rows.begin; i < rows.end; ++i) {
        if (scaled) to[i] *= metres_per_unit;
        if (turned) to[i] = motion.rotation * to[i];
        to[i] += motion.translation;
      }
    }
  });
}

/// Appends a column, every value made by `use`; nothing where there is no such column.
template <typename Value, typename Use>
void append_column(const RecordTable& table, const Field* field, std::vector<Value>& column, const Use& use) {
  if (field == nullptr) return;
  const std::size_t before = column.size();
  column.resize(before + table.rows);
  parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
    std::array<double, kScannedStrip> strip{};
    for (std::size_t at = begin; at < end; at += kScannedStrip) {
      const std::size_t stop = std::min(end, at + kScannedStrip);
      load_numbers(table, *field, {at, stop}, strip.data());
      for (std::size_t i = at; i < stop; ++i) column[before + i] = use(strip[i - at]);
    }
  });
}

template <typename Value>
void append_column(const RecordTable& table, const Field* field, std::vector<Value>& column) {
  append_column(table, field, column, [](double value) { return static_cast<Value>(value); });
}

/// What is written for a number that is no whole one within 32 bits.
constexpr std::int32_t kNoInteger = std::numeric_limits<std::int32_t>::min();

void append_integers(const RecordTable& table, const Field* field, std::vector<std::int32_t>& integers) {
  append_column(table, field, integers, [](double value) {
    return std::abs(value) <= 2147483647.0 ? static_cast<std::int32_t>(value) : kNoInteger;
  });
}

bool all_fit(const std::vector<std::int32_t>& integers) {
  return std::find(integers.begin(), integers.end(), kNoInteger) == integers.end();
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

/// Colours as they are stored, red, green and blue in turn, until all are known: of what kind they are shows
/// in the largest.
class ColourColumns {
 public:
  void reserve(std::size_t rows) { reserved_ = rows; }
  void add(const RecordTable& table) {
    const FieldTriple fields = find_colours(table);
    if (!whole(fields)) return;
    const bool small = std::all_of(fields.begin(), fields.end(), [](const Field* field) {
      return field->plain() && (field->type == Scalar::uint8 || field->type == Scalar::uint16);
    });
    if (small)
      append(table, fields, small_);
    else
      append(table, fields, wide_);
    for (const Field* field : fields) bytes_ = bytes_ && field->type == Scalar::uint8;
  }
  /// 0 to 255: from that, from 0 to 65535, or from 0 to 1.
  [[nodiscard]] std::vector<std::uint8_t> finish() { return small_.empty() ? scaled(wide_) : scaled(small_); }

 private:
  template <typename Value>
  void append(const RecordTable& table, const FieldTriple& fields, std::vector<Value>& colours) const {
    colours.reserve(3 * reserved_);
    const std::size_t before = colours.size();
    colours.resize(before + 3 * table.rows);
    parallel_for(table.rows, kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
      std::array<double, kScannedStrip> strip{};
      for (std::size_t at = begin; at < end; at += kScannedStrip) {
        const std::size_t stop = std::min(end, at + kScannedStrip);
        for (std::size_t k = 0; k < 3; ++k) {
          load_numbers(table, *fields[k], {at, stop}, strip.data());
          for (std::size_t i = at; i < stop; ++i)
            colours[before + 3 * i + k] = static_cast<Value>(strip[i - at]);
        }
      }
    });
  }

  template <typename Value>
  [[nodiscard]] double scale_of(const std::vector<Value>& stored) const {
    if (bytes_) return 1.0;
    double largest = 0.0;
    bool fractions = false;
    for (const Value value : stored) {
      largest = std::max(largest, static_cast<double>(value));
      if constexpr (std::is_floating_point_v<Value>) fractions = fractions || value != std::floor(value);
    }
    return 255.0 / colour_top(largest, !fractions);
  }

  template <typename Value>
  [[nodiscard]] std::vector<std::uint8_t> scaled(std::vector<Value>& stored) const {
    const double scale = scale_of(stored);
    std::vector<std::uint8_t> colours(stored.size());
    parallel_for(stored.size(), kScannedPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const double value = scale * static_cast<double>(stored[i]);
        colours[i] = value > 0.0 ? static_cast<std::uint8_t>(std::min(255.0, value + 0.5)) : 0;
      }
    });
    return colours;
  }

  std::vector<std::uint16_t> small_;
  std::vector<float> wide_;
  std::size_t reserved_ = 0;
  bool bytes_ = true;
};

template <typename Good>
std::size_t count_bad(const Scan& scan, const Good& good) {
  return parallel_reduce(
      scan.size(), kScannedPerPiece, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) count += good(scan, i) ? 0U : 1U;
        return count;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
}

/// The scan with only those points that are `good`; all but `bad` are.
template <typename Good>
Scan only(Scan scan, const Good& good, std::size_t bad) {
  if (bad == 0) return scan;
  std::vector<std::uint32_t> kept;
  kept.reserve(scan.size() - bad);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (good(scan, i)) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return subset(scan, kept);
}

/// Whether a point is one. 0 0 0 far from all others is how some programs write a missing return.
bool is_point(const Scan& scan, std::size_t i) {
  const Vector3d x = scan.points[i] + scan.local_origin;
  return usable(x) && (scan.local_origin.isZero(0.0) || !x.isZero(0.0));
}

bool has_scanner(const Scan& scan, std::size_t i) {
  return !scan.mobile() || usable(scan.centres[i] + scan.local_origin);
}

/// Of centres that are all the same one stays, for the few points without one too.
void settle_same_centres(Scan& scan) {
  std::vector<Vector3d>& centres = scan.centres;
  const auto is_stated = [&](const Vector3d& centre) { return usable(centre + scan.local_origin); };
  const auto first = std::find_if(centres.begin(), centres.end(), is_stated);
  if (first == centres.end()) return;
  const Vector3d one = *first;
  const bool same = std::all_of(centres.begin(), centres.end(),
                                [&](const Vector3d& c) { return c == one || !is_stated(c); });
  if (!same) return;
  centres.assign(1, one);
  centres.shrink_to_fit();
}

/// The scanner positions of a scan, and how many points without one are to be left out. Where these are many,
/// as in clouds merged of scans with and without, none is: it is unknown for all, and a sentence says so.
std::size_t settle_centres(Scan& scan, std::string& note) {
  constexpr double kMany = 0.1;
  const std::size_t missing = count_bad(scan, has_scanner);
  if (static_cast<double>(missing) > kMany * static_cast<double>(scan.size())) {
    scan.centres.clear();
    note = fmt::format("{} of {} points state no scanner position; it is taken as unknown for all", missing,
                       scan.size());
    return 0;
  }
  settle_same_centres(scan);
  return scan.mobile() ? missing : 0;
}

std::string stated(const Vector3d& x) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", x.x(), x.y(), x.z());
}

/// The scanner position of a scan whose points carry none, and a sentence about how it was found.
std::string settle_centre(Scan& scan, const TableFacts& facts, const ReadOptions& options,
                          const Scan& as_measured) {
  if (options.origin) {
    scan.centres = {*options.origin - scan.local_origin};
    scan.centre_source = PlaceSource::stated_by_user;
    return {};
  }
  if (!scan.centres.empty() || options.trajectory) return {};
  if (facts.centre_unknown) return "the file states that the scanner position is unknown";
  if (facts.centre) {
    scan.centres = {facts.offset + *facts.centre - scan.local_origin};
    return {};
  }
  const auto can_be = [&](const Vector3d& candidate) {
    return can_be_scanner(as_measured.points, scan.local_origin + candidate - as_measured.local_origin);
  };
  if (facts.possible_centre) {
    const Vector3d candidate = facts.offset + *facts.possible_centre - scan.local_origin;
    if (can_be(candidate)) {
      scan.centres = {candidate};
      // PCD writes 0 0 0 where nobody said anything.
      if (facts.possible_centre->isZero()) scan.centre_source = PlaceSource::assumed;
      return "the view point of the file is taken as the scanner position, " +
             stated(candidate + scan.local_origin);
    }
  }
  const bool zero_is_near = !facts.has_offset && scan.local_origin.isZero();
  if (zero_is_near && can_be(Vector3d::Zero())) {
    scan.centres = {Vector3d::Zero()};
    scan.centre_source = PlaceSource::assumed;
    return "0 0 0 is taken as the scanner position";
  }
  return "the scanner position is unknown: the file does not state it, and 0 0 0 is not plausible";
}

void check_extent(const Scan& scan) {
  const Extent extent = extent_of(scan.points);
  constexpr std::size_t kManyPoints = 100;  // fewer may be an example
  if (scan.size() >= kManyPoints && extent.diagonal() == 0.0) {
    throw Error(fmt::format("all {} points have the same position, {}", scan.size(),
                            stated(extent.low + scan.local_origin)),
                scan.name, "check how the file was exported");
  }
  if (extent.diagonal() <= kLargestExtentM) return;
  throw Error(fmt::format("absurd extent: the points lie between {} and {}",
                          stated(extent.low + scan.local_origin), stated(extent.high + scan.local_origin)),
              scan.name, "check the unit, the types and the offset of the file");
}

}  // namespace

struct ScanBuilder::Parts {
  TableFacts facts;  ///< in metres
  ReadOptions options;
  Scan scan;
  Rigid3 motion;            ///< of the numbers, in metres, to places about the local origin
  bool has_origin = false;  ///< a usable point has come
  std::size_t rows = 0;
  std::size_t reserved = 0;
  ScanTopology stored;         ///< as the columns of the file tell it
  std::vector<double> angles;  ///< of a turning mirror
  ColourColumns colours;

  void settle_origin(const RecordTable& table, const FieldTriple& fields) {
    if (has_origin) return;
    const std::optional<Vector3d> first = first_usable(table, fields, facts);
    has_origin = first.has_value();
    scan.local_origin = first ? round_origin_near(*first) : Vector3d(Vector3d::Zero());
    motion = facts.pose.value_or(Rigid3{});
    motion.translation += facts.offset - scan.local_origin;
  }

  [[nodiscard]] ScanTopology topology() {
    if (stored.known() && stored.line.size() == stored.index.size() && all_fit(stored.line) &&
        all_fit(stored.index))
      return std::move(stored);
    if (rows <= INT32_MAX && facts.columns > 1) return grid_topology(rows, facts.columns, false);
    if (rows <= INT32_MAX && facts.column_length > 1) return grid_topology(rows, facts.column_length, true);
    if (angles.empty()) return {};
    return recover_profiles(angles, scan.times_s);
  }
};

ScanBuilder::ScanBuilder(const TableFacts& facts, const ReadOptions& options)
    : parts_(std::make_unique<Parts>()) {
  options.check();
  parts_->facts = facts;
  if (options.metres_per_unit) parts_->facts.metres_per_unit = options.metres_per_unit;
  parts_->facts = in_metres(std::move(parts_->facts));
  parts_->options = options;
  parts_->scan.name = facts.name;
}

ScanBuilder::ScanBuilder(ScanBuilder&&) noexcept = default;
ScanBuilder& ScanBuilder::operator=(ScanBuilder&&) noexcept = default;
ScanBuilder::~ScanBuilder() = default;

void ScanBuilder::reserve(std::size_t rows) {
  parts_->reserved = rows;
  parts_->colours.reserve(rows);
}

void ScanBuilder::add(const RecordTable& table) {
  Parts& parts = *parts_;
  const FieldTriple fields = require_coordinates(table, parts.facts);
  parts.rows += table.rows;
  if (parts.rows > 0xFFFFFFFFU) {
    throw Error(fmt::format("{} points and more are too many for one scan", parts.rows), parts.facts.name,
                "thin or split the file");
  }
  parts.settle_origin(table, fields);
  Scan& scan = parts.scan;
  const double unit = unit_of(parts.facts);
  const auto roomy = [&](auto& column) -> auto& {
    if (column.empty()) column.reserve(std::max(parts.reserved, table.rows));
    return column;
  };
  append_points(table, fields, parts.motion, unit, roomy(scan.points));
  if (const FieldTriple centres = find_triple(table, "_origin"); whole(centres))
    append_points(table, centres, parts.motion, unit, roomy(scan.centres));
  const auto append = [&](const Field* field, auto& column) {
    if (field != nullptr) append_column(table, field, roomy(column));
  };
  append(find_times(table), scan.times_s);
  append(find_intensities(table), scan.intensities);
  append(find_angles(table), parts.angles);
  if (find_lines(table) != nullptr && find_line_indices(table) != nullptr) {
    append_integers(table, find_lines(table), roomy(parts.stored.line));
    append_integers(table, find_line_indices(table), roomy(parts.stored.index));
  }
  parts.colours.add(table);
}

/// Positions in another frame than the points would make rays of thousands of kilometres.
void check_centres(const Scan& scan) {
  const double range_m = scan.mobile() ? median_range(scan) : 0.0;
  if (range_m <= kFarthestRangeM) return;
  throw Error(fmt::format("the scanner positions of the points are {:.0f} km away from them", 1e-3 * range_m),
              scan.name,
              "bring x_origin, y_origin and z_origin into the frame of x, y and z, or leave them out");
}

ScanFile ScanBuilder::finish(ScanFile file, const Scan* as_measured) {
  Parts& parts = *parts_;
  const TableFacts& facts = parts.facts;
  file.metres_per_unit = unit_of(facts);
  file.offset_applied = facts.offset;
  if (parts.rows == 0) throw Error("there are no points", facts.name, "check how the file was exported");
  if (!parts.has_origin) {
    throw Error("no usable points: every one has a coordinate that is not a number or absurdly large",
                facts.name,
                "check how the file was exported; limen assumes metres for a file that states no unit: name "
                "another with --units");
  }
  parts.scan.colours = parts.colours.finish();
  // Formats that always have a column of times fill it with 0 where there are none.
  std::vector<double>& times_s = parts.scan.times_s;
  if (std::all_of(times_s.begin(), times_s.end(), [](double time_s) { return time_s == 0.0; }))
    times_s.clear();
  parts.scan.topology = parts.topology();
  std::size_t unusable = count_bad(parts.scan, is_point);
  Scan scan = only(std::move(parts.scan), is_point, unusable);
  std::string mixed;
  const std::size_t unseen = settle_centres(scan, mixed);
  scan = only(std::move(scan), has_scanner, unseen);
  unusable += unseen;
  if (scan.points.empty()) {
    throw Error("no usable points: none has finite coordinates and a finite scanner position", facts.name,
                "check how the file was exported");
  }
  check_extent(scan);
  if (!parts.options.trajectory) check_centres(scan);
  scan.level = parts.options.level;
  const bool given = parts.options.origin || parts.options.trajectory;
  std::string note = mixed.empty() || given
                         ? settle_centre(scan, facts, parts.options, as_measured ? *as_measured : scan)
                         : std::move(mixed);
  if (!note.empty()) file.notes.push_back(std::move(note));
  file.dropped += unusable;
  file.unusable += unusable - std::min(unusable, facts.missing);
  file.scans.push_back(std::move(scan));
  return file;
}

ScanFile with_scan(ScanFile file, const RecordTable& table, const TableFacts& facts,
                   const ReadOptions& options, const Scan* as_measured) {
  ScanBuilder builder(facts, options);
  builder.add(table);
  return builder.finish(std::move(file), as_measured);
}

}  // namespace limen
