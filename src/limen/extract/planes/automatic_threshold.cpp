// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/planes/automatic_threshold.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limen/base/error.h"
#include "limen/base/stage_part.h"

namespace limen {
namespace {

Scan even_subset(const Scan& scan, std::size_t most) {
  const std::size_t step = 1 + scan.size() / most;
  Scan part;
  part.local_origin = scan.local_origin;
  part.points.reserve(scan.size() / step + 1);
  for (std::size_t i = 0; i < scan.size(); i += step) part.points.push_back(scan.points[i]);
  return part;
}

std::vector<DetectedPlane> detected(const GrownPlanes& grown) {
  std::vector<DetectedPlane> planes(grown.planes.fits.size());
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const Vector3d& variances = grown.planes.fits[k].variances;
    planes[k].area_m2 = 12.0 * std::sqrt(variances[1] * variances[2]);
  }
  for (const std::int32_t label : grown.planes.labels) {
    if (label >= 0) ++planes[static_cast<std::size_t>(label)].inliers;
  }
  return planes;
}

}  // namespace

void AutomaticThresholdOptions::check() const {
  if (max_points < 1000) throw_bad_option("max_points", static_cast<double>(max_points), "1000 or more");
  if (factors.empty()) throw_bad_option("number of factors", 0, "1 or more");
  if (!(max_threshold_m > 0)) throw_bad_option("max_threshold_m", max_threshold_m, "more than 0");
}

double automatic_threshold(const Scan& scan, const GrowOptions& grow,
                           const AutomaticThresholdOptions& options, Monitor& monitor) {
  options.check();
  const Scan part = even_subset(scan, options.max_points);
  GrowOptions trial = grow;
  trial.min_inliers = std::max(50, grow.min_inliers / 2);
  const PlaneGround ground(part, trial);
  const double trials = 1.0 + static_cast<double>(options.factors.size());
  StagePart first_part(monitor, 0.0, 1.0 / trials);
  const GrownPlanes first = ground.grow(0.0, first_part);
  ThresholdOptions choice;
  choice.min_inliers = static_cast<std::size_t>(trial.min_inliers);
  choice.thresholds_m.clear();
  choice.until_worse = true;
  for (const double factor : options.factors) {
    const double threshold = std::min(options.max_threshold_m, factor * first.inlier_threshold_m);
    if (choice.thresholds_m.empty() || threshold > choice.thresholds_m.back())
      choice.thresholds_m.push_back(threshold);
  }
  if (choice.thresholds_m.size() < 2 || first.planes.fits.empty()) return first.inlier_threshold_m;
  const Extent extent = extent_of(part.points);
  double tried = 0.0;
  const auto detector = [&](double threshold_m) {
    if (threshold_m == first.inlier_threshold_m) return detected(first);
    tried = std::min(tried + 1.0, trials - 1.0);
    StagePart next_part(monitor, tried / trials, (tried + 1.0) / trials);
    return detected(ground.grow(threshold_m, next_part));
  };
  return choose_threshold({part.size(), extent.high - extent.low}, detector, choice).threshold_m;
}

double a_contrario_threshold(const Scan& scan, const GrowOptions& grow, const ThresholdOptions& choice,
                             Monitor& monitor) {
  const Scan part = even_subset(scan, AutomaticThresholdOptions{}.max_points);
  GrowOptions trial = grow;
  trial.min_inliers = std::max(50, grow.min_inliers / 2);
  ThresholdOptions among = choice;
  among.min_inliers = static_cast<std::size_t>(trial.min_inliers);
  const Extent extent = extent_of(part.points);
  const PlaneGround ground(part, trial);
  const auto detector = [&](double threshold_m) { return detected(ground.grow(threshold_m, monitor)); };
  return choose_threshold({part.size(), extent.high - extent.low}, detector, among).threshold_m;
}

}  // namespace limen
