// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <vector>

#include "limen/base/angles.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/simulate/scene.h"

// Which true plane each detected plane represents. The words are defined in plane_quality_main.cpp.

namespace limen {

/// Tolerances of the measure.
struct FitOptions {
  double fit_m = 0.008;   ///< a point fits the true planes within this; 0: its own alone
  double same_m = 0.006;  ///< true planes nearer than this, facing one way, are one
};

inline constexpr double kPure = 0.8;  ///< share of a detected plane's points that must fit its owner

/// True planes that no scan can tell apart become one, the one with most points: the true plane of each
/// point.
inline std::vector<std::int32_t> joined_truth(const SimulatedCase& simulated, std::size_t scan,
                                              double same_m) {
  std::vector<std::int32_t> of_point = simulated.truth.scans[scan].plane_of_point;
  const std::vector<TruePlane>& planes = simulated.truth.planes;
  std::vector<PointMoments> sums(planes.size());
  const Rigid3& world_from_scan = simulated.truth.scans[scan].local_from_scan;
  for (std::size_t i = 0; i < of_point.size(); ++i) {
    if (of_point[i] >= 0)
      sums[static_cast<std::size_t>(of_point[i])].add(world_from_scan * simulated.scans[scan].points[i]);
  }
  std::vector<std::size_t> order(planes.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sums[a].count > sums[b].count; });
  std::vector<std::int32_t> target(planes.size());
  std::vector<std::size_t> kept;
  for (const std::size_t k : order) {
    target[k] = static_cast<std::int32_t>(k);
    if (sums[k].count < 1.0) continue;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](std::size_t other) {
      return planes[k].plane.normal.dot(planes[other].plane.normal) > std::cos(radians(0.1)) &&
             std::abs(planes[other].plane.signed_distance(sums[k].mean())) < same_m &&
             std::abs(planes[k].plane.signed_distance(sums[other].mean())) < same_m;
    });
    if (same == kept.end()) {
      kept.push_back(k);
    } else {
      target[k] = static_cast<std::int32_t>(*same);
    }
  }
  for (std::int32_t& plane : of_point) {
    if (plane >= 0) plane = target[static_cast<std::size_t>(plane)];
  }
  return of_point;
}

/// The true planes that each point fits, its own first.
class Fitting {
 public:
  Fitting(const SimulatedCase& simulated, std::size_t scan, const FitOptions& options)
      : own_(joined_truth(simulated, scan, options.same_m)), begins_{0} {
    const Rigid3& world_from_scan = simulated.truth.scans[scan].local_from_scan;
    const std::vector<Vector3d>& points = simulated.scans[scan].points;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> planes_of_cube;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (own_[i] < 0) continue;
      std::vector<std::int32_t>& planes = planes_of_cube[cube_of(points[i], 0, 0, 0)];
      if (std::find(planes.begin(), planes.end(), own_[i]) == planes.end()) planes.push_back(own_[i]);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t first = fits_.size();
      if (own_[i] >= 0) fits_.push_back(own_[i]);
      for (int step = 0; options.fit_m > 0.0 && step < 27; ++step) {
        const auto near =
            planes_of_cube.find(cube_of(points[i], step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1));
        if (near == planes_of_cube.end()) continue;
        for (const std::int32_t k : near->second) {
          const Plane& plane = simulated.truth.planes[static_cast<std::size_t>(k)].plane;
          if (std::abs(plane.signed_distance(world_from_scan * points[i])) > options.fit_m) continue;
          if (std::find(fits_.begin() + static_cast<std::ptrdiff_t>(first), fits_.end(), k) == fits_.end())
            fits_.push_back(k);
        }
      }
      begins_.push_back(fits_.size());
    }
  }

  [[nodiscard]] std::size_t size() const { return own_.size(); }
  [[nodiscard]] std::int32_t own(std::size_t i) const { return own_[i]; }
  [[nodiscard]] const std::int32_t* begin(std::size_t i) const { return fits_.data() + begins_[i]; }
  [[nodiscard]] const std::int32_t* end(std::size_t i) const { return fits_.data() + begins_[i + 1]; }
  [[nodiscard]] bool shared(std::size_t i) const { return begins_[i + 1] - begins_[i] > 1; }

 private:
  static std::uint64_t cube_of(const Vector3d& x, int dx, int dy, int dz) {
    const auto part = [](double value, int step) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / 0.05)) + step) &
             0x1fffffU;
    };
    return (part(x.x(), dx) << 42U) | (part(x.y(), dy) << 21U) | part(x.z(), dz);
  }

  std::vector<std::int32_t> own_;
  std::vector<std::size_t> begins_;
  std::vector<std::int32_t> fits_;
};

/// How many points each pair of a detected and a true plane share.
struct Overlaps {
  using Counter = std::map<std::int32_t, std::size_t>;
  std::vector<Counter> fitting;   ///< by detected plane: true plane to points that fit it
  std::vector<Counter> surely;    ///< the same, points that fit it alone
  std::vector<std::size_t> size;  ///< by detected plane
  std::vector<std::size_t> none;  ///< by detected plane: points without a true plane
  Counter true_size;              ///< points that fit the true plane alone

  /// The true plane that most points of a detected plane fit; -1: none.
  [[nodiscard]] std::int32_t main_truth(std::size_t k) const {
    std::int32_t best = -1;
    std::size_t most = 0;
    for (const auto& [truth, count] : fitting[k]) {
      if (count <= most) continue;
      most = count;
      best = truth;
    }
    return best;
  }
  /// The true plane of a pure detected plane, else -1.
  [[nodiscard]] std::int32_t owner(std::size_t k) const {
    const std::int32_t truth = main_truth(k);
    if (truth < 0) return -1;
    const auto fit = static_cast<double>(fitting[k].at(truth));
    return fit >= kPure * static_cast<double>(size[k]) ? truth : -1;
  }
  [[nodiscard]] bool planar(std::size_t k) const { return 2 * none[k] <= size[k]; }
  /// Share of the true plane's own points in a detected plane.
  [[nodiscard]] double cover(std::size_t k, std::int32_t truth) const {
    const auto in_it = surely[k].find(truth);
    const auto all = true_size.find(truth);
    if (in_it == surely[k].end() || all == true_size.end()) return 0.0;
    return static_cast<double>(in_it->second) / static_cast<double>(all->second);
  }
};

inline Overlaps overlaps_of(const PlaneLabels& planes, const Fitting& truth) {
  Overlaps overlaps;
  overlaps.fitting.resize(planes.fits.size());
  overlaps.surely.resize(planes.fits.size());
  overlaps.size.resize(planes.fits.size(), 0);
  overlaps.none.resize(planes.fits.size(), 0);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool sure = truth.own(i) >= 0 && !truth.shared(i);
    if (sure) ++overlaps.true_size[truth.own(i)];
    if (planes.labels[i] < 0) continue;
    const auto k = static_cast<std::size_t>(planes.labels[i]);
    ++overlaps.size[k];
    if (truth.own(i) < 0) ++overlaps.none[k];
    if (sure) ++overlaps.surely[k][truth.own(i)];
    for (const std::int32_t* plane = truth.begin(i); plane != truth.end(i); ++plane)
      ++overlaps.fitting[k][*plane];
  }
  return overlaps;
}

}  // namespace limen
