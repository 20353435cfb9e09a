// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/unmodelled.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

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

}  // namespace

std::vector<UnmodelledMatter> pieces_of(const std::vector<Vector3d>& points, double cell_m,
                                        std::size_t min_points, const Vector3d& low, const Vector3d& high) {
  std::unordered_map<std::uint64_t, std::size_t> cubes;
  std::vector<std::uint64_t> keys;  // of the cubes, as they came
  std::vector<std::size_t> cube_of_point;
  for (const Vector3d& x : points) {
    const std::uint64_t key = key_of(x, cell_m);
    const auto [it, fresh] = cubes.try_emplace(key, keys.size());
    if (fresh) keys.push_back(key);
    cube_of_point.push_back(it->second);
  }
  DisjointSets joined(keys.size());  // cubes, with their neighbours
  for (std::size_t k = 0; k < keys.size(); ++k) {
    for (std::uint64_t n = 0; n < 27; ++n) {
      const std::uint64_t step = ((n % 3) << 42U) + ((n / 3 % 3) << 21U) + n / 9;
      const std::uint64_t back = (std::uint64_t{1} << 42U) + (std::uint64_t{1} << 21U) + 1;
      const auto other = cubes.find(keys[k] + step - back);
      if (other != cubes.end()) joined.join(k, other->second);
    }
  }
  std::vector<UnmodelledMatter> pieces(keys.size());
  for (UnmodelledMatter& piece : pieces) {
    piece.low = Vector3d::Constant(1e300);
    piece.high = Vector3d::Constant(-1e300);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    UnmodelledMatter& piece = pieces[joined.find(cube_of_point[i])];
    ++piece.points;
    piece.low = piece.low.cwiseMin(points[i]);
    piece.high = piece.high.cwiseMax(points[i]);
    piece.centre += points[i];
  }
  std::erase_if(pieces, [&](const UnmodelledMatter& piece) {
    return piece.points < std::max<std::size_t>(1, min_points);
  });
  for (UnmodelledMatter& piece : pieces) {
    piece.centre /= static_cast<double>(piece.points);
    piece.within_model =
        (piece.centre.array() >= low.array()).all() && (piece.centre.array() <= high.array()).all();
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const UnmodelledMatter& a, const UnmodelledMatter& b) { return a.points > b.points; });
  return pieces;
}

}  // namespace limen
