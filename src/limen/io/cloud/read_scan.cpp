// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/read_scan.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"
#include "limen/base/length_unit.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/read_cloud.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/ptx/ptx.h"
#include "limen/io/text/text.h"
#include "limen/io/trajectory/trajectory.h"

namespace limen {
namespace {

template <typename Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append_shifted(std::vector<Vector3d>& all, const std::vector<Vector3d>& more, const Vector3d& shift) {
  for (const Vector3d& x : more) all.emplace_back(x + shift);
}

/// Appends a topology with its lines numbered after those that are there, with a gap of one: no neighbours.
void append(ScanTopology& all, const ScanTopology& more) {
  const auto last = std::max_element(all.line.begin(), all.line.end());
  const std::int32_t after = last == all.line.end() ? 0 : *last + 2;
  const std::int32_t first = *std::min_element(more.line.begin(), more.line.end());
  for (const std::int32_t line : more.line) all.line.push_back(line - first + after);
  append(all.index, more.index);
}

template <typename Test>
bool all_of(const std::vector<Scan>& scans, const Test& test) {
  return std::all_of(scans.begin(), scans.end(), test);
}

}  // namespace

Scan join_scans(const std::vector<Scan>& scans) {
  Scan joined;
  joined.name = scans.front().name;
  joined.local_origin = scans.front().local_origin;
  joined.level = all_of(scans, [](const Scan& scan) { return scan.level; });
  const bool centres = all_of(scans, [](const Scan& scan) { return scan.centre_known(); });
  const bool topology = all_of(scans, [](const Scan& scan) { return scan.topology.known(); });
  const bool times = all_of(scans, [](const Scan& scan) { return !scan.times_s.empty(); });
  const bool intensities = all_of(scans, [](const Scan& scan) { return !scan.intensities.empty(); });
  const bool colours = all_of(scans, [](const Scan& scan) { return !scan.colours.empty(); });
  for (const Scan& scan : scans) {
    const Vector3d shift = scan.local_origin - joined.local_origin;
    append_shifted(joined.points, scan.points, shift);
    if (centres) {
      for (std::size_t i = 0; i < scan.size(); ++i) joined.centres.emplace_back(scan.centre(i) + shift);
    }
    if (topology) append(joined.topology, scan.topology);
    if (times) append(joined.times_s, scan.times_s);
    if (intensities) append(joined.intensities, scan.intensities);
    if (colours) append(joined.colours, scan.colours);
  }
  return joined;
}

namespace {

/// Formats that are small enough to be read from memory at once, by their own readers.
ScanFile read_at_once(const OpenPoints& input, const ReadOptions& options, Monitor& monitor) {
  if (input.chosen()) return read_clouds(input, options, monitor);
  switch (input.format()) {
    case PointFormat::pcd:
      return read_pcd(input.bytes(), input.name(), options);
    case PointFormat::ptx:
      return read_ptx(input.bytes(), input.name(), options);
    case PointFormat::text:
      return read_xyz(input.bytes(), input.name(), options);
    case PointFormat::e57:
    case PointFormat::las:
    case PointFormat::ply:
      break;
  }
  return read_clouds(input, options, monitor);
}

/// The scans with the scanner positions that the trajectory gives.
ScanFile followed(ScanFile file, const Trajectory& trajectory) {
  for (Scan& scan : file.scans) {
    FollowedScan with = with_trajectory(scan, trajectory);
    if (with.left_out > 0) {
      file.notes.push_back(
          fmt::format("{} points at times that the trajectory does not cover are left out", with.left_out));
    }
    file.dropped += with.left_out;
    scan = std::move(with.scan);
  }
  return file;
}

/// Reads what `open` opens.
template <typename Open>
ScanFile read_opened(const Open& open, const ReadOptions& options, Monitor& monitor) {
  options.check();
  monitor.throw_if_cancelled();
  const CancelScope scope(monitor);
  const OpenPoints input = open();
  ScanFile read = with_whole_inputs([&] {
    const bool large = options.memory_bytes > 0 && scan_bytes(input) > options.memory_bytes;
    return large ? read_thinned(input, options, monitor) : read_at_once(input, options, monitor);
  });
  monitor.throw_if_cancelled();
  if (std::string note = unusable_note(read); !note.empty()) read.notes.push_back(std::move(note));
  if (options.trajectory && !options.origin) return followed(std::move(read), *options.trajectory);
  return read;
}

}  // namespace

std::string unusable_note(std::size_t unusable, std::size_t kept) {
  if (unusable == 0) return {};
  return fmt::format(
      "{} points have no finite coordinates below 100 000 km, or are 0 0 0 far from all others, and are left "
      "out; {} are kept",
      unusable, kept);
}

std::string unusable_note(const ScanFile& file) {
  std::size_t kept = 0;
  for (const Scan& scan : file.scans) kept += scan.size();
  return unusable_note(file.unusable, kept);
}

void ReadOptions::check() const {
  if (metres_per_unit && !(*metres_per_unit > 0 && *metres_per_unit < 1e6))
    throw_bad_option("metres_per_unit", *metres_per_unit, "within (0, 1e6)");
  if (!origin) return;
  for (int k = 0; k < 3; ++k) {
    const double value = (*origin)[k];
    if (!(value > -1e8 && value < 1e8)) throw_bad_option("origin", value, "a finite coordinate in metres");
  }
}

ScanFile read_scan_file(const std::filesystem::path& path, const ReadOptions& options, Monitor& monitor) {
  return read_opened([&] { return OpenPoints(path); }, options, monitor);
}

Scan read_one_scan(const std::filesystem::path& path, std::size_t index, const ReadOptions& options,
                   Monitor& monitor) {
  // One that is named by its number is the only one of its name.
  const bool named = index == 0 && scan_in_file(path.string()).index;
  const auto open = [&] { return named ? OpenPoints(path) : OpenPoints(path, index); };
  return std::move(read_opened(open, options, monitor).scans.front());
}

std::vector<Scan> read_scans(const std::filesystem::path& path, const ReadOptions& options,
                             Monitor& monitor) {
  return read_scan_file(path, options, monitor).scans;
}

Scan read_scan(const std::filesystem::path& path, const ReadOptions& options, Monitor& monitor) {
  std::vector<Scan> scans = read_scans(path, options, monitor);
  if (scans.size() == 1) return std::move(scans.front());
  Scan joined = join_scans(scans);
  joined.name = path.string();
  return joined;
}

std::string unit_remark(double metres_per_unit) {
  if (metres_per_unit == 1.0) return {};
  return fmt::format("the file says that 1 unit of its numbers is {:.7g} m ({})", metres_per_unit,
                     unit_name(metres_per_unit));
}

std::string offset_remark(const Vector3d& offset_applied) {
  if (offset_applied.isZero(0.0)) return {};
  return fmt::format(
      "the offset {:.10g} {:.10g} {:.10g} m given in a comment of the file is added to its points",
      offset_applied.x(), offset_applied.y(), offset_applied.z());
}

}  // namespace limen
