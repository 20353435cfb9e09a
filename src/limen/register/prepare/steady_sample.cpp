// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/steady_sample.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::size_t kSampledPerPiece = 65536;
/// Spherical shells this thick are chosen or left out as a whole: thin, so that every surface has its share;
/// thick against the rounding of 32-bit coordinates.
constexpr double kShellM = 1e-3;
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

}  // namespace

std::vector<std::uint32_t> steady_sample(const Scan& scan, std::size_t most) {
  const Vector3d middle = middle_of(scan.points);
  const double share = std::min(1.0, static_cast<double>(most) / static_cast<double>(scan.size() + 1));
  const auto bound = static_cast<std::uint64_t>(share * 18446744073709549568.0);
  std::vector<std::pair<double, std::uint32_t>> chosen;
  for (std::uint32_t i = 0; i < scan.size(); ++i) {
    const double range = (scan.points[i] - middle).norm();
    const auto shell = static_cast<std::uint64_t>(std::min(1e15, range / kShellM));
    if (scan.size() <= most || mix64(shell + 1) < bound) chosen.emplace_back(range, i);
  }
  std::sort(chosen.begin(), chosen.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const Vector3d& p = scan.points[a.second];
    const Vector3d& q = scan.points[b.second];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  });
  std::vector<std::uint32_t> indices;
  indices.reserve(chosen.size());
  for (const auto& [range, index] : chosen) indices.push_back(index);
  return indices;
}

}  // namespace limen
