// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/planes/grow_planes.h"
#include "limen/geometry/rigid.h"
#include "limen/model/scan.h"

namespace limen {

// Choice of the inlier threshold a contrario: Djahel, Monasse, Vallet 2021, section 3.1.1, equations 3 to 6.
//
// Departures from the printed text:
// - equation 3 is rounded down; N_iter of equation 4 is the number of thresholds tried; everything is
// computed
//   in logarithms; P of equation 5, which can exceed 1, is clamped;
// - in equation 6 K is both the random variable and its bound, and the sum is empty as soon as more planes
// are
//   found than missed: NFA is then 0 for every threshold. The printed form is kept as `published`; the
//   default gives each plane its own number of false alarms and takes the threshold whose planes together are
//   the least likely to be chance.

enum class ThresholdCriterion {
  per_plane,  ///< sum over the planes of log NFA of each plane: see plane_log10_nfa
  published   ///< equations 3 to 6
};

struct ThresholdOptions {
  std::vector<double> thresholds_m = {0.005, 0.01, 0.015, 0.02, 0.03, 0.05};  ///< > 0, ascending
  ThresholdCriterion criterion = ThresholdCriterion::per_plane;
  std::size_t min_inliers = 200;  ///< min_size of equation 3, >= 3
  /// Stops at the first threshold that is worse than the one before: noise has one scale.
  bool until_worse = false;
};

/// What the choice needs to know of the cloud.
struct CloudSize {
  std::size_t points = 0;
  Vector3d extent_m = Vector3d::Zero();  ///< sides of the bounding box
};

/// A plane that the detector found with some threshold.
struct DetectedPlane {
  std::size_t inliers = 0;
  double area_m2 = 0.0;  ///< of its support; 0: unknown, then the squared diagonal of the cloud, as published
};

/// Runs the detector with a threshold in metres and tells the planes it found.
using ThresholdTrial = std::function<std::vector<DetectedPlane>(double threshold_m)>;

struct ThresholdScore {
  double threshold_m = 0.0;
  std::size_t planes = 0;
  double log10_nfa = 0.0;  ///< a cost: lower is better; minus infinity where the published NFA is 0
};

struct ThresholdChoice {
  double threshold_m = 0.0;
  std::vector<ThresholdScore> scores;  ///< in the order of the options
};

/// Tries all thresholds and takes the one with the smallest number of false alarms. Ties: per_plane takes the
/// smaller threshold; published, where 0 is the rule, the one with most planes, then the smaller.
ThresholdChoice choose_threshold(const CloudSize& cloud, const ThresholdTrial& detector,
                                 const ThresholdOptions& options = {});

/// Equations 3 to 6: log10 of tests * P[K >= F].
double published_log10_nfa(const CloudSize& cloud, std::size_t planes, double threshold_m,
                           const ThresholdOptions& options);
/// log10 of the expected number of planes as good as this one in a cloud of uniform noise: the thresholds
/// times the triples of points, times the tail of the binomial law (bounded after Hoeffding 1963) for that
/// many points within the slab of 2 * threshold around the plane's area. At most that of the tests.
double plane_log10_nfa(const CloudSize& cloud, const DetectedPlane& plane, double threshold_m,
                       const ThresholdOptions& options);

/// The inlier threshold in metres that the noise within small cubes of an even subset asks for.
double noise_threshold(const Scan& scan, const GrowOptions& grow, Monitor& monitor = silent_monitor());

/// The inlier threshold in metres for growing planes in `scan`, chosen a contrario (2021, 3.1.1) among
/// multiples of what the noise asks for: walls that are not flat, and clouds joined from many sweeps, need
/// more than their noise over a few decimetres tells.
double automatic_threshold(const Scan& scan, const GrowOptions& grow, Monitor& monitor = silent_monitor());

/// The threshold chosen a contrario among `choice.thresholds_m`, whatever the noise (2021, 3.1.1), on an even
/// subset of about 40 000 points. `choice.min_inliers` is taken from `grow`.
double a_contrario_threshold(const Scan& scan, const GrowOptions& grow, const ThresholdOptions& choice = {},
                             Monitor& monitor = silent_monitor());

}  // namespace limen
