// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/read_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limen/base/drawn_steps.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/io/cloud/thin_cloud.h"
#include "limen/io/table/packed_rows.h"
#include "limen/io/table/record_table.h"
#include "limen/io/table/scan_builder.h"

namespace limen {
namespace {

/// Counts what was read of a file, over all its clouds.
class Reading {
 public:
  Reading(const OpenPoints& input, Monitor& monitor)
      : input_(input), monitor_(monitor), total_(static_cast<double>(input.points())) {
    monitor_.set_unit(WorkUnit::points);
  }
  void passed(std::size_t rows) {
    monitor_.throw_if_cancelled();
    done_ += static_cast<double>(rows);
    monitor_.advance(done_, std::max(done_, total_));
  }
  void forget() const { input_.forget(); }

 private:
  const OpenPoints& input_;
  Monitor& monitor_;
  double total_;
  double done_ = 0.0;
};

/// The file with one of its clouds as a scan; as it was where the cloud is empty.
ScanFile with_cloud(ScanFile file, const OpenPoints& input, std::size_t cloud, const ReadOptions& options,
                    Reading& reading) {
  const CloudFacts& facts = input.file().clouds()[cloud];
  std::unique_ptr<PointStream> stream = input.file().read(cloud);
  std::optional<RecordTable> piece = stream->next(kStreamRows);
  if (!piece) return file;
  ScanBuilder builder(facts.table, options);
  // A count is believed as far as a point takes a byte; what packs tighter grows in steps.
  builder.reserve(std::min<std::uint64_t>(facts.points, input.bytes().size()));
  for (; piece; piece = stream->next(kStreamRows)) {
    builder.add(*piece);
    reading.passed(piece->rows);
    reading.forget();
  }
  return builder.finish(std::move(file));
}

bool has(const std::set<std::string>& fields, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return fields.count(name) > 0; });
}

/// Bytes of one point of a scan with these values.
std::size_t bytes_per_point(const CloudFacts& facts) {
  std::set<std::string> fields;
  for (const std::string& field : facts.fields) fields.insert(lower_case(field));
  std::size_t bytes = sizeof(Vector3d);
  if (has(fields, {"x_origin"})) bytes += sizeof(Vector3d);
  if (has(fields, {"gps_time", "gpstime", "time", "timestamp", "t", "scalar_gps_time"}))
    bytes += sizeof(double);
  if (has(fields, {"intensity", "reflectance", "amplitude", "scalar_intensity"})) bytes += sizeof(float);
  if (has(fields, {"red", "r", "rgb", "rgba", "diffuse_red", "colorred"})) bytes += 3;
  const bool lines = has(fields, {"scan_line", "scanline", "column_index", "columnindex", "theta"});
  if (lines || facts.table.columns > 1 || facts.table.column_length > 1) bytes += 2 * sizeof(std::int32_t);
  return bytes;
}

/// A part of `memory` for one of the clouds of a file.
ThinOptions share_of(const OpenPoints& input, std::size_t cloud, std::uint64_t memory) {
  const CloudFacts& facts = input.file().clouds()[cloud];
  const double share =
      static_cast<double>(facts.points) / static_cast<double>(std::max<std::uint64_t>(1, input.points()));
  const double bytes = share * static_cast<double>(memory);
  ThinOptions thinning;
  thinning.most_points = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(bytes / static_cast<double>(bytes_per_point(facts)) / 2));
  thinning.memory_bytes = std::max<std::uint64_t>(1, memory / 2);
  return thinning;
}

void for_each_piece(const OpenPoints& input, std::size_t cloud, Reading& reading,
                    const std::function<void(const RecordTable&)>& take) {
  const std::unique_ptr<PointStream> stream = input.file().read(cloud);
  while (const std::optional<RecordTable> piece = stream->next(kStreamRows)) {
    take(*piece);
    reading.passed(piece->rows);
    reading.forget();
  }
}

/// Some usable rows of a cloud that comes in pieces: as dense everywhere as it was measured, by a factor.
/// They are drawn by lot, for rows may repeat in a rhythm.
class RowsByLot {
 public:
  explicit RowsByLot(std::uint64_t expected) : expected_(std::max(expected, kEnough)) {}

  void add(const RecordTable& piece) {
    rows_.require_columns(piece);
    for_drawn_steps(piece.rows, piece.rows * kEnough / expected_, [&](std::size_t row) {
      if (is_usable(piece, row)) rows_.append(piece, row);
    });
  }
  [[nodiscard]] bool empty() const { return rows_.size() == 0; }
  /// Points into this object.
  [[nodiscard]] RecordTable table() const { return rows_.view(); }

