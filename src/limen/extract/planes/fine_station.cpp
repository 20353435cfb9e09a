// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/fine_station.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/extract/planes/join_pieces.h"
#include "limen/extract/planes/plane_labels.h"
#include "limen/extract/planes/relief_sheets.h"
#include "limen/extract/planes/settle_planes.h"
#include "limen/extract/planes/split_at_steps.h"

namespace limen {
namespace {

constexpr double kAround = 0.1;        // what a point of a cube around counts beside one of the own cube
constexpr double kCoherentDeg = 20.0;  // between a plane and the surface at a point

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
            add_count(near, 0, {other.plane, kAround * other.count});
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
  double min_cosine_ = std::cos(radians(kCoherentDeg));
};

void move_point(const Vector3d& x, double count, PointMoments& sum) {
  sum.count += count;
  sum.sum += count * x;
  sum.outer += count * x * x.transpose();
}

}  // namespace

void coherent_labels(const SettleScene& scene, const CoherentOptions& options,
                     std::vector<std::int32_t>& labels, std::vector<PointMoments>& sums) {
  std::vector<std::int32_t> chosen = CoherentChoice(scene, options, labels, sums).run();
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (chosen[k] == labels[k]) continue;
    const Vector3d x = scene.sorted.point(k);
    if (labels[k] >= 0) move_point(x, -1.0, sums[static_cast<std::size_t>(labels[k])]);
    if (chosen[k] >= 0) move_point(x, 1.0, sums[static_cast<std::size_t>(chosen[k])]);
  }
  labels = std::move(chosen);
}

namespace {

constexpr double kChoiceCellM = 0.04;  // points choose among the planes of their cube and those around
constexpr double kLeastStationNoiseM = 0.001;
constexpr double kNoisesOfSheet = 3.3;
constexpr double kNoisesOfTail = 4.0;    // farther from its plane noise brings hardly a point
constexpr std::size_t kLeastPart = 100;  // points of what may become a plane
constexpr double kTakenByOthers = 0.8;   // of a plane that cuts along the edge of others

/// Labels along the curve, with the planes' sums.
class CurveLabels {
 public:
  CurveLabels(const Scan& scan, const MortonOrder& order, const GrownPlanes& grown,
              const FineOptions& options)
      : scan_(scan),
        order_(order),
        grid_(order, kChoiceCellM),
        scene_{order_, *grown.normals, grid_},
        anchor_(grown.planes.fits.front().centroid),
        threshold_m_(grown.inlier_threshold_m) {
    noise_m_ = std::max(kLeastStationNoiseM, options.noise_m);
    drift_m_ = options.drift_m;
    take(grown.planes.labels, grown.planes.fits.size());
  }

  void add_sheets() {
    const PlaneLabels planes = by_scan(1);
    SheetOptions options;
    options.threshold_m = std::min(threshold_m_, kNoisesOfSheet * noise_m_);
    const std::vector<PlanePiece> sheets = relief_sheets(scan_, planes, anchor_, options, tails());
    take(labels_with(planes.labels, sheets, planes.fits.size()), planes.fits.size() + sheets.size());
  }

  void split() {
    const PlaneLabels planes = by_scan(1);
    const std::vector<std::vector<std::uint32_t>> points = points_of(planes.labels, planes.fits.size());
    StepOptions steps;
    steps.drift_m = drift_m_;
    std::vector<std::vector<PlanePiece>> of_plane(points.size());
    parallel_for(points.size(), 1, [&](std::size_t k, std::size_t /*end*/) {
      for (std::vector<std::uint32_t>& part : split_at_steps(scan_, planes.fits[k], points[k], steps))
        of_plane[k].push_back(piece_of(scan_, std::move(part), anchor_));
    });
    std::vector<PlanePiece> pieces;
    for (std::vector<PlanePiece>& parts : of_plane)
      std::move(parts.begin(), parts.end(), std::back_inserter(pieces));
    join(std::move(pieces));
  }

  void choose() {
    CoherentOptions options;
    options.threshold_m = threshold_m_;
    options.noise_m = noise_m_;
    coherent_labels(scene_, options, labels_, sums_);
  }

  /// Planes whose points others would take give them back.
  void dissolve() {
    SettleOptions options;
    options.threshold_m = threshold_m_;
    options.cell_m = kChoiceCellM;
    const std::vector<double> explained = explained_shares(scene_, labels_, sums_, options);
    for (std::int32_t& label : labels_) {
      if (label >= 0 && explained[static_cast<std::size_t>(label)] > kTakenByOthers) label = -1;
    }
    for (std::size_t p = 0; p < sums_.size(); ++p) {
      if (explained[p] > kTakenByOthers) sums_[p] = {};
    }
  }

  /// Planes of at least so many points, largest first.
  [[nodiscard]] PlaneLabels by_scan(double least) const {
    PlaneLabels planes = planes_by_scan(order_, labels_, sums_, least);
    planes.inlier_threshold_m = threshold_m_;
    return planes;
  }

 private:
  void join(std::vector<PlanePiece> pieces) {
    JoinOptions options;
    options.noise_m = noise_m_;
    options.drift_m = drift_m_;
    pieces = joined_pieces(std::move(pieces), options);
    std::erase_if(pieces, [](const PlanePiece& piece) { return piece.points.size() < kLeastPart; });
    take(labels_with(std::vector<std::int32_t>(scan_.size(), -1), pieces), pieces.size());
  }

  void take(const std::vector<std::int32_t>& by_scan, std::size_t count) {
    labels_.resize(by_scan.size());
    for (std::size_t k = 0; k < labels_.size(); ++k) labels_[k] = by_scan[order_.index(k)];
    sums_ = label_sums(order_, labels_, count);
  }

  /// Per point of the scan the plane whose noise may have brought it there.
  [[nodiscard]] std::vector<std::int32_t> tails() const {
    CoherentOptions options;
    options.threshold_m = kNoisesOfTail * noise_m_;
    options.noise_m = noise_m_;
    std::vector<std::int32_t> labels = labels_;
    std::vector<PointMoments> sums = sums_;
    coherent_labels(scene_, options, labels, sums);
    std::vector<std::int32_t> tails(labels.size());
    for (std::size_t k = 0; k < labels.size(); ++k) tails[order_.index(k)] = labels[k];
    return tails;
  }

  const Scan& scan_;
  const MortonOrder& order_;
  SettleGrid grid_;
  SettleScene scene_;
  Vector3d anchor_;
  double threshold_m_;
  double noise_m_ = 0.0;
  double drift_m_ = 0.0;
  std::vector<std::int32_t> labels_;
  std::vector<PointMoments> sums_;
};

}  // namespace

PlaneLabels fine_station_planes(const Scan& scan, const MortonOrder& order, const GrownPlanes& grown,
                                const FineOptions& options) {
  if (grown.planes.fits.empty()) return grown.planes;
  CurveLabels labels(scan, order, grown, options);
  labels.add_sheets();
  labels.choose();
  labels.split();
  labels.choose();
  labels.dissolve();
  labels.choose();
  return labels.by_scan(options.min_inliers);
}

}  // namespace limen
