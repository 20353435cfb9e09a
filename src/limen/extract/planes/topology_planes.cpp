// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/topology_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/cells/scan_grid.h"
#include "limen/extract/planes/merge_planes.h"

namespace limen {
namespace {

constexpr double kMaxJump = 4.0;          // of neighbours, in units of the local spacing
constexpr double kSampleReachM = 0.35;    // size of the neighbourhood that samples are drawn from
constexpr double kHitConfidence = 0.999;  // of hitting the smallest plane before giving up
constexpr double kMergedDeg = 3.0;        // between pieces of one plane
constexpr std::int32_t kFree = -1;
constexpr std::size_t kRound = 256;        // trials judged at a time
constexpr int kSamples = 4;                // triples drawn per trial
constexpr double kMinLocalShare = 0.5;     // of the neighbourhood that must support a sample
constexpr std::int32_t kMinLines = 3;      // that a plane must span
constexpr double kMinSineOfView = 0.0175;  // 1 degree: planes seen flatter than this are refused
constexpr std::size_t kFreePointsPerPiece = 65536;

/// Places around a seed on the grid of lines: `own` those of its line, `others` those of lines nearby.
struct Neighbourhood {
  std::vector<std::size_t> own;
  std::vector<std::size_t> others;
  [[nodiscard]] std::size_t size() const { return own.size() + others.size(); }
};

/// A sample that its neighbourhood supports.
struct Trial {
  std::size_t seed = 0;
  Plane plane;
  double score = 0.0;  ///< MSAC, higher is better; 0: no support
};

/// A grown patch: its places, the sums about the grid's anchor.
struct Patch {
  std::vector<std::size_t> places;
  PointMoments moments;
  Plane plane;  ///< about the anchor
};

class TopologyDetector {
 public:
  TopologyDetector(const Scan& scan, const TopologyPlaneOptions& options)
      : scan_(scan),
        options_(options),
        grid_(scan, kMaxJump),
        labels_(scan.size(), kFree),
        visited_(scan.size(), 0),
        refused_(scan.size(), 0),
        free_(scan.size()) {
    std::iota(free_.begin(), free_.end(), 0U);
    anchor_ = grid_.point(grid_.size() / 2);
    threshold_m_ = options.inlier_threshold_m > 0.0 ? options.inlier_threshold_m
                                                    : std::clamp(3.3 * surface_noise(grid_), 0.01, 0.04);
  }

  PlaneLabels run(Monitor& monitor) {
    // How often a plane of min_inliers points, still free, would have been hit by now.
    double hits = 0.0;
    for (std::uint64_t trial = 0; hits < -std::log(1.0 - kHitConfidence) && free_.size() >= wanted();
         trial += kRound) {
      monitor.throw_if_cancelled();
      hits += static_cast<double>(kRound * wanted()) / static_cast<double>(free_.size());
      grow_round(judge(trial));
      monitor.advance(static_cast<double>(grid_.size() - free_.size()), static_cast<double>(grid_.size()));
    }
    merge_pieces();
    settle_borders();
    settle_borders();
    return finish();
  }

 private:
  [[nodiscard]] Vector3d local(std::size_t at) const { return grid_.point(at) - anchor_; }
  [[nodiscard]] double distance(const Plane& plane, std::size_t at) const {
    return std::abs(plane.signed_distance(local(at)));
  }
  [[nodiscard]] std::size_t wanted() const { return static_cast<std::size_t>(options_.min_inliers); }

  /// A round of trials, best first; read only, so that threads do not matter.
  [[nodiscard]] std::vector<Trial> judge(std::uint64_t first_trial) const {
    std::vector<Trial> round(kRound);
    parallel_for(kRound, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        RandomStream random(options_.seed, first_trial + k);
        round[k] = best_sample(free_[random.below(static_cast<std::uint32_t>(free_.size()))], random);
      }
    });
    std::stable_sort(round.begin(), round.end(),
                     [](const Trial& a, const Trial& b) { return a.score > b.score; });
    return round;
  }

