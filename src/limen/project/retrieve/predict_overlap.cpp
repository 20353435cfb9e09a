// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/predict_overlap.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr std::size_t kMostPlanesCompared = 80;  // of a scan, the largest
constexpr double kMostOfPlaneM2 = 5.0;
constexpr double kOneWay = 0.98;         // cosine between normals
constexpr double kInOneAnotherM = 0.15;  // poses are known to centimetres, and planes bend
constexpr double kTileM = 0.1;           // what a tile reaches beyond its middle

std::size_t compared(const ScanDigest& scan) {
  return std::min(kMostPlanesCompared, scan.planes.size());
}

Matrix3d spread_of(const PlaneDigest& plane) {
  Matrix3d spread = kTileM * kTileM * Matrix3d::Identity();
  if (plane.moments.count > 0.0) spread += plane.moments.covariance();
  return spread;
}

}  // namespace

Eigen::AlignedBox3d box_of_planes(const ScanDigest& scan, const Rigid3& frame_from_scan) {
  constexpr double kSigmas = 2.0;  // an even spread ends at 1.7
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < compared(scan); ++k) {
    const PlaneDigest& plane = scan.planes[k];
    const Vector3d middle = frame_from_scan * plane.centroid;
    const Matrix3d spread =
        frame_from_scan.rotation * spread_of(plane) * frame_from_scan.rotation.transpose();
    const Vector3d reach = kSigmas * spread.diagonal().cwiseSqrt();
    box.extend(middle - reach);
    box.extend(middle + reach);
  }
  return box;
}

double predicted_overlap(const ScanDigest& a, const ScanDigest& b, const Rigid3& b_from_a) {
  double common = 0.0;
  for (std::size_t i = 0; i < compared(a); ++i) {
    const PlaneDigest& one = a.planes[i];
    const Vector3d normal = b_from_a.rotation * one.plane.normal;
    const Vector3d middle = b_from_a * one.centroid;
    for (std::size_t j = 0; j < compared(b); ++j) {
      const PlaneDigest& other = b.planes[j];
      const double cosine = normal.dot(other.plane.normal);
      const bool sided = one.oriented && other.oriented;
      if ((sided ? cosine : std::abs(cosine)) < kOneWay) continue;
      const Vector3d apart = middle - other.centroid;
      if (std::abs(apart.dot(other.plane.normal)) > kInOneAnotherM) continue;
      const Matrix3d turned = b_from_a.rotation * spread_of(one) * b_from_a.rotation.transpose();
      const Matrix3d both = turned + spread_of(other);
      const double squared = apart.dot(inverse_of(both) * apart);
      common += std::min({kMostOfPlaneM2, one.area_m2, other.area_m2}) * std::exp(-0.5 * squared);
    }
  }
  return common;
}

}  // namespace limen
