// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "limen/project/adjust/plane_adjustment.h"
#include "limen/register/prepare/pass_track.h"

namespace limen {

/// A mobile pass that is to be bent, before anything is known of its drift.
struct PassToBend {
  int node = -1;
  const PassWay* way = nullptr;  ///< outlives the bending
  double drift_m = 0.0;          ///< what is known of it beforehand, one standard deviation per axis ...
  double believed = 0.1;         ///< ... as much as so many numbers of the data
  /// Of the random walk of turns, where it is known; else it is learned.
  std::optional<double> turn_rate_rad2_per_m = {};
};

/// By how much the points of a pass move at a knot, against what its pose alone says.
struct BentKnot {
  Vector6d value = Vector6d::Zero();  ///< turn about the node's origin and shift; frame axes, SI
  /// Of the turn, and of the shift of the knot's own place; what the spline cannot follow is in it.
  Matrix6d covariance = Matrix6d::Zero();
};

/// A pass as it was bent.
struct BentPass {
  int node = -1;
  Rigid3 frame_from_node;            ///< of the pass as a whole
  std::vector<BentKnot> knots;       ///< as many as its way has
  double shift_rate_m2_per_m = 0.0;  ///< of the random walk along the way, per axis
  double turn_rate_rad2_per_m = 0.0;
};

/// Bends mobile passes within a joint adjustment. T(t) = exp(xi(t)) T_given, xi a natural cubic spline along
/// the way; its control points are nodes of the adjustment, chained by a random walk whose rates are
/// estimated from the data (evidence of a linear Gaussian model: MacKay, Bayesian interpolation, 1992,
/// sec. 4.4), with some belief in what is known beforehand. The pass as a whole is the mean of its
/// control points.
class BentPasses {
 public:
  explicit BentPasses(const std::vector<PassToBend>& passes);

  [[nodiscard]] bool any() const { return !passes_.empty(); }
  [[nodiscard]] bool bends(int node) const { return of_node_.count(node) > 0; }

  /// Makes the pass's node a blend of nodes that are added for its control points. Where the node was fixed,
  /// the control point in the middle is instead. Call once per problem, after all scans have a node.
  void add_to(JointProblem& problem);
  /// A node that is added to the problem for the mean of places along the way, in knots; `unreported`: nobody
  /// asks for its covariance.
  int node_at(JointProblem& problem, int node, const std::vector<double>& places,
              bool unreported = true) const;
  /// The pass as it is bent so far, there.
  [[nodiscard]] Rigid3 pose_at(int node, const Rigid3& frame_from_node, double place) const;

  /// What a walk strays between its knots from the spline through them, one standard deviation per axis.
  [[nodiscard]] double unfollowed_m(int node) const;

  /// Where a pass that was fixed gave the frame: the same solution with that pass, as a whole, where it was.
  /// `component` of each node, by which nodes are moved together; knots go with their pass.
  void settle_frames(const JointProblem& problem, const std::vector<int>& component,
                     JointSolution& solution) const;
  /// Takes the shape of the passes from the solution, and the rates that make it most probable. Returns the
  /// largest change of a rate, as a factor.
  double take(const JointProblem& problem, const JointSolution& solution);
  /// Of the random walks along the way, per axis, as they are learned so far.
  struct Rates {
    double shift_m2_per_m = 0.0;
    double turn_rad2_per_m = 0.0;
  };
  [[nodiscard]] Rates rates_of(int node) const;
  /// How far a walk of that rate strays from its own mean over a length, one standard deviation.
  [[nodiscard]] static double strays_m(double rate_m2_per_m, double length_m);
  /// The passes as they were bent by a solution.
  [[nodiscard]] std::vector<BentPass> stated(const JointSolution& solution) const;

 private:
  struct Pass {
    PassToBend given;
    double shift_rate = 0.0;
    double turn_rate = 0.0;
    double first_shift_rate = 0.0;
    double first_turn_rate = 0.0;
    std::vector<Vector6d> controls;
    // Of the last problem:
    bool was_fixed = false;
    std::vector<int> nodes;        // of the control points
    std::vector<int> differences;  // nodes that tell how well each knot is known against the whole
    std::vector<std::size_t> chain;
  };

  void add_nodes(Pass& pass, JointProblem& problem);
  void add_chain(Pass& pass, JointProblem& problem);
  [[nodiscard]] const Pass& pass_of(int node) const { return passes_[of_node_.at(node)]; }
  [[nodiscard]] static double unfollowed_m2(const Pass& pass);

  std::vector<Pass> passes_;
  std::map<int, std::size_t> of_node_;
};

}  // namespace limen
