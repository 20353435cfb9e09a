// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "limen/geometry/plane.h"
#include "limen/model/scan.h"

namespace limen {

/// A plane's points by parts that are connected: squares of `gap_m` that touch, also at a corner. Largest
/// first, each ascending.
std::vector<std::vector<std::uint32_t>> touching_parts(const Scan& scan, const PlaneFit& fit,
                                                       const std::vector<std::uint32_t>& points,
                                                       double gap_m);

/// When pieces lie in one plane.
struct JoinOptions {
  double noise_m = 0.003;   ///< of a point about its plane, one standard deviation
  double drift_m = 0.0005;  ///< by which parts of one surface may stray beside the noise: trajectories drift
};

/// Points of one plane that are connected.
struct PlanePiece {
  std::vector<std::uint32_t> points;  ///< of the scan, ascending
  PointMoments moments;               ///< about the anchor
  Vector3d sight = Vector3d::Zero();  ///< sum of the ways to the scanner positions, where they are known
};

PlanePiece piece_of(const Scan& scan, std::vector<std::uint32_t> points, const Vector3d& anchor);

/// Labels per point of the scan, with those of the pieces' points: `first` for the first piece, and on.
std::vector<std::int32_t> labels_with(std::vector<std::int32_t> labels, const std::vector<PlanePiece>& pieces,
                                      std::size_t first = 0);

/// The parts of a plane's points that are connected and were seen from one side. Largest first.
std::vector<PlanePiece> parts_of(const Scan& scan, const PlaneFit& fit,
                                 const std::vector<std::uint32_t>& points, double gap_m,
                                 const Vector3d& anchor);

/// Pieces that lie in one plane become one: what the common plane adds to the squares of their residuals is
/// held against the noise (three parameters, chi squared) and the drift. A gate on the spread alone lets a
/// common plane tilt between two cars in one line, 14 mm apart. Two sides of one sheet stay two. In the order
/// of their largest pieces.
std::vector<PlanePiece> joined_pieces(std::vector<PlanePiece> pieces, const JoinOptions& options);

}  // namespace limen