  [[nodiscard]] bool is_free(std::int32_t at) const {
    return at != ScanGrid::kNone && labels_[static_cast<std::size_t>(at)] == kFree;
  }

  /// Free places linked one after the other, up to `kSampleReachM` away, at most `most` of them.
  [[nodiscard]] std::vector<std::size_t> walk(std::size_t from, ScanGrid::Link link, std::size_t most) const {
    std::vector<std::size_t> places;
    std::int32_t at = grid_.links(from)[link];
    while (places.size() < most && is_free(at)) {
      const auto place = static_cast<std::size_t>(at);
      if ((grid_.point(place) - grid_.point(from)).norm() > kSampleReachM && places.size() >= 3) break;
      places.push_back(place);
      at = grid_.links(place)[link];
    }
    return places;
  }

  /// Up to 24 places of a walk, evenly chosen, the last one included.
  static void thin_into(const std::vector<std::size_t>& walk, std::vector<std::size_t>& places) {
    const std::size_t step = 1 + walk.size() / 24;
    for (std::size_t k = walk.size(); k > 0; k -= std::min(k, step)) places.push_back(walk[k - 1]);
  }

  [[nodiscard]] Neighbourhood around(std::size_t seed) const {
    Neighbourhood near;
    near.own.push_back(seed);
    thin_into(walk(seed, ScanGrid::previous, 100), near.own);
    thin_into(walk(seed, ScanGrid::next, 100), near.own);
    for (const ScanGrid::Link across : {ScanGrid::line_before, ScanGrid::line_after}) {
      for (const std::size_t start : walk(seed, across, 8)) {
        near.others.push_back(start);
        thin_into(walk(start, ScanGrid::previous, 100), near.others);
        thin_into(walk(start, ScanGrid::next, 100), near.others);
      }
    }
    return near;
  }

  /// MSAC as a score, 2022 eq. 2: sum of 1 - d^2 / t^2 over the inliers.
  [[nodiscard]] double score(const Plane& plane, const Neighbourhood& near) const {
    double sum = 0.0;
    for (const auto* places : {&near.own, &near.others}) {
      for (const std::size_t at : *places) {
        const double ratio = distance(plane, at) / threshold_m_;
        sum += std::max(0.0, 1.0 - ratio * ratio);
      }
    }
    return sum;
  }

  /// The plane through the seed, another echo of its line and one of another line.
  [[nodiscard]] std::optional<Plane> draw(std::size_t seed, const Neighbourhood& near,
                                          RandomStream& random) const {
    const Vector3d a = local(seed);
    const Vector3d b = local(near.own[random.below(static_cast<std::uint32_t>(near.own.size()))]);
    const Vector3d c = local(near.others[random.below(static_cast<std::uint32_t>(near.others.size()))]);
    const Vector3d normal = (b - a).cross(c - a);
    const double width = normal.norm() / std::max({(b - a).norm(), (c - a).norm(), (c - b).norm(), 1e-9});
    if (width < threshold_m_) return std::nullopt;
    const Plane plane{normal.normalized(), normal.normalized().dot(a)};
    if (scan_.centre_known() && sine_of_view(plane, seed) < kMinSineOfView) return std::nullopt;
    return plane;
  }

  [[nodiscard]] Trial best_sample(std::size_t seed, RandomStream& random) const {
    Trial best{seed, {}, 0.0};
    const Neighbourhood near = around(seed);
    if (near.own.size() < 3 || near.others.size() < 6) return best;
    const double needed = kMinLocalShare * static_cast<double>(near.size());
    for (int k = 0; k < kSamples; ++k) {
      const std::optional<Plane> plane = draw(seed, near, random);
      if (!plane) continue;
      const double sample_score = score(*plane, near);
      if (sample_score > std::max(best.score, needed)) best = {seed, *plane, sample_score};
    }
    return best;
  }

