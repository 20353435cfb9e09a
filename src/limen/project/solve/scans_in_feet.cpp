// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/scans_in_feet.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include "limen/base/ranked.h"
#include "limen/project/solve/word_terms.h"

namespace limen {
namespace {

constexpr double kFeetInAMetre = 1.0 / 0.3048;
constexpr double kAlike = 0.12;         // share by which the heights of tripods differ
constexpr std::size_t kLeastScans = 3;  // that a height is taken from

std::optional<double> height_of_scanner(const ScanDigest& digest) {
  const std::optional<Vector3d> scanner = digest.scanner();
  const int floor = floor_of(digest);
  if (!scanner || floor < 0) return std::nullopt;
  const PlaneDigest& plane = digest.planes[static_cast<std::size_t>(floor)];
  return std::abs(plane.plane.signed_distance(*scanner));
}

}  // namespace

std::vector<std::size_t> scans_in_feet(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved) {
  std::vector<double> placed;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!is_placed(solved.nodes[n].state)) continue;
    if (const std::optional<double> height = height_of_scanner(nodes[n].digest)) placed.push_back(*height);
  }
  if (placed.size() < kLeastScans) return {};
  const double feet = kFeetInAMetre * median(placed);
  std::vector<std::size_t> odd;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (is_placed(solved.nodes[n].state)) continue;
    const std::optional<double> height = height_of_scanner(nodes[n].digest);
    if (height && std::abs(*height - feet) < kAlike * feet) odd.push_back(n);
  }
  return odd;
}

}  // namespace limen
