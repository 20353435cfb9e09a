// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/passes/bent_passes.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/spline_motion.h"

namespace limen {
namespace {

constexpr double kLeastDriftM = 0.001;
constexpr double kMostDriftM = 0.2;
constexpr double kTurnAtM = 30.0;  // a turn moves what lies so far off as much as the shift does
// Nothing drifts less than this: rates stay positive.
constexpr double kLeastRateM2 = 1e-10;  // 0.1 mm over 100 m
// A cubic spline fitted to a random walk leaves so much of what it walks from knot to knot, squared: measured
// on simulated drives (bench_passes, "own spline").
constexpr double kUnfollowed = 0.1;
constexpr double kMostFaster = 30.0;  // of a rate, from one round to the next

double length_of(const PassWay& way) {
  return way.distances_m.back() - way.distances_m.front();
}

/// A motion of a node by its turn about the node's origin and its shift.
Rigid3 bent(const Rigid3& frame_from_node, const Vector6d& by) {
  return {rotation_exp(by.head<3>()) * frame_from_node.rotation, frame_from_node.translation + by.tail<3>()};
}
Vector6d bend_between(const Rigid3& whole, const Rigid3& part) {
  Vector6d by;
  by << rotation_log(part.rotation * whole.rotation.transpose()), part.translation - whole.translation;
  return by;
}

Matrix6d walked(double shift_m2, double turn_rad2) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << turn_rad2, turn_rad2, turn_rad2, shift_m2, shift_m2, shift_m2;
  return covariance;
}

/// Adds a node that has no freedoms of its own.
int add_blend(JointProblem& problem, const NodeBlend& blend, const Rigid3& pose, bool unreported) {
  const std::size_t number = problem.frame_from_node.size();
  problem.frame_from_node.push_back(pose);
  problem.fixed.push_back(false);
  problem.blends.resize(number + 1);
  problem.blends[number] = blend;
  problem.unreported.resize(number + 1, false);
  problem.unreported[number] = unreported;
  return static_cast<int>(number);
}

/// The rate of a walk, from its steps.
struct WalkEvidence {
  double squares = 0.0;  // of the steps, per metre
  double numbers = 0.0;  // of steps that the data hold
};

}  // namespace

BentPasses::BentPasses(const std::vector<PassToBend>& passes) {
  for (const PassToBend& given : passes) {
    Pass pass;
    pass.given = given;
    const double drift = std::clamp(given.drift_m, kLeastDriftM, kMostDriftM);
    const double steps = drift / strays_m(1.0, length_of(*given.way));
    pass.first_shift_rate = pass.shift_rate = steps * steps;
    pass.turn_rate = given.turn_rate_rad2_per_m.value_or(pass.shift_rate / (kTurnAtM * kTurnAtM));
    pass.first_turn_rate = pass.turn_rate;
    pass.controls.assign(given.way->times_s.size(), Vector6d::Zero());
    of_node_.emplace(given.node, passes_.size());
    passes_.push_back(std::move(pass));
  }
}

void BentPasses::add_to(JointProblem& problem) {
  for (Pass& pass : passes_) {
    add_nodes(pass, problem);
    add_chain(pass, problem);
  }
}

void BentPasses::add_nodes(Pass& pass, JointProblem& problem) {
  const auto own = static_cast<std::size_t>(pass.given.node);
  const std::size_t count = pass.controls.size();
  const Rigid3 whole = problem.frame_from_node[own];
  pass.was_fixed = problem.fixed[own];
  pass.nodes.clear();
  NodeBlend mean;
  for (std::size_t k = 0; k < count; ++k) {
    pass.nodes.push_back(static_cast<int>(problem.frame_from_node.size()));
    problem.frame_from_node.push_back(bent(whole, pass.controls[k]));
    problem.fixed.push_back(pass.was_fixed && k == count / 2);
    mean.emplace_back(pass.nodes.back(), 1.0 / static_cast<double>(count));
  }
  problem.fixed[own] = false;
  problem.blends.resize(problem.frame_from_node.size());
  problem.blends[own] = mean;
  problem.unreported.resize(problem.frame_from_node.size(), false);
  for (const int node : pass.nodes) problem.unreported[static_cast<std::size_t>(node)] = true;
  pass.differences.clear();
  for (std::size_t k = 0; k < count; ++k) {
    NodeBlend difference;
    for (const SplineShare& share : spline_shares(static_cast<int>(count), static_cast<double>(k)))
      difference.emplace_back(pass.nodes[static_cast<std::size_t>(share.control)], share.weight);
    for (const auto& [node, weight] : mean) difference.emplace_back(node, -weight);
    pass.differences.push_back(add_blend(problem, difference, whole, false));
  }
}