  /// Grows the supported trials of a round, best first.
  void grow_round(const std::vector<Trial>& round) {
    bool any = false;
    for (const Trial& trial : round) {
      if (trial.score <= 0.0) break;
      if (labels_[trial.seed] != kFree || refused_[trial.seed] != 0) continue;
      Patch patch = grow(trial.seed, trial.plane, true);
      if (patch.places.size() >= wanted() / 2) patch = grow(trial.seed, patch.plane, false);
      if (patch.places.size() < wanted()) continue;
      any = true;
      if (!is_surface(patch)) {
        for (const std::size_t at : patch.places) refused_[at] = 1;
        continue;
      }
      for (const std::size_t at : patch.places) labels_[at] = static_cast<std::int32_t>(pieces_.size());
      pieces_.push_back(patch.moments);
    }
    if (any)
      std::erase_if(free_, [&](std::uint32_t at) { return labels_[at] != kFree || refused_[at] != 0; });
  }

  /// Breadth first over links to free points within the threshold. The plane follows the points while
  /// `refit` is set, and is fitted once more at the end.
  Patch grow(std::size_t seed, const Plane& start, bool refit) {
    Patch patch;
    patch.plane = start;
    ++round_;
    visited_[seed] = round_;
    patch.places.push_back(seed);
    patch.moments.add(local(seed));
    std::size_t next_fit = 32;
    for (std::size_t head = 0; head < patch.places.size(); ++head) {
      for (const std::int32_t link : grid_.links(patch.places[head])) {
        if (!is_free(link)) continue;
        const auto at = static_cast<std::size_t>(link);
        if (visited_[at] == round_ || distance(patch.plane, at) > threshold_m_) continue;
        visited_[at] = round_;
        patch.places.push_back(at);
        patch.moments.add(local(at));
      }
      if (refit && patch.places.size() >= next_fit) {
        patch.plane = fit_plane(patch.moments).plane;
        next_fit += next_fit / 2;
      }
    }
    if (patch.places.size() >= 3) patch.plane = fit_plane(patch.moments).plane;
    return patch;
  }

  /// Wide enough, over several lines, and not seen along its own surface.
  [[nodiscard]] bool is_surface(const Patch& patch) const {
    const PlaneFit fit = fit_plane(patch.moments);
    if (std::sqrt(fit.variances[1]) < 2.0 * std::max(threshold_m_, fit.rms_m)) return false;
    std::int32_t low = grid_.line(patch.places.front());
    std::int32_t high = low;
    for (const std::size_t at : patch.places) {
      low = std::min(low, grid_.line(at));
      high = std::max(high, grid_.line(at));
    }
    if (high - low + 1 < kMinLines) return false;
    return !scan_.centre_known() || sine_of_view(patch) >= kMinSineOfView;
  }

  /// |n . ray| at one place.
  [[nodiscard]] double sine_of_view(const Plane& plane, std::size_t at) const {
    const Vector3d ray = grid_.point(at) - scan_.centre(grid_.scan_index(at));
    return std::abs(plane.normal.dot(ray)) / std::max(ray.norm(), 1e-9);
  }

