// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/transform_cloud.h"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "limen/io/join_scans.h"
#include "limen/io/mapped_file.h"
#include "limen/io/read_ply.h"
#include "limen/io/record_table.h"
#include "limen/io/scan_builder.h"
#include "limen/io/transform_ply.h"
#include "limen/io/write_ply.h"

namespace limen {
namespace {

/// Names of the values per point that a Scan has no place for.
std::string values_left_out(const std::vector<std::string>& fields) {
  static const std::set<std::string> kKept{"x",         "y",           "z",         "x_origin",  "y_origin",
                                           "z_origin",  "gps_time",    "gpstime",   "time",      "t",
                                           "red",       "green",       "blue",      "r",         "g",
                                           "b",         "rgb",         "rgba",      "scan_line", "scan_index",
                                           "intensity", "reflectance", "timestamp", "amplitude", "_"};
  std::string names;
  for (const std::string& field : fields) {
    if (kKept.count(lower_case(field)) == 0) names += (names.empty() ? "" : ", ") + field;
  }
  return names;
}

}  // namespace

Scan transformed(const Scan& scan, const Rigid3& target_from_source) {
  Scan moved = scan;
  if (scan.points.empty()) return moved;
  moved.local_origin = round_origin_near(target_from_source * (scan.local_origin + scan.points.front()));
  const Rigid3 local = to_local(target_from_source, scan.local_origin, moved.local_origin);
  for (Vector3d& point : moved.points) point = local * point;
  for (Vector3d& centre : moved.centres) centre = local * centre;
  return moved;
}

TransformedCloud transform_cloud(const std::filesystem::path& input, const Rigid3& target_from_source,
                                 const std::filesystem::path& output, const ReadOptions& options,
                                 Monitor& monitor) {
  monitor.begin_stage("transform");
  const MappedFile file(input);
  if (looks_like_ply(file.bytes())) {
    return transform_ply({file.bytes(), input.string()}, target_from_source, output, options);
  }
  ScanFile read = read_scan_file(input, options, monitor);
  TransformedCloud result;
  result.format = read.format;
  if (read.dropped > 0)
    result.notes.push_back(fmt::format("{} rows that are no points are left out", read.dropped));
  const std::string lost = values_left_out(read.fields);
  if (!lost.empty()) result.notes.push_back("these values per point are not kept: " + lost);
  const Scan joined = read.scans.size() == 1 ? std::move(read.scans.front()) : join_scans(read.scans);
  result.points = joined.size();
  write_ply(output, transformed(joined, target_from_source));
  return result;
}

}  // namespace limen
