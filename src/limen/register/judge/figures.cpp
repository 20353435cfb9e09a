// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/judge/figures.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "limen/geometry/joined_points.h"

namespace limen {
namespace {

constexpr double kJoinedM = 0.3;  // pieces of one thing: cubes of 10 to 20 cm, and some that were not seen
constexpr double kFigureReachM = 0.5;  // level, from the middle: shoulders, an arm, a bag
constexpr double kLeastExtentM = 0.6;  // of what is seen of a person, in height
constexpr double kMostExtentM = 2.0;
constexpr double kLeastTopM = 1.3;  // above the floor: what is lower may be a chair
constexpr double kMostTopM = 2.1;

bool is_figure(const std::vector<Vector3d>& pieces, const std::vector<std::size_t>& thing,
               const FloorBelow& floor_below) {
  Vector3d middle = Vector3d::Zero();
  double low = pieces[thing.front()].z();
  double high = low;
  for (const std::size_t i : thing) {
    middle += pieces[i];
    low = std::min(low, pieces[i].z());
    high = std::max(high, pieces[i].z());
  }
  if (high - low < kLeastExtentM || high - low > kMostExtentM) return false;
  middle /= static_cast<double>(thing.size());
  const bool narrow = std::all_of(thing.begin(), thing.end(), [&](std::size_t i) {
    return (pieces[i] - middle).head<2>().squaredNorm() < kFigureReachM * kFigureReachM;
  });
  if (!narrow) return false;
  const std::optional<double> floor = floor_below(middle);
  return !floor || (high - *floor > kLeastTopM && high - *floor < kMostTopM);
}

}  // namespace

std::vector<int> find_figures(const std::vector<Vector3d>& pieces, const FloorBelow& floor_below) {
  DisjointSets sets = joined_points(pieces, kJoinedM);
  std::vector<std::vector<std::size_t>> things(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) things[sets.find(i)].push_back(i);
  std::vector<int> figures(pieces.size(), -1);
  int number = 0;
  for (const std::vector<std::size_t>& thing : things) {
    if (thing.empty() || !is_figure(pieces, thing, floor_below)) continue;
    for (const std::size_t i : thing) figures[i] = number;
    ++number;
  }
  return figures;
}

}  // namespace limen
