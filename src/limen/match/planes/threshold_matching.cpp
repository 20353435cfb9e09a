// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/planes/threshold_matching.h"

#include <algorithm>

#include "limen/base/angles.h"
#include "limen/match/planes/polygon_distance.h"

namespace limen {
namespace {

constexpr double kMatchedPlanesRad = radians(5.0);
constexpr double kMatchedPlanesM = 0.2;  // of equation 7
constexpr double kMatchedShare = 0.3;    // of equation 8

/// At most one partner for each polygon, larger overlaps first.
std::vector<ThresholdMatch> exclusive(const std::vector<ThresholdMatch>& matches, std::size_t sources,
                                      std::size_t targets) {
  std::vector<char> source_taken(sources, 0);
  std::vector<char> target_taken(targets, 0);
  std::vector<ThresholdMatch> kept;
  for (const ThresholdMatch& match : matches) {
    char& source = source_taken[static_cast<std::size_t>(match.source)];
    char& target = target_taken[static_cast<std::size_t>(match.target)];
    if (source != 0 || target != 0) continue;
    source = target = 1;
    kept.push_back(match);
  }
  return kept;
}

}  // namespace

std::vector<ThresholdMatch> match_by_thresholds(const std::vector<PlanarPolygon>& source,
                                                const std::vector<PlanarPolygon>& target,
                                                const Rigid3& start_target_from_source) {
  std::vector<ThresholdMatch> matches;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const PlanarPolygon moved = transformed(start_target_from_source, source[i]);
    for (std::size_t j = 0; j < target.size(); ++j) {
      ThresholdMatch match{static_cast<int>(i), static_cast<int>(j)};
      match.angle_rad = angle_between(moved.plane, target[j].plane);
      if (match.angle_rad > kMatchedPlanesRad) continue;
      match.distance_m = bisector_distance(moved, target[j]);
      if (match.distance_m > kMatchedPlanesM) continue;
      match.overlap = overlap_ratio(moved, target[j]);
      if (match.overlap < kMatchedShare) continue;
      match.overlap_m2 = overlap_area(moved, target[j]);
      matches.push_back(match);
    }
  }
  std::stable_sort(matches.begin(), matches.end(), [](const ThresholdMatch& a, const ThresholdMatch& b) {
    return a.overlap_m2 > b.overlap_m2;
  });
  return exclusive(matches, source.size(), target.size());
}

}  // namespace limen
