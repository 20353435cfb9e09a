// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "limen/project/graph/pair_evidence.h"
#include "limen/project/graph/pose_graph.h"

namespace limen {

/// Which scans lie in one frame, and where.
struct Configuration {
  std::vector<Rigid3> frame_from_node;  ///< in the frame of the component's first node
  std::vector<int> component;           ///< of each node: the lowest node of its component
  std::vector<int> pose;  ///< of each link: the pose that the configuration agrees with; -1: none

  [[nodiscard]] Rigid3 target_from_source(const GraphLink& link) const;
  [[nodiscard]] bool joins(const GraphLink& link) const;
};

/// Which poses of links agree with a placement.
class LinkMatcher {
 public:
  explicit LinkMatcher(const PoseGraph& graph);

  /// The pose of a link that is nearest to `target_from_source`, if its squared distance in standard
  /// deviations is no more than `gate` times kChiSquareBound; -1: none.
  [[nodiscard]] int nearest(std::size_t link, const Rigid3& target_from_source, double gate) const;
  /// A pose that was found to lay a side where it is not: no placement agrees with it from then on.
  void leave_out(std::size_t link, int pose) { left_out_[link][static_cast<std::size_t>(pose)] = true; }
  [[nodiscard]] bool is_left_out(std::size_t link, std::size_t pose) const { return left_out_[link][pose]; }
  /// What the pair says of one of its poses.
  [[nodiscard]] const PairEvidence& evidence(std::size_t link, int pose) const;

 private:
  const PoseGraph& graph_;
  std::vector<std::vector<Matrix6d>> information_;
  std::vector<std::vector<PairEvidence>> evidence_;
  std::vector<std::vector<bool>> left_out_;
};

/// What all pairs between two sets of nodes say together of one placement of the two against each other. That
/// the two show look-alike places is believed once, whatever number of pairs would be explained by it.
class JoinEvidence {
 public:
  void add(const PairEvidence& evidence);

  /// Against every other explanation, where look-alike places are as frequent as that, against what is
  /// believed beforehand; 0: no pair agrees.
  [[nodiscard]] double nats(double rate = 1.0) const;
  [[nodiscard]] double nats_against_chance() const { return chance_ - first_; }

 private:
  bool any_ = false;
  double chance_ = 0.0;
  double first_ = 0.0;  ///< the first pair that joins the two closes no loop
  LookAlikeSum look_alike_;
  double prior_otherwise_ = 0.0;
  double prior_alike_ = 0.0;
};

/// The configuration that the pairs agree on best. Parts are joined step by step, each time the two parts
/// whose best placement leads its rivals most, by the sum over all pairs between them; then scans and parts
/// are moved to every place that any pose of a link proposes, as long as that sum grows, and least squares
/// settles the poses.
Configuration best_configuration(const PoseGraph& graph, const LinkMatcher& matcher);

/// Joins the parts of a configuration further, and settles it.
void join_parts(const PoseGraph& graph, const LinkMatcher& matcher, Configuration& configuration);

/// What no agreeing link joins any more becomes a component of its own.
void find_components(const PoseGraph& graph, Configuration& configuration);

}  // namespace limen