void BentPasses::add_chain(Pass& pass, JointProblem& problem) {
  const PassWay& way = *pass.given.way;
  pass.chain.clear();
  for (std::size_t k = 0; k + 1 < pass.nodes.size(); ++k) {
    const double metres = way.distances_m[k + 1] - way.distances_m[k];
    PoseEdge edge;
    edge.source = pass.nodes[k];
    edge.target = pass.nodes[k + 1];
    edge.pose.centre = 0.5 * (way.places[k] + way.places[k + 1]);
    edge.pose.covariance = walked(metres * pass.shift_rate, metres * pass.turn_rate);
    edge.stated = true;
    pass.chain.push_back(problem.edges.size());
    problem.edges.push_back(edge);
  }
}

int BentPasses::node_at(JointProblem& problem, int node, const std::vector<double>& places,
                        bool unreported) const {
  const Pass& pass = pass_of(node);
  std::map<int, double> weights;
  Vector6d by = Vector6d::Zero();
  for (const double place : places) {
    for (const SplineShare& share : spline_shares(static_cast<int>(pass.nodes.size()), place)) {
      const auto control = static_cast<std::size_t>(share.control);
      const double weight = share.weight / static_cast<double>(places.size());
      weights[pass.nodes[control]] += weight;
      by += weight * pass.controls[control];
    }
  }
  const Rigid3& whole = problem.frame_from_node[static_cast<std::size_t>(node)];
  return add_blend(problem, NodeBlend(weights.begin(), weights.end()), bent(whole, by), unreported);
}

Rigid3 BentPasses::pose_at(int node, const Rigid3& frame_from_node, double place) const {
  const Pass& pass = pass_of(node);
  Vector6d by = Vector6d::Zero();
  for (const SplineShare& share : spline_shares(static_cast<int>(pass.controls.size()), place))
    by += share.weight * pass.controls[static_cast<std::size_t>(share.control)];
  return bent(frame_from_node, by);
}

double BentPasses::unfollowed_m2(const Pass& pass) {
  const double spans = static_cast<double>(pass.controls.size() - 1);
  return kUnfollowed * pass.shift_rate * length_of(*pass.given.way) / spans;
}

double BentPasses::unfollowed_m(int node) const {
  return std::sqrt(unfollowed_m2(pass_of(node)));
}

void BentPasses::settle_frames(const JointProblem& problem, const std::vector<int>& component,
                               JointSolution& solution) const {
  for (const Pass& pass : passes_) {
    if (!pass.was_fixed) continue;
    const auto own = static_cast<std::size_t>(pass.given.node);
    const Rigid3 back = problem.frame_from_node[own] * inverse(solution.frame_from_node[own]);
    const auto move = [&](int node) {
      Rigid3& pose = solution.frame_from_node[static_cast<std::size_t>(node)];
      pose = back * pose;
    };
    for (std::size_t n = 0; n < component.size(); ++n) {
      if (component[n] != component[own]) continue;
      move(static_cast<int>(n));
      if (!bends(static_cast<int>(n))) continue;
      for (const int node : pass_of(static_cast<int>(n)).nodes) move(node);
    }
    solution.frame_from_node[own] = problem.frame_from_node[own];
    solution.covariance[own].setZero();
  }
}

