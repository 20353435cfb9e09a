// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/match/segments/parallel_rotations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/base/angles.h"
#include "limen/geometry/rotation_between.h"

namespace limen {
namespace {

constexpr std::size_t kSourceLines = 40;  // longest ones that are paired
constexpr std::size_t kTargetLines = 150;
constexpr double kLeastApartM = 0.5;  // nearer lines say little of a turn
constexpr double kSameDistanceM = 0.05;
constexpr std::size_t kBins = 360;

/// Two parallel lines: how far apart, the direction from one to the other, and what they weigh.
struct Pair {
  double apart_m;
  double angle;
  double weight;
};

/// Pairs of the longest lines along `axis`, after `turn`, seen along `normal`; nearest first.
std::vector<Pair> pairs_of(const VotingSegments& set, const Matrix3d& turn, const Vector3d& normal,
                           double direction_deg, std::size_t most) {
  const PlaneFrame frame = make_frame({normal, 0.0}, Vector3d::Zero());
  std::vector<Vector2d> places;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < set.size() && places.size() < most; ++i) {
    if (std::abs((turn * set.directions[i]).dot(normal)) < std::cos(radians(direction_deg))) continue;
    places.push_back(frame.to_plane(turn * set.middles[i]));
    lengths.push_back(set.lengths_m[i]);
  }
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      const Vector2d way = places[j] - places[i];
      if (way.norm() < kLeastApartM) continue;
      pairs.push_back({way.norm(), std::atan2(way.y(), way.x()), std::min(lengths[i], lengths[j])});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.apart_m < b.apart_m; });
  return pairs;
}

/// Votes for turns, 1 degree each.
std::vector<double> votes_for_turns(const std::vector<Pair>& source, const std::vector<Pair>& target) {
  std::vector<double> votes(kBins, 0.0);
  for (const Pair& a : source) {
    auto it = std::lower_bound(target.begin(), target.end(), a.apart_m - kSameDistanceM,
                               [](const Pair& pair, double apart) { return pair.apart_m < apart; });
    for (; it != target.end() && it->apart_m <= a.apart_m + kSameDistanceM; ++it) {
      const double turn = (it->angle - a.angle) / (2.0 * std::numbers::pi) + 2.0;
      const double place = turn * static_cast<double>(kBins);
      const auto bin = static_cast<std::size_t>(place);
      const double share = place - static_cast<double>(bin);
      const double weight = std::min(a.weight, it->weight);
      votes[bin % kBins] += (1.0 - share) * weight;
      votes[(bin + 1) % kBins] += share * weight;
    }
  }
  return votes;
}

}  // namespace

std::vector<Matrix3d> parallel_rotations(const VotingSegments& source, const VotingSegments& target,
                                         const AxisDirection& source_axis, const AxisDirection& target_axis,
                                         const RotationOptions& options) {
  constexpr std::size_t kMostTurns = 24;
  struct Turn {
    double votes;
    Matrix3d rotation;
  };
  std::vector<Turn> turns;
  const Vector3d& normal = target_axis.direction;
  const std::vector<Pair> to =
      pairs_of(target, Matrix3d::Identity(), normal, options.direction_deg, kTargetLines);
  for (const double sense : {1.0, -1.0}) {
    const Matrix3d start = rotation_between(sense * source_axis.direction, normal);
    if (options.gravity_known && start(2, 2) < std::cos(radians(options.gravity_tolerance_deg))) continue;
    const std::vector<double> votes =
        votes_for_turns(pairs_of(source, start, normal, options.direction_deg, kSourceLines), to);
    for (std::size_t k = 0; k < kBins; ++k) {
      if (!(votes[k] > 0.0) || votes[k] < votes[(k + 1) % kBins] ||
          votes[k] <= votes[(k + kBins - 1) % kBins])
        continue;
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kBins);
      turns.push_back({votes[k], rotation_exp(angle * normal) * start});
    }
  }
  std::stable_sort(turns.begin(), turns.end(),
                   [](const Turn& a, const Turn& b) { return a.votes > b.votes; });
  if (turns.size() > kMostTurns) turns.resize(kMostTurns);
  std::vector<Matrix3d> rotations;
  for (const Turn& turn : turns) rotations.push_back(turn.rotation);
  return rotations;
}

}  // namespace limen
