// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/transform_cloud.h"

#include <utility>

#include <fmt/format.h>

#include "limen/io/join_scans.h"
#include "limen/io/mapped_file.h"
#include "limen/io/read_ply.h"
#include "limen/io/scan_builder.h"
#include "limen/io/transform_ply.h"
#include "limen/io/write_ply.h"

namespace limen {

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
  const Scan joined = read.scans.size() == 1 ? std::move(read.scans.front()) : join_scans(read.scans);
  result.points = joined.size();
  write_ply(output, transformed(joined, target_from_source));
  return result;
}

}  // namespace limen
