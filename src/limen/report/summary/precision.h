// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "limen/report/summary/registration_report.h"

namespace limen {

/// What a stated radius holds: the point lies within it this often.
inline constexpr double kStatedConfidence = 0.95;

/// Radius of the ball that holds a Gaussian displacement of covariance `covariance` (m^2) in 95 % of cases:
/// its square is taken as gamma-distributed with the right mean and variance (Welch 1947, Satterthwaite
/// 1946), and that quantile by Wilson and Hilferty (1931). Within 2 % of the true radius. `known_by`:
/// freedoms that the scale of the covariance was estimated with; then the ball is that of Student's
/// distribution (quantile of F by Paulson 1942).
double radius_95(const Matrix3d& covariance, double known_by = 1e9);

/// Freedoms with which a pose's covariance is known by how far its planes disagree: as many planes as their
/// overlaps make, less the three that a shift takes; at least 3.
double freedoms_of(const std::vector<PlaneMatch>& matches);

/// How well a place of the source is known in the target.
struct PlacePrecision {
  Vector3d at = Vector3d::Zero();  ///< metres, target world
  double radius_m = 0.0;           ///< 95 %, from all: the scatter of the points, how far planes disagree
                                   ///< and a trajectory's error
  std::optional<double> formal_radius_m;  ///< 95 %, from the scatter of the points alone
};

/// What a reader may rely on, were the pose the right one.
struct PosePrecision {
  PlacePrecision middle;        ///< of the source (of the scan, where the source is a model)
  PlacePrecision far_end;       ///< the worst corner of the box round the central 98 % of its points
  double far_distance_m = 0.0;  ///< of the far end from the middle
  bool across_open = false;     ///< a shift is open: what is reported holds across it
};

/// Of a pose of the report; nothing where there is none, a turn is open, or a published method tells nothing.
std::optional<PosePrecision> precision_of(const RegistrationReport& report, const Hypothesis& pose);

/// The pose as a reader sees it: by how much the middle of the source moves, and the turn about it.
struct PoseMotion {
  Vector3d about = Vector3d::Zero();    ///< the source's middle, metres, source world
  Vector3d shift_m = Vector3d::Zero();  ///< of that point: target coordinates less source coordinates
  Vector3d axis = Vector3d::UnitZ();    ///< of the turn, unit vector, target frame
  double turn_rad = 0.0;
};
PoseMotion motion_of(const RegistrationReport& report, const Hypothesis& pose);

/// One standard deviation of PoseMotion::shift_m along x, y, z of the target, metres.
Vector3d shift_sigma_of(const RegistrationReport& report, const Hypothesis& pose);

/// Root mean square of the distances between matched planes, weighted by overlap; nothing where none match.
std::optional<double> plane_distance_rms(const std::vector<PlaneMatch>& matches);

/// Coordinates so large that programs with single precision shift them: a national grid.
bool on_large_coordinates(const RegistrationReport& report);

}  // namespace limen
