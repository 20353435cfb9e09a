// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/join_scans.h"

#include <algorithm>
#include <cstddef>

namespace limen {
namespace {

template <typename Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append_shifted(std::vector<Vector3d>& all, const std::vector<Vector3d>& more, const Vector3d& shift) {
  for (const Vector3d& x : more) all.emplace_back(x + shift);
}

/// Appends a topology with its lines numbered after those that are there, one apart: no neighbours.
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

}  // namespace limen
