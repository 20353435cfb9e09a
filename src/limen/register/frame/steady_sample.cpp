// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/steady_sample.h"

#include <algorithm>
#include <numeric>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::size_t kSampledPerPiece = 65536;
/// Wanted of those chosen, so that six cut a cube of 0.32 m (frame_planes.cpp): of fewer, circles are left.
constexpr double kShellsPerM = 20.0;
/// Chosen points are sorted within shells of 1 mm; farther out than 33 m all at once.
constexpr double kSortedM = 1e-3;
constexpr std::uint64_t kNearShells = 32768;
constexpr std::size_t kShellsPerPiece = 512;
/// The middle is rounded to this: the order of summation must not show.
constexpr double kMiddleM = 1e-7;

Vector3d middle_of(const std::vector<Vector3d>& points) {
  const Vector3d sum = parallel_reduce(
      points.size(), kSampledPerPiece, Vector3d(Vector3d::Zero()),
      [&](std::size_t begin, std::size_t end) {
        Vector3d part = Vector3d::Zero();
        for (std::size_t i = begin; i < end; ++i) part += points[i];
        return part;
      },
      [](const Vector3d& a, const Vector3d& b) { return Vector3d(a + b); });
  const Vector3d mean = sum / static_cast<double>(std::max<std::size_t>(1, points.size()));
  return ((mean / kMiddleM).array().round() * kMiddleM).matrix();
}

/// A point by how far it lies from the middle.
struct Ranged {
  double range_m;
  std::uint32_t index;
};

std::uint64_t shell_of(double range_m, double shell_m) {
  return static_cast<std::uint64_t>(std::min(1e15, range_m / shell_m));
}

std::vector<Ranged> chosen_points(const std::vector<Vector3d>& points, const Vector3d& middle,
                                  std::size_t most, double most_shell_m) {
  const bool all = points.size() <= most;
  const double share = std::min(1.0, static_cast<double>(most) / static_cast<double>(points.size() + 1));
  double shell_m = most_shell_m;  // halved, so that a few points more or less change nothing
  while (shell_m > kThinShellM && share < kShellsPerM * shell_m) shell_m *= 0.5;
  std::vector<std::vector<Ranged>> parts((points.size() + kSampledPerPiece - 1) / kSampledPerPiece);
  parallel_for(points.size(), kSampledPerPiece, [&](std::size_t begin, std::size_t end) {
    std::vector<Ranged>& part = parts[begin / kSampledPerPiece];
    for (std::size_t i = begin; i < end; ++i) {
      const double range_m = (points[i] - middle).norm();
      if (all || unit_lot(mix64(shell_of(range_m, shell_m) + 1)) < share)
        part.push_back({range_m, static_cast<std::uint32_t>(i)});
    }
  });
  std::vector<Ranged> chosen;
  for (const std::vector<Ranged>& part : parts) chosen.insert(chosen.end(), part.begin(), part.end());
  return chosen;
}

/// Nearest first, points equally far by their coordinates. Shells are sorted each for itself.
std::vector<Ranged> sorted_outwards(const std::vector<Ranged>& chosen, const std::vector<Vector3d>& points) {
  const auto bucket = [](const Ranged& point) {
    return std::min(shell_of(point.range_m, kSortedM), kNearShells);
  };
  std::vector<std::size_t> ends(kNearShells + 2, 0);  // shifted by one: where each shell begins
  for (const Ranged& point : chosen) ++ends[bucket(point) + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Ranged> sorted(chosen.size());
  for (const Ranged& point : chosen) sorted[ends[bucket(point)]++] = point;
  const auto nearer = [&](const Ranged& a, const Ranged& b) {
    if (a.range_m != b.range_m) return a.range_m < b.range_m;
    const Vector3d& p = points[a.index];
    const Vector3d& q = points[b.index];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  // `ends` holds where each shell ends by now.
  parallel_for(ends.size(), kShellsPerPiece, [&](std::size_t first, std::size_t last) {
    for (std::size_t shell = first; shell < last; ++shell) {
      const std::size_t begin = shell == 0 ? 0 : ends[shell - 1];
      if (ends[shell] > begin + 1)
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                  sorted.begin() + static_cast<std::ptrdiff_t>(ends[shell]), nearer);
    }
  });
  return sorted;
}

}  // namespace

std::vector<std::uint32_t> steady_sample(const Scan& scan, std::size_t most, double shell_m) {
  const std::vector<Ranged> sorted =
      sorted_outwards(chosen_points(scan.points, middle_of(scan.points), most, shell_m), scan.points);
  std::vector<std::uint32_t> indices;
  indices.reserve(sorted.size());
  for (const Ranged& point : sorted) indices.push_back(point.index);
  return indices;
}

}  // namespace limen
