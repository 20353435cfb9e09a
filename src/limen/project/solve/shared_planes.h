// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "limen/base/disjoint_sets.h"
#include "limen/project/adjust/plane_adjustment.h"
#include "limen/project/graph/pose_graph.h"
#include "limen/project/graph/viewpoints.h"
#include "limen/project/passes/bent_passes.h"
#include "limen/project/state/project_node.h"

namespace limen {

/// Planes of all scans, those that are one surface joined.
class SharedPlanes {
 public:
  /// `solved`: the poses by which planes are compared; `passes` as they are bent so far. All outlive this.
  SharedPlanes(const std::vector<ProjectNode>& nodes, const SolvedGraph& solved, const BentPasses& passes);

  /// Joins two planes where they lie in one under the solved poses and under the pair's own. Both scans saw
  /// `match.overlap_m2` of them: what one saw beyond may be another wall, built some millimetres off.
  void join(const PoseEdge& edge, const PlaneMatch& match);

  /// Adds the observations of the planes that two nodes or more see, or a bent pass at two times: of a bent
  /// pass strip by strip, and of what it sees patch by patch, for long walls bend.
  void tell(const std::vector<bool>& taken, JointProblem& problem);

  /// A plane of a pass, and that of another scan which is the same surface.
  struct SeenByBoth {
    int plane = -1;
    const PlaneDigest* other = nullptr;
  };
  /// Where along its way a pass saw what it shares with another scan, in knots: places that part the tiles of
  /// these planes evenly, as far as the other scan saw them.
  [[nodiscard]] std::vector<double> places_of(int node, const std::vector<SeenByBoth>& seen,
                                              const Rigid3& other_from_node) const;

 private:
  /// A patch of a surface: its planes' root, and a square of it.
  using PatchKey = std::tuple<std::size_t, int, int>;
  struct Seen {
    PlaneObservation observation;
    std::pair<std::size_t, int> from;  ///< the node, and of a bent pass the part of its way
    double place = 0.0;                ///< along it
  };

  template <typename Visit>
  void for_each(const Visit& visit);
  [[nodiscard]] const ScanDigest& digest(std::size_t node) const { return nodes_[node].digest; }
  /// `views`: how many scans from its place see the surface.
  [[nodiscard]] PlaneObservation whole_plane(std::size_t node, std::size_t plane, std::size_t views) const;
  [[nodiscard]] Seen seen_strip(std::size_t node, std::size_t strip) const;
  void tell_patches(std::size_t root, const std::vector<std::pair<std::size_t, std::size_t>>& members,
                    JointProblem& problem);
  void keep(const std::map<PatchKey, std::vector<Seen>>& patches, JointProblem& problem) const;

  const std::vector<ProjectNode>& nodes_;
  const SolvedGraph& solved_;
  const BentPasses& passes_;
  std::vector<std::size_t> first_;
  Viewpoints viewpoints_;
  DisjointSets surfaces_;  ///< planes that are one, of all nodes
  /// Of each plane the shares that scans from other places saw as well: their sum, and how many.
  std::vector<std::pair<double, int>> common_;
  std::vector<std::vector<std::vector<std::size_t>>> strips_;  // of each plane of each node
};

}  // namespace limen
