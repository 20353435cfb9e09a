// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/straighten_links.h"

#include <cmath>
#include <vector>

#include "support/synthetic_street.h"
#include <gtest/gtest.h>

#include "limen/project/solve/own_drift.h"
#include "limen/project/solve/project_graph.h"

namespace limen {
namespace {

/// Stations along a street, each linked to a pass that strays by 5 cm, and to one another where they are
/// near. All stand in the world's frame in truth.
struct StrayedStreet {
  std::vector<double> places{4.0, 12.0, 20.0, 28.0, 36.0};
  std::vector<ProjectNode> nodes;
  std::vector<TriedPair> pairs;
  SyntheticStreet street{0.05, 2};

  StrayedStreet() {
    nodes.push_back(street.pass());
    nodes.front().digest.drift_m = 0.03;
    for (const double place : places) nodes.push_back(street.station(SyntheticStreet::x_of(place)));
    learn_own_drift(nodes);
    for (std::size_t s = 1; s < nodes.size(); ++s) {
      add(s, 0, -seen_strayed(places[s - 1]), 0.03);
      if (s > 1) add(s, s - 1, Vector3d::Zero(), 0.002);
    }
  }

  /// In the mean over what a station sees of the street.
  [[nodiscard]] Vector3d seen_strayed(double place) const {
    Vector3d sum = Vector3d::Zero();
    double count = 0.0;
    for (double along = -11.0; along < 12.0; along += 2.0) {
      for (double part = 0.5; part < SyntheticStreet::kKnots - 1; part += 1.0) {
        const double ahead = SyntheticStreet::x_of(part) - SyntheticStreet::x_of(place) - along;
        if (std::abs(ahead) > SyntheticStreet::kPassSeesM) continue;
        sum += street.strayed(part);
        count += 1.0;
      }
    }
    return sum / count;
  }

  /// A pair's pose that is off by what the pass has strayed where the two meet.
  void add(std::size_t source, std::size_t target, const Vector3d& off, double sigma_m) {
    TriedPair pair{source, target, {}};
    RegistrationResult& found = pair.result;
    found.outcome = Outcome::registered;
    found.best.target_from_source.translation = target == 0 ? Vector3d(-off) : off;
    found.best.probability = 0.9999;
    found.best.score = found.best.agreeing_m2 = 60.0;
    found.others = OtherExplanations{0.0, 1e-5, 0.0};
    found.sigma.centre = {SyntheticStreet::x_of(places[source - 1]), 0.0, 1.0};
    found.sigma.translation_m.setConstant(sigma_m);
    found.sigma.rotation_rad.setConstant(sigma_m / 10.0);
    found.best.sigma = found.sigma;
    Vector6d variances;
    variances << Vector3d::Constant(sigma_m * sigma_m / 100.0), Vector3d::Constant(sigma_m * sigma_m);
    found.best.sigma.covariance = variances.asDiagonal();
    for (int k = 0; k < SyntheticStreet::kPlanes; ++k) {
      if (nodes[source].digest.planes[static_cast<std::size_t>(k)].moments.count < 3.0) continue;
      if (nodes[target].digest.planes[static_cast<std::size_t>(k)].moments.count < 3.0) continue;
      PlaneMatch match;
      match.source = match.target = k;
      match.overlap_m2 = 8.0;
      found.matches.push_back(match);
    }
    pairs.push_back(pair);
  }
};

/// By how much links with the pass miss one another, before and after; root of the sum of squares.
struct Missed {
  double before_m = 0.0;
  double after_m = 0.0;
};

Missed missed_by(const StrayedStreet& made, const ProjectGraph& graph, const SolvedGraph& solved) {
  const std::optional<PoseGraph> straight = straightened(made.nodes, made.pairs, graph, solved);
  Missed missed;
  EXPECT_TRUE(straight.has_value());
  if (!straight) return missed;
  EXPECT_EQ(straight->links.size(), graph.graph.links.size());
  const auto shift = [](const GraphLink& link) { return link.poses.front().target_from_source.translation; };
  PointMoments before;
  PointMoments after;
  for (std::size_t k = 0; k < straight->links.size(); ++k) {
    const GraphLink& link = graph.graph.links[k];
    if (link.target != 0) {
      EXPECT_EQ(shift(straight->links[k]), shift(link));
      continue;
    }
    before.add(shift(link));
    after.add(shift(straight->links[k]));
    // It is known better than a pass as a whole is.
    EXPECT_LT(straight->links[k].poses.front().covariance(3, 3), link.poses.front().covariance(3, 3));
  }
  // The pass as a whole is where its mean is.
  return {std::sqrt(before.covariance().trace()), std::sqrt(after.covariance().trace())};
}

TEST(StraightenLinks, ALinkMeasuresWhereThePassStoodThen) {
  const StrayedStreet made;
  const ProjectGraph graph = make_graph(made.nodes, made.pairs, {});
  SolvedGraph solved = solve_graph(graph.graph, 0.001);
  const Missed missed = missed_by(made, graph, solved);
  EXPECT_GT(missed.before_m, 0.04);
  EXPECT_LT(missed.after_m, 0.25 * missed.before_m);
  // The same where no scan is the frame: all stand by control points.
  for (SolvedNode& node : solved.nodes) node.covariance = 1e-6 * Matrix6d::Identity();
  EXPECT_LT(missed_by(made, graph, solved).after_m, 0.25 * missed.before_m);
}

TEST(StraightenLinks, WithoutPassesThereIsNothingToStraighten) {
  StrayedStreet made;
  made.nodes.front().digest.track.way = {};
  const ProjectGraph graph = make_graph(made.nodes, made.pairs, {});
  const SolvedGraph solved = solve_graph(graph.graph, 0.001);
  EXPECT_FALSE(straightened(made.nodes, made.pairs, graph, solved).has_value());
}

}  // namespace
}  // namespace limen
