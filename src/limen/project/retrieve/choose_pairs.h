// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "limen/project/store/scan_digest.h"

namespace limen {

/// The spread of a plane's surface about its centroid, scan's axes: that of its tiles and what a tile reaches
/// beyond its middle. m^2.
Matrix3d spread_of(const PlaneDigest& plane);

/// Where the planes of a scan reach to, in a frame; empty where it has none. Metres.
Eigen::AlignedBox3d box_of_planes(const ScanDigest& scan, const Rigid3& frame_from_scan);

inline constexpr double kLeastOverlapM2 = 3.0;  ///< less surface in common holds no pair

/// How much surface two scans should have in common where one is at a known pose to the other, from their
/// planes alone: those that face one way and lie in one another are taken for ellipses of their tiles, and
/// share the smaller area as far as these meet. m^2; a pair of planes counts for no more than 5 m^2. Poses
/// are between the digests' origins, scans' axes.
double predicted_overlap(const ScanDigest& a, const ScanDigest& b, const Rigid3& b_from_a);

/// Partners of each scan, the most promising first; ties by number.
std::vector<std::vector<std::size_t>> ranked_partners(const std::vector<ScanDigest>& digests);

using PairList = std::vector<std::pair<std::size_t, std::size_t>>;

/// The pairs (higher, lower number) that have a scan among the first `partners` of the other, sorted.
PairList best_pairs(const std::vector<std::vector<std::size_t>>& ranked, std::size_t partners);

}  // namespace limen
