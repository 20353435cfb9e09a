// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/choose_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "limen/base/parallel.h"
#include "limen/geometry/linear.h"
#include "limen/project/retrieve/placed_plane.h"

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

}  // namespace

Matrix3d spread_of(const PlaneDigest& plane) {
  Matrix3d spread = kTileM * kTileM * Matrix3d::Identity();
  if (plane.moments.count > 0.0) spread += plane.moments.covariance();
  return spread;
}

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

namespace {

constexpr double kMostM2 = 5.0;          // a plane counts for no more
constexpr double kStepM = 0.05;          // of the shifts that are voted for
constexpr double kAlong = 0.97;          // cosine between a wall's normal and a main direction
constexpr std::size_t kMostPlanes = 60;  // of a scan, the largest

/// A plane across one of the main directions.
struct Layer {
  double offset_m = 0.0;  ///< along the direction
  double weight_m2 = 0.0;
};

/// Planes of a scan by the direction their normals point to: +x, +y, -x, -y of its main directions, +z, -z.
using Layers = std::array<std::vector<Layer>, 6>;

double turned(double angle, double by) {
  return angle - by * std::floor(angle / by);
}

/// The direction modulo a quarter turn in which most wall is (the mean of the fourfold angles).
double main_direction(const ScanDigest& scan) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const PlaneDigest& plane : scan.planes) {
    const Vector3d normal = scan.upright_from_scan * plane.plane.normal;
    if (!is_wall(normal)) continue;
    const double angle = 4.0 * std::atan2(normal.y(), normal.x());
    sine += plane.area_m2 * std::sin(angle);
    cosine += plane.area_m2 * std::cos(angle);
  }
  return turned(std::atan2(sine, cosine) / 4.0, 0.5 * 3.14159265358979323846);
}

Layers layers_of(const ScanDigest& scan) {
  Layers layers;
  const double main = main_direction(scan);
  const Vector3d x(std::cos(main), std::sin(main), 0.0);
  const Vector3d y(-x.y(), x.x(), 0.0);
  const std::array<Vector3d, 6> directions = {x, y, -x, -y, Vector3d::UnitZ(), -Vector3d::UnitZ()};
  for (std::size_t k = 0; k < std::min(kMostPlanes, scan.planes.size()); ++k) {
    const PlaneDigest& plane = scan.planes[k];
    const Vector3d normal = scan.upright_from_scan * plane.plane.normal;
    for (std::size_t d = 0; d < 6; ++d) {
      // Where a normal's side is not known it may be either.
      const double cosine = normal.dot(directions[d]);
      if (cosine < kAlong && (plane.oriented || cosine > -kAlong)) continue;
      const double offset = (scan.upright_from_scan * plane.centroid).dot(directions[d]);
      layers[d].push_back({offset, std::min(kMostM2, plane.area_m2)});
    }
  }
  return layers;
}

/// The most surface that one shift brings together, of planes that face both ways along one direction.
double best_shift(const std::vector<Layer>& a_plus, const std::vector<Layer>& b_plus,
                  const std::vector<Layer>& a_minus, const std::vector<Layer>& b_minus) {
  std::map<long, double> votes;
  const auto vote = [&](const std::vector<Layer>& from, const std::vector<Layer>& to, double sign) {
    for (const Layer& a : from) {
      for (const Layer& b : to) {
        const long bin = std::lround(sign * (b.offset_m - a.offset_m) / kStepM);
        const double weight = std::min(a.weight_m2, b.weight_m2);
        votes[bin] += weight;
        votes[bin + 1] += 0.5 * weight;
        votes[bin - 1] += 0.5 * weight;
      }
    }
  };
  vote(a_plus, b_plus, 1.0);
  vote(a_minus, b_minus, -1.0);
  double best = 0.0;
  for (const auto& [bin, weight] : votes) best = std::max(best, weight);
  return best;
}

/// How much two scans may have in common, from their planes alone: m^2 of planes of one direction that one
/// shift brings together, for the best of the four turns about the vertical that bring the main directions of
/// their walls together; the shifts along the two directions and the vertical are sought one by one, by
/// votes. A plane counts for no more than 5 m^2.
double common_layers(const Layers& a, const Layers& b) {
  const double up = best_shift(a[4], b[4], a[5], b[5]);
  double best = 0.0;
  for (std::size_t turn = 0; turn < 4; ++turn) {
    const double x = best_shift(a[0], b[turn], a[2], b[(turn + 2) % 4]);
    const double y = best_shift(a[1], b[(turn + 1) % 4], a[3], b[(turn + 3) % 4]);
    // A pose is held by all three: the weakest counts most.
    best = std::max(best, std::min(x, y) + 0.25 * (x + y) + 0.25 * std::min(up, 2.0 * kMostM2));
  }
  return best;
}

}  // namespace

std::vector<std::vector<std::size_t>> ranked_partners(const std::vector<ScanDigest>& digests) {
  std::vector<Layers> layers;
  for (const ScanDigest& digest : digests) layers.push_back(layers_of(digest));
  std::vector<std::vector<double>> common(digests.size());
  parallel_for(digests.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool models = digests[i].model && digests[j].model;
        common[i].push_back(models ? 0.0 : common_layers(layers[j], layers[i]));
      }
    }
  });
  std::vector<std::vector<std::size_t>> ranked(digests.size());
  for (std::size_t i = 0; i < digests.size(); ++i) {
    const auto value = [&](std::size_t j) { return j < i ? common[i][j] : common[j][i]; };
    for (std::size_t j = 0; j < digests.size(); ++j) {
      if (j != i && !(digests[i].model && digests[j].model)) ranked[i].push_back(j);
    }
    std::stable_sort(ranked[i].begin(), ranked[i].end(),
                     [&](std::size_t a, std::size_t b) { return value(a) > value(b); });
  }
  return ranked;
}

PairList best_pairs(const std::vector<std::vector<std::size_t>>& ranked, std::size_t partners) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    for (std::size_t k = 0; k < std::min(partners, ranked[i].size()); ++k)
      pairs.emplace(std::max(i, ranked[i][k]), std::min(i, ranked[i][k]));
  }
  return {pairs.begin(), pairs.end()};
}

}  // namespace limen
