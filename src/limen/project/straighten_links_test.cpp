// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include "support/synthetic_street.h"
#include <gtest/gtest.h>

#include "limen/project/own_drift.h"
#include "limen/project/project_graph.h"

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
      add(s, 0, -street.strayed(places[s - 1]), 0.03);
      if (s > 1) add(s, s - 1, Vector3d::Zero(), 0.002);
    }
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

TEST(StraightenLinks, ALinkMeasuresWhereThePassStoodThen) {
  const StrayedStreet made;
  const ProjectGraph graph = make_graph(made.nodes, made.pairs, 0.001, {});
  const SolvedGraph solved = solve_graph(graph.graph, 0.001);
  const std::optional<PoseGraph> straight = straightened(made.nodes, made.pairs, graph, solved);
  ASSERT_TRUE(straight.has_value());
  ASSERT_EQ(straight->links.size(), graph.graph.links.size());
  double before = 0.0;
  double after = 0.0;
  Vector3d offset = Vector3d::Zero();  // the pass as a whole is where its mean is
  const auto missed = [&](const GraphLink& link) {
    return link.poses.front().target_from_source.translation;
  };
  int links = 0;
  for (const GraphLink& link : straight->links) {
    if (link.target != 0) continue;
    offset += missed(link);
    ++links;
  }
  ASSERT_EQ(links, 5);
  offset /= links;
  for (std::size_t k = 0; k < straight->links.size(); ++k) {
    const GraphLink& link = graph.graph.links[k];
    if (link.target != 0) {
      EXPECT_EQ(missed(straight->links[k]), missed(link));
      continue;
    }
    before += missed(link).squaredNorm();
    after += (missed(straight->links[k]) - offset).squaredNorm();
    // It is known better than a pass as a whole is.
    EXPECT_LT(straight->links[k].poses.front().covariance(3, 3), link.poses.front().covariance(3, 3));
  }
  EXPECT_LT(std::sqrt(after), 0.35 * std::sqrt(before));
}

TEST(StraightenLinks, WithoutPassesThereIsNothingToStraighten) {
  StrayedStreet made;
  made.nodes.front().digest.track.way = {};
  const ProjectGraph graph = make_graph(made.nodes, made.pairs, 0.001, {});
  const SolvedGraph solved = solve_graph(graph.graph, 0.001);
  EXPECT_FALSE(straightened(made.nodes, made.pairs, graph, solved).has_value());
}

}  // namespace
}  // namespace limen