double BentPasses::take(const JointProblem& problem, const JointSolution& solution) {
  double change = 1.0;
  for (Pass& pass : passes_) {
    const auto pose = [&](int node) { return solution.frame_from_node[static_cast<std::size_t>(node)]; };
    for (std::size_t k = 0; k < pass.controls.size(); ++k)
      pass.controls[k] = bend_between(pose(pass.given.node), pose(pass.nodes[k]));
    WalkEvidence turns;
    WalkEvidence shifts;
    for (const std::size_t e : pass.chain) {
      const PoseEdge& edge = problem.edges[e];
      const Vector6d step = edge_residual(edge, pose(edge.source), pose(edge.target)).value;
      const Matrix6d& left = solution.edge_covariance[e];
      const double metres = edge.pose.covariance(3, 3) / pass.shift_rate;
      turns.squares += step.head<3>().squaredNorm() / metres;
      shifts.squares += step.tail<3>().squaredNorm() / metres;
      // What the covariance has shrunk by is what the data know.
      turns.numbers += std::max(0.0, 3.0 - left.topLeftCorner<3, 3>().trace() / edge.pose.covariance(0, 0));
      shifts.numbers +=
          std::max(0.0, 3.0 - left.bottomRightCorner<3, 3>().trace() / edge.pose.covariance(3, 3));
    }
    const auto improve = [&](const WalkEvidence& evidence, double first, double least, double& rate) {
      const double wanted =
          (pass.given.believed * first + evidence.squares) / (pass.given.believed + evidence.numbers);
      const double next = std::max(least, std::clamp(wanted, rate / kMostFaster, rate * kMostFaster));
      change = std::max({change, next / rate, rate / next});
      rate = next;
    };
    improve(shifts, pass.first_shift_rate, kLeastRateM2, pass.shift_rate);
    if (!pass.given.turn_rate_rad2_per_m)
      improve(turns, pass.first_turn_rate, kLeastRateM2 / (kTurnAtM * kTurnAtM), pass.turn_rate);
  }
  return change;
}

BentPasses::Rates BentPasses::rates_of(int node) const {
  return {pass_of(node).shift_rate, pass_of(node).turn_rate};
}

double BentPasses::strays_m(double rate_m2_per_m, double length_m) {
  // A walk of rate q has q L / 6 about its own mean, squared.
  return std::sqrt(rate_m2_per_m * length_m / 6.0);
}

std::vector<BentPass> BentPasses::stated(const JointSolution& solution) const {
  std::vector<BentPass> stated;
  for (const Pass& pass : passes_) {
    const auto pose = [&](int node) { return solution.frame_from_node[static_cast<std::size_t>(node)]; };
    BentPass bent_pass;
    bent_pass.node = pass.given.node;
    bent_pass.frame_from_node = pose(pass.given.node);
    bent_pass.shift_rate_m2_per_m = pass.shift_rate;
    bent_pass.turn_rate_rad2_per_m = pass.turn_rate;
    const auto count = static_cast<int>(pass.nodes.size());
    for (int k = 0; k < count; ++k) {
      BentKnot knot;
      for (const SplineShare& share : spline_shares(count, k))
        knot.value += share.weight * bend_between(bent_pass.frame_from_node,
                                                  pose(pass.nodes[static_cast<std::size_t>(share.control)]));
      // A turn about the node's origin moves the knot's own place.
      const Vector3d lever =
          bent_pass.frame_from_node.rotation * pass.given.way->places[static_cast<std::size_t>(k)];
      Matrix6d there = Matrix6d::Identity();
      there.bottomLeftCorner<3, 3>() = -skew(lever);
      const int difference = pass.differences[static_cast<std::size_t>(k)];
      knot.covariance = there * solution.covariance[static_cast<std::size_t>(difference)] * there.transpose();
      knot.covariance.diagonal().tail<3>().array() += unfollowed_m2(pass);
      bent_pass.knots.push_back(knot);
    }
    stated.push_back(std::move(bent_pass));
  }
  return stated;
}

}  // namespace limen