 private:
  static constexpr std::uint64_t kEnough = 200000;

  [[nodiscard]] static bool is_usable(const RecordTable& piece, std::size_t row) {
    for (const char* axis : {"x", "y", "z"}) {
      double value = 0.0;
      if (const Field* field = piece.find({axis})) load_numbers(piece, *field, {row, row + 1}, &value);
      if (!(std::abs(value) < kLargestCoordinateM)) return false;
    }
    return true;
  }

  PackedRows rows_;
  std::uint64_t expected_;
};

/// What a file says of a cloud still holds for some of its points, but not their order.
TableFacts without_order(TableFacts facts) {
  facts.columns = 0;
  facts.column_length = 0;
  return facts;
}

/// Scan lines cannot be distinguished from the angles of some of the points.
RecordTable without_angles(RecordTable table) {
  for (Field& field : table.fields) {
    if (field.name == "theta" || field.name == "scalar_theta") field.name = std::string(1, '_');
  }
  return table;
}

ScanFile begun(const OpenPoints& input) {
  ScanFile file;
  file.format = input.file().format();
  for (const CloudFacts& facts : input.file().clouds()) {
    if (file.fields.size() < facts.fields.size()) file.fields = facts.fields;
    file.notes.insert(file.notes.end(), facts.notes.begin(), facts.notes.end());
  }
  return file;
}

void require_scans(const ScanFile& file, const OpenPoints& input) {
  if (!file.scans.empty()) return;
  throw Error("there are no points", input.name(), "check how the file was exported");
}

}  // namespace

ScanFile read_clouds(const OpenPoints& input, const ReadOptions& options, Monitor& monitor) {
  ScanFile file = begun(input);
  Reading reading(input, monitor);
  for (std::size_t k = 0; k < input.file().clouds().size(); ++k) {
    const std::size_t before = file.scans.size();
    file = with_cloud(std::move(file), input, k, options, reading);
    if (file.scans.size() == before && input.file().clouds().size() > 1)
      file.notes.push_back(fmt::format("{} holds no points", input.file().clouds()[k].table.name));
  }
  require_scans(file, input);
  return file;
}

std::uint64_t scan_bytes(const OpenPoints& input) {
  std::uint64_t bytes = 0;
  for (const CloudFacts& facts : input.file().clouds()) bytes += facts.points * bytes_per_point(facts);
  return bytes;
}

ScanFile read_thinned(const OpenPoints& input, const ReadOptions& options, Monitor& monitor) {
  ScanFile file = begun(input);
  Reading reading(input, monitor);
  for (std::size_t k = 0; k < input.file().clouds().size(); ++k) {
    const CloudFacts& facts = input.file().clouds()[k];
    if (facts.points == 0) continue;
    CloudThinner thinner(share_of(input, k, options.memory_bytes), facts.points);
    RowsByLot as_measured(facts.points);
    for_each_piece(input, k, reading, [&](const RecordTable& piece) {
      thinner.add(piece);
      as_measured.add(piece);
    });
    const ThinnedCloud thinned = thinner.finish();
    file.notes.push_back(
        fmt::format("{}: thinned from {} points to {} to stay within the memory, spacing about {:.3f} m",
                    facts.table.name, thinned.read, thinned.table.rows, thinned.spacing_m));
    file.dropped += thinned.unusable;
    // A grid of returns has a place for those that are missing.
    if (input.format() != PointFormat::ptx) file.unusable += thinned.unusable;
    const TableFacts unordered = without_order(facts.table);
    ScanFile some;
    if (!as_measured.empty()) some = with_scan({}, without_angles(as_measured.table()), unordered, options);
    file = with_scan(std::move(file), without_angles(thinned.table), unordered, options,
                     some.scans.empty() ? nullptr : &some.scans.front());
    file.scans.back().topology = {};
  }
  require_scans(file, input);
  return file;
}

std::optional<Vector3d> settled_centre(const OpenPoints& input, std::size_t cloud, Monitor& monitor) {
  const CloudFacts& facts = input.file().clouds()[cloud];
  if (facts.table.centre_unknown) return {};
  if (facts.table.centre) return facts.table.offset + *facts.table.centre;
  Reading reading(input, monitor);
  RowsByLot some(facts.points);
  for_each_piece(input, cloud, reading, [&](const RecordTable& piece) { some.add(piece); });
  if (some.empty()) return {};
  const ScanFile file = with_scan({}, without_angles(some.table()), without_order(facts.table), {});
  const Scan& scan = file.scans.front();
  if (!scan.centre_known() || scan.mobile()) return {};
  return scan.local_origin + scan.centres[0];
}

}  // namespace limen
