// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/point_sample.h"

#include <algorithm>

namespace limen {
namespace {

constexpr std::size_t kSampled = 64;
/// Formats round to half a millimetre per axis, or less.
constexpr double kSamePointM = 1e-3;

bool stands_left_of(const Vector3d& point, double x) {
  return point.x() < x;
}

}  // namespace

PointSample::PointSample(const Scan& scan) : points_(scan.size()) {
  const std::size_t count = std::min(points_, kSampled);
  for (std::size_t k = 0; k < count; ++k)
    some_.push_back(scan.local_origin + scan.points[k * points_ / count]);
  std::sort(some_.begin(), some_.end(), [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); });
}

double PointSample::share_in(const Scan& scan) const {
  if (some_.empty()) return 0.0;
  std::vector<char> met(some_.size(), 0);
  std::size_t left = some_.size();
  for (std::size_t i = 0; i < scan.size() && left > 0; ++i) {
    const Vector3d place = scan.local_origin + scan.points[i];
    auto at = std::lower_bound(some_.begin(), some_.end(), place.x() - kSamePointM, stands_left_of);
    for (; at != some_.end() && at->x() <= place.x() + kSamePointM; ++at) {
      char& seen = met[static_cast<std::size_t>(at - some_.begin())];
      if (seen != 0 || (*at - place).norm() > kSamePointM) continue;
      seen = 1;
      --left;
    }
  }
  return 1.0 - static_cast<double>(left) / static_cast<double>(some_.size());
}

}  // namespace limen
