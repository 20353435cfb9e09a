// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/msac_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "limen/base/parallel.h"
#include "limen/consensus/msac.h"
#include "limen/extract/cells/morton_order.h"
#include "limen/extract/planes/plane_labels.h"

namespace limen {
namespace {

constexpr double kSampleCubeM = 0.5;       // size of the cube that a sample is drawn from
constexpr double kConfidence = 0.99;       // of having hit the largest plane left
constexpr std::size_t kMostTrials = 2000;  // per plane
constexpr std::size_t kJudges = 10000;     // points, evenly chosen, that score a sample
constexpr std::size_t kPointsPerVote = 65536;
constexpr int kFits = 3;         // of a plane to its inliers
constexpr int kMaxFailures = 3;  // samplings in a row without a plane that is large enough

/// Planes through three of the points that belong to none yet. Items are places in `free`.
struct PlaneEstimator {
  using Model = Plane;
  static constexpr std::size_t kSampleSize = 3;
  const MortonOrder& sorted;
  const std::vector<std::uint32_t>& free;

  [[nodiscard]] std::size_t size() const { return free.size(); }
  [[nodiscard]] Vector3d at(std::uint32_t item) const { return sorted.point(free[item]); }
  [[nodiscard]] std::optional<Plane> estimate(const std::array<std::uint32_t, 3>& sample) const {
    const Vector3d ab = at(sample[1]) - at(sample[0]);
    const Vector3d ac = at(sample[2]) - at(sample[0]);
    const Vector3d normal = ab.cross(ac);
    // A triangle flatter than a hundredth fixes no plane.
    if (!(normal.norm() > 0.01 * std::max({ab.squaredNorm(), ac.squaredNorm(), 1e-12}))) return std::nullopt;
    const Vector3d unit = normal.normalized();
    return Plane{unit, unit.dot(at(sample[0]))};
  }
  [[nodiscard]] double residual(const Plane& plane, std::uint32_t item) const {
    return std::abs(plane.signed_distance(at(item)));
  }
};

/// Draws a point, and two more from the same cube of a grid: along the Morton curve a cube is one run.
class CubeSampler {
 public:
  /// `codes[i]`: cube of item i, ascending.
  CubeSampler(std::vector<std::uint64_t> codes, std::uint64_t seed)
      : codes_(std::move(codes)), whole_(codes_.size(), seed), seed_(seed) {}

  template <std::size_t kCount>
  [[nodiscard]] std::array<std::uint32_t, kCount> sample(std::uint64_t trial) const {
    std::array<std::uint32_t, kCount> chosen = whole_.sample<kCount>(trial);
    const auto run = std::equal_range(codes_.begin(), codes_.end(), codes_[chosen[0]]);
    const auto first = static_cast<std::uint32_t>(run.first - codes_.begin());
    const auto size = static_cast<std::uint32_t>(run.second - run.first);
    RandomStream random(~seed_, trial);
    for (std::size_t k = 1; k < kCount; ++k) chosen[k] = first + random.below(size);
    return chosen;
  }

 private:
  std::vector<std::uint64_t> codes_;
  UniformSampler whole_;
  std::uint64_t seed_;
};

class MsacDetector {
 public:
  MsacDetector(const Scan& scan, const MsacPlaneOptions& options)
      : options_(options),
        sorted_(morton_order(scan.points, kSampleCubeM)),
        labels_(scan.size(), -1),
        free_(scan.size()) {
    std::iota(free_.begin(), free_.end(), 0U);
  }

  PlaneLabels run(Monitor& monitor) {
    int failures = 0;
    for (std::uint64_t round = 0; failures < kMaxFailures && free_.size() >= wanted(); ++round) {
      monitor.throw_if_cancelled();
      const std::optional<Plane> plane = best_plane(round);
      failures = plane && take(*plane) ? 0 : failures + 1;
      monitor.advance(static_cast<double>(labels_.size() - free_.size()),
                      static_cast<double>(labels_.size()));
    }
    return finish();
  }

 private:
  [[nodiscard]] std::size_t wanted() const { return static_cast<std::size_t>(options_.min_inliers); }

  [[nodiscard]] std::optional<Plane> best_plane(std::uint64_t round) const {
    const PlaneEstimator estimator{sorted_, free_};
    const MsacOptions options{options_.inlier_threshold_m, kConfidence, kMostTrials, kJudges};
    const std::uint64_t seed = mix64(options_.seed) + round;
    std::vector<std::uint64_t> codes;
    codes.reserve(free_.size());
    for (const std::uint32_t position : free_) codes.push_back(sorted_.codes[position]);
    return msac(estimator, CubeSampler(std::move(codes), seed), options).model;
  }

  [[nodiscard]] bool inlier(const Plane& plane, std::uint32_t position) const {
    return std::abs(plane.signed_distance(sorted_.point(position))) <= options_.inlier_threshold_m;
  }

  [[nodiscard]] PointMoments inliers_of(const Plane& plane) const {
    return parallel_reduce(
        free_.size(), kPointsPerVote, PointMoments{},
        [&](std::size_t begin, std::size_t end) {
          PointMoments sum;
          for (std::size_t k = begin; k < end; ++k) {
            if (inlier(plane, free_[k])) sum.add(sorted_.point(free_[k]));
          }
          return sum;
        },
        [](PointMoments a, const PointMoments& b) { return a += b; });
  }

  [[nodiscard]] bool is_wide(const PointMoments& moments) const {
    return std::sqrt(fit_plane(moments).variances[1]) > options_.inlier_threshold_m;
  }

  /// Refits the plane and gives it its points; false where they are too few.
  bool take(Plane plane) {
    PointMoments moments = inliers_of(plane);
    for (int k = 0; k < kFits; ++k) {
      if (moments.count < options_.min_inliers) return false;
      plane = fit_plane(moments).plane;
      moments = inliers_of(plane);
    }
    // Inliers all on one line make no plane.
    if (moments.count < options_.min_inliers || !is_wide(moments)) return false;
    const auto label = static_cast<std::int32_t>(found_.size());
    std::erase_if(free_, [&](std::uint32_t position) {
      if (!inlier(plane, position)) return false;
      labels_[position] = label;
      return true;
    });
    found_.push_back(moments);
    return true;
  }

  [[nodiscard]] PlaneLabels finish() const {
    PlaneLabels result = planes_by_scan(sorted_, labels_, found_);
    result.inlier_threshold_m = options_.inlier_threshold_m;
    return result;
  }

  MsacPlaneOptions options_;
  MortonOrder sorted_;
  std::vector<std::int32_t> labels_;  ///< by position along the curve
  std::vector<std::uint32_t> free_;   ///< positions in no plane, ascending
  std::vector<PointMoments> found_;   ///< about the curve's anchor
};

}  // namespace

PlaneLabels msac_planes(const Scan& scan, const MsacPlaneOptions& options, Monitor& monitor) {
  if (scan.size() == 0) return {};
  return MsacDetector(scan, options).run(monitor);
}

}  // namespace limen
