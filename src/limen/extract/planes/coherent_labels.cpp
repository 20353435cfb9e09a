// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/coherent_labels.h"

#include <cmath>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/extract/planes/cube_counts.h"

namespace limen {
namespace {

/// One round.
class CoherentChoice {
 public:
  CoherentChoice(const SettleScene& scene, const CoherentOptions& options,
                 const std::vector<std::int32_t>& labels, const std::vector<PointMoments>& sums)
      : scene_(scene), o_(options), labels_(labels), counts_(scene.grid.runs(), labels) {
    for (const PointMoments& sum : sums) planes_.push_back(sum.count >= 3.0 ? fit_plane(sum).plane : Plane{});
  }

  [[nodiscard]] std::vector<std::int32_t> run() const {
    const CellRuns& runs = scene_.grid.runs();
    std::vector<std::int32_t> chosen = labels_;
    parallel_for(runs.size(), 256, [&](std::size_t begin, std::size_t end) {
      std::vector<PlaneCount> near;
      for (std::size_t i = begin; i < end; ++i) {
        near.assign(counts_.of(i).begin(), counts_.of(i).end());
        for (const std::int32_t j : scene_.grid.around(i)) {
          for (const PlaneCount& other : counts_.of(static_cast<std::size_t>(j)))
            add_count(near, 0, {other.plane, o_.around * other.count});
        }
        if (settled(i, near)) continue;
        for (PlaneCount& it : near) it.count = std::log(it.count);
        for (std::uint32_t k = runs.begin(i); k < runs.end(i); ++k) chosen[k] = likeliest(k, near);
      }
    });
    return chosen;
  }

 private:
  /// One plane holds the cube and all around it: nothing to choose.
  [[nodiscard]] bool settled(std::size_t cube, const std::vector<PlaneCount>& near) const {
    const CellRuns& runs = scene_.grid.runs();
    if (near.empty()) return true;
    return near.size() == 1 && counts_.of(cube).size() == 1 &&
           counts_.of(cube).front().count == static_cast<double>(runs.end(cube) - runs.begin(cube));
  }

  /// `near`: logarithms of counts.
  [[nodiscard]] std::int32_t likeliest(std::uint32_t k, const std::vector<PlaneCount>& near) const {
    const Vector3d point = scene_.sorted.point(k);
    const Vector3d* const normal = scene_.normals.at(k);
    double best = -1e300;
    std::int32_t chosen = -1;
    for (const PlaneCount& it : near) {
      const Plane& plane = planes_[static_cast<std::size_t>(it.plane)];
      const double d = std::abs(plane.signed_distance(point));
      if (d > o_.threshold_m) continue;
      if (normal != nullptr && std::abs(normal->dot(plane.normal)) < min_cosine_) continue;
      const double score = it.count - 0.5 * (d / o_.noise_m) * (d / o_.noise_m);
      if (score <= best) continue;
      best = score;
      chosen = it.plane;
    }
    return chosen;
  }

  const SettleScene& scene_;
  CoherentOptions o_;
  const std::vector<std::int32_t>& labels_;
  CubeCounts counts_;
  std::vector<Plane> planes_;
  double min_cosine_ = std::cos(radians(o_.max_angle_deg));
};

void move_point(const Vector3d& x, double count, PointMoments& sum) {
  sum.count += count;
  sum.sum += count * x;
  sum.outer += count * x * x.transpose();
}

}  // namespace

void CoherentOptions::check() const {
  if (!(threshold_m > 0)) throw_bad_option("threshold_m", threshold_m, "more than 0");
  if (!(noise_m > 0)) throw_bad_option("noise_m", noise_m, "more than 0");
  if (!(around >= 0)) throw_bad_option("around", around, "0 or more");
  if (!(max_angle_deg > 0 && max_angle_deg < 90))
    throw_bad_option("max_angle_deg", max_angle_deg, "within (0, 90)");
  if (rounds < 1) throw_bad_option("rounds", rounds, "1 or more");
}

void coherent_labels(const SettleScene& scene, const CoherentOptions& options,
                     std::vector<std::int32_t>& labels, std::vector<PointMoments>& sums) {
  options.check();
  for (int round = 0; round < options.rounds; ++round) {
    std::vector<std::int32_t> chosen = CoherentChoice(scene, options, labels, sums).run();
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (chosen[k] == labels[k]) continue;
      const Vector3d x = scene.sorted.point(k);
      if (labels[k] >= 0) move_point(x, -1.0, sums[static_cast<std::size_t>(labels[k])]);
      if (chosen[k] >= 0) move_point(x, 1.0, sums[static_cast<std::size_t>(chosen[k])]);
    }
    labels = std::move(chosen);
  }
}

}  // namespace limen
