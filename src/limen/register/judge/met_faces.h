// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "limen/geometry/rigid.h"

namespace limen {

// Pieces that lie so in one plane are of one face: a leaf, a cupboard's front.
inline constexpr double kOneFaceM = 0.04;
inline constexpr double kOneFaceCosine = 0.97;
inline constexpr double kThingLengthM = 0.4;  ///< pieces nearer than this belong to one thing ...
inline constexpr double kFrontLengthM = 1.5;  ///< ... and those of one plane nearer than this

/// A face of one scan that the other has as well, in the target's frame.
struct MetFace {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  double offset_m = 0.0;
  double sigma_m = 0.0;
  double weight = 1.0;  ///< pieces
};

/// Whether two pieces, by their middles and normals, lie in one plane.
inline bool in_one_face(const Vector3d& apart, const Vector3d& normal, const Vector3d& other_normal) {
  return normal.dot(other_normal) > kOneFaceCosine && std::abs(apart.dot(normal)) < kOneFaceM;
}

/// Faces near one another may be of one thing, or were pushed together; those in one plane are of one
/// cupboard or board even where something hides what lies between. How far a thing was put from its place one
/// way says nothing of the other way.
double correlation(const MetFace& a, const MetFace& b);

/// The pieces of one face were put where they are together: they make one observation, a better one the more
/// they are.
std::vector<MetFace> joined(const std::vector<MetFace>& pieces);

/// Each piece's share of an observation, w_i / sum_j w_j rho_ij: neighbours that tell the same make one
/// together, however many they are, and what is alone is one of its own. Farther apart than `reach_m`
/// none are correlated.
template <typename Item>
std::vector<double> shares_of(const std::vector<Item>& items, double reach_m) {
  std::vector<double> together(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    together[i] += items[i].weight;
    for (std::size_t j = 0; j < i; ++j) {
      if ((items[j].at - items[i].at).squaredNorm() > reach_m * reach_m) continue;
      const double rho = correlation(items[i], items[j]);
      together[i] += items[j].weight * rho;
      together[j] += items[i].weight * rho;
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i)
    together[i] = together[i] > 0.0 ? items[i].weight / together[i] : 0.0;
  return together;
}

}  // namespace limen
