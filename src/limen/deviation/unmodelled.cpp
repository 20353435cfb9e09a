// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/unmodelled.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limen/base/disjoint_sets.h"

namespace limen {
namespace {

constexpr std::int64_t kHalf = 1 << 20;

std::uint64_t key_of(const Vector3d& x, double cell_m) {
  std::uint64_t key = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double place = std::floor(x[k] / cell_m) + static_cast<double>(kHalf);
    const auto cell = static_cast<std::uint64_t>(std::clamp(place, 1.0, 2.0 * kHalf - 2.0));
    key = (key << 21U) | cell;
  }
  return key;
}

/// A piece before it holds anything.
UnmodelledObject nothing_yet() {
  UnmodelledObject piece;
  piece.low = Vector3d::Constant(1e300);
  piece.high = Vector3d::Constant(-1e300);
  return piece;
}

}  // namespace

void UnmodelledPoints::add(const Vector3d& x) {
  const std::uint64_t key = key_of(x, cell_m_);
  const auto [it, fresh] = places_.try_emplace(key, keys_.size());
  if (fresh) {
    keys_.push_back(key);
    cubes_.push_back(nothing_yet());
  }
  UnmodelledObject& cube = cubes_[it->second];
  ++cube.points;
  cube.low = cube.low.cwiseMin(x);
  cube.high = cube.high.cwiseMax(x);
  cube.centre += x;
}

std::vector<UnmodelledObject> UnmodelledPoints::pieces(std::size_t min_points, const Vector3d& low,
                                                       const Vector3d& high) const {
  DisjointSets joined(keys_.size());  // cubes, with their neighbours
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    for (std::uint64_t n = 0; n < 27; ++n) {
      const std::uint64_t step = ((n % 3) << 42U) + ((n / 3 % 3) << 21U) + n / 9;
      const std::uint64_t back = (std::uint64_t{1} << 42U) + (std::uint64_t{1} << 21U) + 1;
      const auto other = places_.find(keys_[k] + step - back);
      if (other != places_.end()) joined.join(k, other->second);
    }
  }
  std::vector<UnmodelledObject> pieces(keys_.size(), nothing_yet());
  for (std::size_t k = 0; k < cubes_.size(); ++k) {
    UnmodelledObject& piece = pieces[joined.find(k)];
    piece.points += cubes_[k].points;
    piece.low = piece.low.cwiseMin(cubes_[k].low);
    piece.high = piece.high.cwiseMax(cubes_[k].high);
    piece.centre += cubes_[k].centre;
  }
  std::erase_if(pieces, [&](const UnmodelledObject& piece) {
    return piece.points < std::max<std::size_t>(1, min_points);
  });
  for (UnmodelledObject& piece : pieces) {
    piece.centre /= static_cast<double>(piece.points);
    piece.within_model =
        (piece.centre.array() >= low.array()).all() && (piece.centre.array() <= high.array()).all();
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const UnmodelledObject& a, const UnmodelledObject& b) { return a.points > b.points; });
  return pieces;
}

std::vector<UnmodelledObject> pieces_of(const std::vector<Vector3d>& points, double cell_m,
                                        std::size_t min_points, const Vector3d& low, const Vector3d& high) {
  UnmodelledPoints loose(cell_m);
  for (const Vector3d& x : points) loose.add(x);
  return loose.pieces(min_points, low, high);
}

}  // namespace limen