  /// Its mean over some of the patch's points.
  [[nodiscard]] double sine_of_view(const Patch& patch) const {
    const std::size_t step = 1 + patch.places.size() / 64;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < patch.places.size(); k += step, ++count) {
      sum += sine_of_view(patch.plane, patch.places[k]);
    }
    return sum / count;
  }

  void merge_pieces() {
    MergedPieces merged = merge_planes(pieces_, radians(kMergedDeg), 0.6 * threshold_m_);
    pieces_ = std::move(merged.planes);
    for (std::int32_t& label : labels_) {
      if (label != kFree) label = merged.target[static_cast<std::size_t>(label)];
    }
  }

  /// Every point goes to the nearest plane among its own and those of its neighbours on the grid.
  void settle_borders() {
    std::vector<Plane> planes;
    for (const PointMoments& moments : pieces_) planes.push_back(fit_plane(moments).plane);
    std::vector<std::int32_t> settled = labels_;
    parallel_for(labels_.size(), kFreePointsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; ++at) settled[at] = nearest_plane(at, planes);
    });
    labels_ = std::move(settled);
  }

  [[nodiscard]] std::int32_t nearest_plane(std::size_t at, const std::vector<Plane>& planes) const {
    std::int32_t best = labels_[at];
    double smallest = best == kFree ? threshold_m_ : distance(planes[static_cast<std::size_t>(best)], at);
    for (const std::int32_t link : grid_.links(at)) {
      if (link == ScanGrid::kNone) continue;
      const std::int32_t label = labels_[static_cast<std::size_t>(link)];
      if (label == kFree || label == best) continue;
      const double d = distance(planes[static_cast<std::size_t>(label)], at);
      if (d >= smallest) continue;
      smallest = d;
      best = label;
    }
    return best;
  }

  [[nodiscard]] std::vector<PointMoments> sums_by_label() const {
    using Sums = std::vector<PointMoments>;
    return parallel_reduce(
        labels_.size(), 4 * kFreePointsPerPiece, Sums(pieces_.size()),
        [&](std::size_t begin, std::size_t end) {
          Sums sums(pieces_.size());
          for (std::size_t at = begin; at < end; ++at) {
            if (labels_[at] != kFree) sums[static_cast<std::size_t>(labels_[at])].add(local(at));
          }
          return sums;
        },
        [](Sums a, const Sums& b) {
          for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
          return a;
        });
  }

  [[nodiscard]] PlaneLabels finish() const {
    const std::vector<PointMoments> sums = sums_by_label();
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      if (sums[k].count >= options_.min_inliers) kept.push_back(k);
    }
    std::stable_sort(kept.begin(), kept.end(),
                     [&](std::size_t a, std::size_t b) { return sums[a].count > sums[b].count; });
    PlaneLabels result;
    result.inlier_threshold_m = threshold_m_;
    std::vector<std::int32_t> final_label(sums.size(), kFree);
    for (const std::size_t k : kept) {
      final_label[k] = static_cast<std::int32_t>(result.fits.size());
      PlaneFit fit = fit_plane(sums[k]);
      fit.plane = shifted(fit.plane, -anchor_);
      fit.centroid += anchor_;
      result.fits.push_back(fit);
    }
    result.labels.assign(labels_.size(), kFree);
    parallel_for(labels_.size(), kFreePointsPerPiece, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; ++at) {
        if (labels_[at] == kFree) continue;
        result.labels[grid_.scan_index(at)] = final_label[static_cast<std::size_t>(labels_[at])];
      }
    });
    return result;
  }

  const Scan& scan_;
  TopologyPlaneOptions options_;
  ScanGrid grid_;
  std::vector<std::int32_t> labels_;    ///< by place: index into pieces_, or kFree
  std::vector<std::uint32_t> visited_;  ///< by place: the last growth that took the point
  std::vector<char> refused_;           ///< by place: part of a patch that is no surface, no seed again
  std::vector<std::uint32_t> free_;     ///< places that may be seeds
  std::vector<PointMoments> pieces_;
  Vector3d anchor_ = Vector3d::Zero();
  double threshold_m_ = 0.0;
  std::uint32_t round_ = 0;
};

}  // namespace

PlaneLabels extract_topology_planes(const Scan& scan, const TopologyPlaneOptions& options, Monitor& monitor) {
  if (!scan.topology.known()) {
    throw Error("the scan lines are not known", scan.name, "use the detector for unorganised clouds");
  }
  if (scan.size() == 0) return {};
  return TopologyDetector(scan, options).run(monitor);
}

}  // namespace limen
