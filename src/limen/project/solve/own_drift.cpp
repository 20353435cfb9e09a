// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/own_drift.h"

#include <cstddef>

#include "limen/base/parallel.h"
#include "limen/project/solve/joint_problem.h"

namespace limen {
namespace {

// What planes show by their relief: as much as so many numbers that the pass shows by itself.
constexpr double kBelieved = 10.0;

OwnDrift own_drift(const ProjectNode& node) {
  const PassWay& way = node.digest.track.way;
  BentPasses passes({{0, &way, node.digest.drift_m, kBelieved, {}}});
  const std::vector<ProjectNode> alone{node};
  ProjectGraph made;
  made.graph.nodes = 1;
  SolvedGraph solved;
  solved.nodes.resize(1);
  solved.nodes.front().component = 0;
  PlacedSurvey none;
  none.controlled.assign(1, false);
  bend(alone, {}, made, solved, none, passes);
  const BentPasses::Rates rates = passes.rates_of(0);
  const double length = way.distances_m.back() - way.distances_m.front();
  return {BentPasses::strays_m(rates.shift_m2_per_m, length), rates.turn_rad2_per_m};
}

}  // namespace

void learn_own_drift(std::vector<ProjectNode>& nodes) {
  parallel_for(nodes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const ScanDigest& digest = nodes[n].digest;
      if (digest.mobile && digest.track.way.known()) nodes[n].drift = own_drift(nodes[n]);
    }
  });
}

}  // namespace limen
