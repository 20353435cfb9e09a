// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/laid_scan.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "limen/base/parallel.h"
#include "limen/extract/cells/morton_order.h"

namespace limen {
namespace {

constexpr double kOrderM = 0.00125;
constexpr std::size_t kLaidPerPiece = 65536;
constexpr std::size_t kMostOfCube = 64;  // points kept of one cube, at most
constexpr std::uint32_t kCoarsest = 12;  // 5 m

/// Points in one cube of the curve's order are sorted by their coordinates.
void settle_ties(std::vector<CurvePlace>& sorted, const std::vector<Vector3d>& points) {
  const auto before = [&](const CurvePlace& a, const CurvePlace& b) {
    const Vector3d& p = points[a.index];
    const Vector3d& q = points[b.index];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[end].code == sorted[begin].code) ++end;
    if (end - begin > 1)
      std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                       sorted.begin() + static_cast<std::ptrdiff_t>(end), before);
    begin = end;
  }
}

/// Calls use(begin, end) for each run of places that lie in one cube of a level.
template <typename Use>
void for_each_cube(const std::vector<CurvePlace>& sorted, std::uint32_t level, const Use& use) {
  for (std::size_t begin = 0; begin < sorted.size();) {
    const std::uint64_t cube = sorted[begin].code >> (3 * level);
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[end].code >> (3 * level) == cube) ++end;
    use(begin, end);
    begin = end;
  }
}

/// The finest cubes of which there are no more than `most`.
std::uint32_t level_for(const std::vector<CurvePlace>& sorted, std::size_t most) {
  std::array<std::size_t, kCoarsest + 1> cubes{};
  cubes.fill(1);
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const std::uint64_t differ = sorted[k].code ^ sorted[k - 1].code;
    for (std::uint32_t level = 0; level <= kCoarsest && differ >> (3 * level) != 0; ++level) ++cubes[level];
  }
  std::uint32_t level = 0;
  while (level < kCoarsest && cubes[level] > most) ++level;
  return level;
}

/// How many points each cube of the level may keep so that there are no more than `most`.
std::size_t share_for(const std::vector<CurvePlace>& sorted, std::uint32_t level, std::size_t most) {
  std::array<std::size_t, kMostOfCube + 1> at_least{};  // cubes with so many points or more
  for_each_cube(sorted, level, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 1; k <= std::min(kMostOfCube, end - begin); ++k) ++at_least[k];
  });
  std::size_t share = 1;
  std::size_t kept = at_least[1];
  while (share < kMostOfCube && kept + at_least[share + 1] <= most) kept += at_least[++share];
  return share;
}

/// Of each cube the same number of points at most, evenly along the curve.
std::vector<CurvePlace> thinned(const std::vector<CurvePlace>& sorted, std::size_t most) {
  const std::uint32_t level = level_for(sorted, most);
  const std::size_t share = share_for(sorted, level, most);
  std::vector<CurvePlace> kept;
  kept.reserve(most);
  for_each_cube(sorted, level, [&](std::size_t begin, std::size_t end) {
    const std::size_t size = end - begin;
    const std::size_t few = std::min(share, size);
    for (std::size_t k = 0; k < few; ++k) kept.push_back(sorted[begin + (2 * k + 1) * size / (2 * few)]);
  });
  return kept;
}

}  // namespace

Scan laid_in(const Scan& scan, const ScanFrame& frame, std::size_t most, bool lines) {
  const auto placed = [&](const Vector3d& x) { return Vector3d(frame.frame_from_scan * (x - frame.corner)); };
  std::vector<Vector3d> points(scan.size());
  parallel_for(scan.size(), kLaidPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = placed(scan.points[i]);
  });
  std::vector<CurvePlace> sorted = along_curve(points, kOrderM).places;
  settle_ties(sorted, points);
  if (most > 0 && sorted.size() > most) sorted = thinned(sorted, most);
  Scan laid;
  laid.name = scan.name;
  laid.local_origin = scan.local_origin + frame.corner;
  laid.level = frame.upright;
  laid.centre_source = frame.place.source;
  laid.points.resize(sorted.size());
  parallel_for(sorted.size(), kLaidPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) laid.points[k] = points[sorted[k].index];
  });
  if (scan.mobile()) {
    laid.centres.resize(sorted.size());
    laid.times_s.resize(scan.times_s.empty() ? 0 : sorted.size());
    parallel_for(sorted.size(), kLaidPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        laid.centres[k] = placed(scan.centres[sorted[k].index]);
        if (!laid.times_s.empty()) laid.times_s[k] = scan.times_s[sorted[k].index];
      }
    });
  } else if (frame.place.source != PlaceSource::unknown) {
    laid.centres = {placed(frame.place.centre)};
  }
  if (lines && scan.topology.known()) {
    laid.topology.line.reserve(sorted.size());
    laid.topology.index.reserve(sorted.size());
    for (const CurvePlace& place : sorted) {
      laid.topology.line.push_back(scan.topology.line[place.index]);
      laid.topology.index.push_back(scan.topology.index[place.index]);
    }
  }
  return laid;
}

}  // namespace limen
