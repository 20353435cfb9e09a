// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/plane_labels.h"

#include <algorithm>
#include <array>

#include "limen/base/parallel.h"

namespace limen {

std::vector<std::vector<std::uint32_t>> points_of(const std::vector<std::int32_t>& labels,
                                                  std::size_t planes) {
  std::vector<std::size_t> counts(planes, 0);
  for (const std::int32_t label : labels) {
    if (label >= 0) ++counts[static_cast<std::size_t>(label)];
  }
  std::vector<std::vector<std::uint32_t>> points(planes);
  for (std::size_t k = 0; k < points.size(); ++k) points[k].reserve(counts[k]);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] >= 0) points[static_cast<std::size_t>(labels[i])].push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

namespace {

constexpr std::size_t kPointsPerSum = 131072;
constexpr std::size_t kPointsPerLabelling = 131072;

/// Moments of the points of a plane, each product once.
class LabelSums {
 public:
  void add(const Vector3d& p) {
    const std::array<double, 10> of_point{1.0,         p[0],        p[1],        p[2],        p[0] * p[0],
                                          p[0] * p[1], p[0] * p[2], p[1] * p[1], p[1] * p[2], p[2] * p[2]};
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += of_point[i];
  }
  void add(const LabelSums& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
  }
  [[nodiscard]] PointMoments moments() const {
    const std::array<double, 10>& s = sums_;
    PointMoments moments;
    moments.count = s[0];
    moments.sum = {s[1], s[2], s[3]};
    moments.outer << s[4], s[5], s[6], s[5], s[7], s[8], s[6], s[8], s[9];
    return moments;
  }

 private:
  std::array<double, 10> sums_{};  // 1, x, y, z, xx, xy, xz, yy, yz, zz
};

}  // namespace

std::vector<PointMoments> label_sums(const MortonOrder& order, const std::vector<std::int32_t>& labels,
                                     std::size_t planes) {
  using Sums = std::vector<LabelSums>;
  const Sums sums = parallel_reduce(
      labels.size(), kPointsPerSum, Sums(planes),
      [&](std::size_t begin, std::size_t end) {
        Sums part(planes);
        for (std::size_t k = begin; k < end; ++k) {
          if (labels[k] >= 0) part[static_cast<std::size_t>(labels[k])].add(order.point(k));
        }
        return part;
      },
      [](Sums a, const Sums& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i].add(b[i]);
        return a;
      });
  std::vector<PointMoments> moments(planes);
  std::transform(sums.begin(), sums.end(), moments.begin(),
                 [](const LabelSums& sum) { return sum.moments(); });
  return moments;
}

PlaneLabels planes_by_scan(const MortonOrder& order, const std::vector<std::int32_t>& labels,
                           const std::vector<PointMoments>& sums, double least) {
  std::vector<std::size_t> kept;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (sums[p].count >= least) kept.push_back(p);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return sums[a].count > sums[b].count; });
  PlaneLabels planes;
  std::vector<std::int32_t> number(sums.size(), -1);
  for (const std::size_t p : kept) {
    number[p] = static_cast<std::int32_t>(planes.fits.size());
    PlaneFit fit = fit_plane(sums[p]);
    fit.plane = shifted(fit.plane, -order.anchor);
    fit.centroid += order.anchor;
    planes.fits.push_back(fit);
  }
  planes.labels.assign(labels.size(), -1);
  parallel_for(labels.size(), kPointsPerLabelling, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (labels[k] >= 0) planes.labels[order.index(k)] = number[static_cast<std::size_t>(labels[k])];
    }
  });
  return planes;
}

}  // namespace limen
