// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/solve/project_graph.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/project/graph/pair_evidence.h"
#include "limen/project/solve/shared_planes.h"
#include "limen/project/solve/word_terms.h"
#include "limen/register/judge/as_built.h"

namespace limen {
namespace {

/// What a pair gives whose look-alike place has this probability.
RegistrationResult stated(Outcome outcome, double look_alike, std::size_t rivals = 0) {
  RegistrationResult result;
  result.outcome = outcome;
  result.best.probability = 1.0 - look_alike;
  result.best.score = 30.0;
  result.best.agreeing_m2 = 30.0;
  result.rivals = rivals;
  result.others = OtherExplanations{0.0, look_alike, 0.0};
  if (rivals > 0) result.alternatives.push_back(result.best);
  return result;
}

std::vector<GraphLink> links_of(const RegistrationResult& pair) {
  std::vector<ProjectNode> nodes(2);
  nodes[1].scan = 1;
  return make_graph(nodes, {{1, 0, pair, {}}}, {}).graph.links;
}

TEST(ProjectGraph, ALinkKeepsTheProbabilitiesOfItsPair) {
  const std::vector<GraphLink> links = links_of(stated(Outcome::ambiguous, 0.6));
  ASSERT_EQ(links.size(), 1U);
  EXPECT_EQ(links.front().trust, LinkTrust::measured);
  EXPECT_NEAR(links.front().look_alike, 0.6, 1e-12);
}

/// A pose that chance explains better is none to rely on by itself; others may still say the same.
TEST(ProjectGraph, APairMakesALinkUnlessProbablyNothingIsShared) {
  RegistrationResult pair = stated(Outcome::no_match, 0.0);
  pair.others = OtherExplanations{.nothing_shared = 0.6, .look_alike = 0.0, .unlisted_pose = 0.0};
  EXPECT_TRUE(links_of(pair).empty());
  pair.others->nothing_shared = 0.4;
  EXPECT_EQ(links_of(pair).size(), 1U);
  pair.others.reset();
  EXPECT_TRUE(links_of(pair).empty()) << "no pose was found";
}

TEST(ProjectGraph, WhatIsKnownToCentimetresTellsOnePlaceFromAnother) {
  RegistrationResult pair = stated(Outcome::under_constrained, 0.0);
  pair.sigma.translation_m = {0.003, 0.02, 0.003};
  pair.unobserved = {{false, Vector3d::UnitY(), "shift"}};
  EXPECT_EQ(links_of(pair).front().trust, LinkTrust::measured);
  pair.sigma.translation_m.y() = 0.2;
  EXPECT_EQ(links_of(pair).front().trust, LinkTrust::weak);
}

/// Two poses of a pair a decimetre or two from each other mean one place; along the line between them it is
/// known no better than they agree. A pose that is metres away stays one of its own, and an open one is none.
TEST(ProjectGraph, PosesNearEachOtherAreOnePlaceThatIsKnownLessWell) {
  RegistrationResult pair = stated(Outcome::ambiguous, 0.0);
  pair.best.probability = 0.6;
  pair.best.sigma.covariance = 1e-6 * Matrix6d::Identity();
  pair.sigma = pair.best.sigma;
  const auto other = [&](const Vector3d& shift, double probability, double variance) {
    Hypothesis pose = pair.best;
    pose.target_from_source.translation += shift;
    pose.sigma.covariance *= variance / 1e-6;
    pose.probability = probability;
    pair.alternatives.push_back(pose);
  };
  other({0.2, 0, 0}, 0.2, 1e-6);
  other({4, 0, 0}, 0.1, 1e-6);
  other({0, 9, 0}, 0.1, 100.0);
  const GraphLink link = links_of(pair).front();
  ASSERT_EQ(link.poses.size(), 2U);
  EXPECT_NEAR(link.poses.front().probability, 0.8, 1e-12);
  EXPECT_NEAR(link.poses.front().covariance(3, 3), 0.25 * 0.2 * 0.2, 1e-4);
  EXPECT_LT(link.poses.front().covariance(4, 4), 1e-4);
  EXPECT_NEAR(link.poses.back().target_from_source.translation.x(), 4.0, 1e-12);
}

TEST(ProjectGraph, AlongWhatAPairCallsOpenItsDeviationIsNotBelieved) {
  RegistrationResult pair = stated(Outcome::under_constrained, 0.0);
  pair.best.sigma.covariance = 1e-6 * Matrix6d::Identity();
  pair.sigma = pair.best.sigma;
  const Vector3d open = Vector3d(3, 4, 0).normalized();
  pair.unobserved = {{false, open, "shift"}};
  const Matrix6d covariance = links_of(pair).front().poses.front().covariance;
  const Matrix3d shift = covariance.bottomRightCorner<3, 3>();
  EXPECT_GT(open.dot(shift * open), 0.009);
  const Vector3d across = Vector3d::UnitZ().cross(open);
  EXPECT_LT(across.dot(shift * across), 1e-3);
  EXPECT_LT(shift(2, 2), 1e-3);
  EXPECT_LT((Matrix3d(covariance.topLeftCorner<3, 3>()).norm()), 1e-3);
}

/// Where the best pose lays a place on a look-alike one, the scans are elsewhere: another pose of theirs then
/// agrees by chance.
TEST(ProjectGraph, OtherPosesOfALookAlikePlaceSayLittle) {
  RegistrationResult pair = stated(Outcome::ambiguous, 0.99);
  pair.best.probability = 0.006;
  pair.others->nothing_shared = 1e-5;
  Hypothesis other = pair.best;
  other.target_from_source.translation = {5.0, 0.0, 0.0};
  other.probability = 0.003;
  pair.alternatives.push_back(other);
  const GraphLink link = links_of(pair).front();
  ASSERT_EQ(link.poses.size(), 2U);
  EXPECT_GT(evidence_of(link, 0).chance_nats, 5.0) << "by chance so much does not agree";
  EXPECT_LT(evidence_of(link, 1).chance_nats, -5.0);
  GraphLink sure = link;
  sure.look_alike = 0.0;
  EXPECT_GT(evidence_of(sure, 1).chance_nats, 5.0);
}

/// Of a pair that was measured from where the links place its scans.
PoseGraph measured_in_place(const RegistrationResult& pair, double placed_sigma_m) {
  std::vector<ProjectNode> nodes(2);
  nodes[1].scan = 1;
  LinkPose placed;
  placed.covariance *= placed_sigma_m * placed_sigma_m;
  return make_graph(nodes, {{1, 0, pair, {}, placed}}, {}).graph;
}

TEST(ProjectGraph, APoseMeasuredInPlaceIsNoLink) {
  RegistrationResult pair = stated(Outcome::under_constrained, 0.0);
  pair.best.sigma.covariance = 1e-6 * Matrix6d::Identity();
  pair.sigma = pair.best.sigma;
  const PoseGraph graph = measured_in_place(pair, 0.1);
  EXPECT_TRUE(graph.links.empty());
  ASSERT_EQ(graph.measured_in_place.size(), 1U);
  EXPECT_LT(graph.measured_in_place.front().pose.covariance(3, 3), 1e-4);
}

TEST(ProjectGraph, APoseMeasuredInPlaceIsKnownNoBetterThanItMayBeWrong) {
  RegistrationResult pair = stated(Outcome::under_constrained, 0.0);
  pair.best.sigma.covariance = 1e-6 * Matrix6d::Identity();
  pair.sigma = pair.best.sigma;
  pair.best.probability = 0.96;
  const PoseGraph graph = measured_in_place(pair, 0.1);
  ASSERT_EQ(graph.measured_in_place.size(), 1U);
  EXPECT_GE(graph.measured_in_place.front().pose.covariance(3, 3), 0.04 * 0.1 * 0.1);
  pair.best.probability = 0.9;
  EXPECT_TRUE(measured_in_place(pair, 0.1).measured_in_place.empty());
}

TEST(ProjectGraph, WhatIsFoundElsewhereIsNotMeasuredInPlace) {
  RegistrationResult pair = stated(Outcome::registered, 0.0);
  pair.best.sigma.covariance = 1e-6 * Matrix6d::Identity();
  pair.sigma = pair.best.sigma;
  pair.best.target_from_source.translation = {0.3, 0.0, 0.0};
  EXPECT_EQ(measured_in_place(pair, 0.1).measured_in_place.size(), 1U);
  EXPECT_TRUE(measured_in_place(pair, 0.03).measured_in_place.empty());
}

TEST(ProjectGraph, APairThatDoesNotKnowItselfIsNotSure) {
  RegistrationResult pair = stated(Outcome::registered, 0.0);
  pair.best.probability = 0.7;
  pair.others->nothing_shared = 0.2;
  pair.others->unlisted_pose = 0.1;
  EXPECT_NEAR(links_of(pair).front().chance, 0.3, 1e-12);
  pair.others.reset();
  EXPECT_GT(links_of(pair).front().chance, 0.001);
}

UserWords word(DecisionKind kind, int pose = 0) {
  UserWords words;
  words.pairs[{1, 0}] = {kind, pose};
  return words;
}

std::vector<GraphLink> links_with(const RegistrationResult& pair, const UserWords& words) {
  std::vector<ProjectNode> nodes(2);
  nodes[1].scan = 1;
  return make_graph(nodes, {{1, 0, pair, {}}}, words).graph.links;
}

TEST(ProjectGraph, AUsersWordMakesALinkSureOrLeavesItOut) {
  const RegistrationResult look_alike = stated(Outcome::ambiguous, 0.9);
  const std::vector<GraphLink> accepted = links_with(look_alike, word(DecisionKind::accept));
  ASSERT_EQ(accepted.size(), 1U);
  // No surer than a user is.
  EXPECT_GT(accepted.front().look_alike, 0.0);
  EXPECT_LT(accepted.front().look_alike + accepted.front().chance, 0.001);
  EXPECT_TRUE(links_with(stated(Outcome::registered, 0.0), word(DecisionKind::reject)).empty());
}

/// A pair may be no match for itself and a link all the same, which loops settle: what a user says of it
/// counts. Where its poses are more probably none there is nothing to accept.
TEST(ProjectGraph, AWordOnALinkThatIsNoMatchByItselfCounts) {
  RegistrationResult pair = stated(Outcome::no_match, 0.0);
  for (const double chance : {0.3, 0.9}) {
    pair.others->nothing_shared = chance;
    const bool is_link = chance < 0.5;
    EXPECT_EQ(links_of(pair).size(), is_link ? 1U : 0U);
    EXPECT_EQ(links_with(pair, word(DecisionKind::accept)).size(), is_link ? 1U : 0U);
    EXPECT_TRUE(links_with(pair, word(DecisionKind::reject)).empty());
  }
}

/// A word for one pose leaves the others as likely as they were: it may be wrong.
TEST(ProjectGraph, AWordForOnePoseSaysNothingForAnother) {
  RegistrationResult pair = stated(Outcome::ambiguous, 0.0, 1);
  pair.best.probability = 0.5;
  pair.others->nothing_shared = 0.2;
  pair.alternatives[0].probability = 0.3;
  pair.alternatives[0].target_from_source.translation.x() = 3.0;
  const auto against_chance = [](const GraphLink& link, int number) {
    return evidence_of(link, static_cast<std::size_t>(link.number_of(number))).chance_nats;
  };
  const GraphLink before = links_of(pair).front();
  const GraphLink chosen = links_with(pair, word(DecisionKind::choose, 1)).front();
  EXPECT_NEAR(against_chance(chosen, 0), against_chance(before, 0), 1e-9);
  EXPECT_GT(against_chance(chosen, 1), against_chance(before, 1) + 5.0);
}

TEST(ProjectGraph, TheChosenPoseComesFirstAndPosesKeepTheirNumbers) {
  RegistrationResult pair = stated(Outcome::ambiguous, 0.0, 2);
  pair.alternatives.push_back(pair.best);
  pair.alternatives[0].target_from_source.translation.x() = 3.0;
  pair.alternatives[1].target_from_source.translation.x() = 5.0;
  const GraphLink link = links_with(pair, word(DecisionKind::choose, 2)).front();
  EXPECT_EQ(link.poses.front().target_from_source.translation.x(), 5.0);
  EXPECT_EQ(link.number_of(0), 2);
  EXPECT_EQ(link.number_of(1), 1);
  EXPECT_EQ(link.number_of(2), 0);
  // A number that there is none of changes nothing.
  EXPECT_EQ(links_with(pair, word(DecisionKind::choose, 7)).front().number_of(0), 0);
}

/// A scanner 1.6 m above a floor of 10 m^2.
ProjectNode over_a_floor(std::size_t scan) {
  ProjectNode node;
  node.scan = scan;
  node.digest.upright = true;
  node.digest.stations = {Vector3d(0, 0, 1.6)};
  PlaneDigest floor;
  floor.plane = {Vector3d::UnitZ(), 0.0};
  floor.area_m2 = 10.0;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) floor.moments.add({x, y, 0.0});
  }
  node.digest.planes.push_back(floor);
  return node;
}

TEST(ProjectGraph, PosesOnOtherStoreysFallAwayWhereFloorsAreOfOneHeight) {
  RegistrationResult pair = stated(Outcome::ambiguous, 0.0, 1);
  pair.best.target_from_source.translation.z() = 3.0;
  pair.alternatives.front().target_from_source.translation.z() = 0.01;
  UserWords words;
  words.floors.emplace(1, 0);
  const GraphLink link =
      make_graph({over_a_floor(0), over_a_floor(1)}, {{1, 0, pair, {}}}, words).graph.links.front();
  EXPECT_EQ(link.poses.front().target_from_source.translation.z(), 0.01);
  EXPECT_EQ(link.number_of(0), 1);
}

/// Two scans with a link that knows tilts to 0.1 degrees and errs by as much.
struct TwoScans {
  std::vector<ProjectNode> nodes = {over_a_floor(0), over_a_floor(1)};
  SolvedGraph solved;
  JointProblem problem;

  TwoScans(double lean_rad, double step_m, double link_rad = 0.002) {
    solved.nodes.resize(2);
    solved.nodes[0].component = solved.nodes[1].component = 0;
    Rigid3& second = solved.nodes[1].frame_from_node;
    second.rotation = rotation_exp(Vector3d(lean_rad, 0, 0));
    second.translation = {2, 0, step_m};
    LinkPose pose;
    pose.target_from_source = second;
    Vector6d variances;
    variances << Vector3d::Constant(link_rad * link_rad), Vector3d::Constant(0.004 * 0.004);
    pose.covariance = variances.asDiagonal();
    pose.centre = second.translation;
    problem.edges.push_back({1, 0, pose});
    for (const SolvedNode& node : solved.nodes) problem.frame_from_node.push_back(node.frame_from_node);
    problem.fixed = {true, false};
  }

  JointSolution solve(const UserWords& words, std::vector<bool>& broken) {
    const std::vector<bool> controlled(2, false);
    solved.nodes[1].covariance = adjust_jointly(problem).covariance[1];
    broken = broken_words(words, nodes, solved, controlled);
    add_word_terms(words, broken, nodes, solved, controlled, problem);
    return adjust_jointly(problem);
  }
};

TEST(SharedPlanes, WhatThePairItselfSeesInTwoPlanesIsNotOneSurface) {
  // Two floors, 2 m apart, in one plane as the scans stand; by the pair one may be a step of 2 cm.
  const std::vector<ProjectNode> nodes = {over_a_floor(0), over_a_floor(1)};
  for (const double step_m : {0.001, 0.02}) {
    SolvedGraph solved;
    solved.nodes.resize(2);
    solved.nodes[1].frame_from_node.translation = {2, 0, 0};
    const BentPasses none({});
    SharedPlanes shared(nodes, solved, none);
    Rigid3 pose;
    pose.translation = {2, 0, step_m};
    PlaneMatch match;
    match.source = match.target = 0;
    shared.join({1, 0, {pose}}, match);
    JointProblem problem;
    shared.tell({true, true}, problem);
    EXPECT_EQ(problem.planes, step_m < 0.01 ? 1 : 0) << step_m;
  }
}

/// Of a floor that both see whole each observation is as accurate as its tiles; of what one of them alone
/// sees a part may have been built some millimetres off.
TEST(SharedPlanes, WhatOneScanAloneSawMayHaveBeenBuiltOtherwise) {
  const std::vector<ProjectNode> nodes = {over_a_floor(0), over_a_floor(1)};
  const double area_m2 = nodes[0].digest.planes[0].area_m2;
  SolvedGraph solved;
  solved.nodes.resize(2);
  solved.nodes[1].frame_from_node.translation = {2, 0, 0};
  PlaneMatch match;
  match.source = match.target = 0;
  const auto sigma_m = [&](double share) {
    const BentPasses none({});
    SharedPlanes shared(nodes, solved, none);
    match.overlap_m2 = share * area_m2;
    shared.join({1, 0, {solved.nodes[1].frame_from_node}}, match);
    JointProblem problem;
    shared.tell({true, true}, problem);
    EXPECT_EQ(problem.observations.size(), 2U);
    // Of the whole plane, of which so many points count.
    return problem.observations[0].sigma_m / std::sqrt(problem.observations[0].most_points);
  };
  EXPECT_GT(area_m2, 0.0);
  EXPECT_LT(sigma_m(1.0), 0.001);
  EXPECT_NEAR(sigma_m(0.5), built_offset_m() * std::sqrt(0.5), 0.0005);
  EXPECT_NEAR(sigma_m(0.0), built_offset_m(), 0.0005);
  EXPECT_NEAR(built_offset_m(), 0.0042, 0.0001);
}

UserWords said(DecisionKind kind) {
  UserWords words;
  if (kind == DecisionKind::same_floor) {
    words.decisions = {{kind, {"a", "b"}, 0}};
    words.nodes = {{0, 1}};
  } else {
    words.decisions = {{kind, {"a"}, 0}, {kind, {"b"}, 0}};
    words.nodes = {{0}, {1}};
  }
  return words;
}

TEST(WordTerms, ScansThatAreStatedToBeLevelBecomeSoUnlessTheDataContradictIt) {
  std::vector<bool> broken;
  const JointSolution solution = TwoScans(0.003, 0.0).solve(said(DecisionKind::level), broken);
  const Vector3d up = solution.frame_from_node[1].rotation.col(2);
  EXPECT_LT(up.head<2>().norm(), 0.0003);
  EXPECT_EQ(broken, (std::vector<bool>{false, false}));
  // A link that knows better.
  const JointSolution leans = TwoScans(0.01, 0.0, 1e-4).solve(said(DecisionKind::level), broken);
  EXPECT_EQ(broken, (std::vector<bool>{true, true}));
  EXPECT_NEAR(leans.frame_from_node[1].rotation(2, 1), 0.01, 1e-5);
}

/// Much of the street through a window is not the floor of a room.
TEST(WordTerms, TheFloorIsThePlaneBelowTheScanner) {
  ProjectNode node = over_a_floor(0);
  PlaneDigest street;
  street.plane = {Vector3d::UnitZ(), 0.46};
  street.centroid = {0.0, 12.0, -0.46};
  street.area_m2 = 25.0;
  for (int k = 0; k < 30; ++k) street.moments.add({0.5 * (k % 3), -4.0 + 0.3 * k, 0.0});
  node.digest.planes.insert(node.digest.planes.begin(), street);
  EXPECT_EQ(floor_of(node.digest), 1);
  node.digest.planes.pop_back();
  EXPECT_EQ(floor_of(node.digest), 0);
}

TEST(WordTerms, WordsThatCouldNotBeTestedAreOfNoUse) {
  TwoScans two(0.0, 0.0);
  const std::vector<bool> none(2, false);
  const auto reasons = [&](const UserWords& words, const std::vector<bool>& controlled) {
    return idle_words(words, two.nodes, two.solved, controlled);
  };
  EXPECT_EQ(reasons(said(DecisionKind::level), none), (std::vector<std::string>{"", ""}));
  EXPECT_EQ(reasons(said(DecisionKind::same_floor), none), std::vector<std::string>{""});
  UserWords one = said(DecisionKind::level);
  one.decisions.pop_back();
  one.nodes.pop_back();
  EXPECT_NE(reasons(one, none).front().find("another level scan"), std::string::npos);
  EXPECT_EQ(reasons(one, {true, true}).front(), "");
  two.nodes[1].digest.planes.clear();
  EXPECT_EQ(reasons(said(DecisionKind::same_floor), none).front(), "no floor was seen by b");
  two.solved.nodes[1].component = 1;
  EXPECT_EQ(reasons(said(DecisionKind::same_floor), none).front(), "nothing joins the two scans");
  two.solved.nodes[0].component = -1;
  EXPECT_EQ(reasons(one, none).front(), "nothing joins the scan to others");
}

TEST(WordTerms, FloorsOfOneHeightComeTogetherUnlessTheDataContradictIt) {
  std::vector<bool> broken;
  const JointSolution solution = TwoScans(0.0, 0.006).solve(said(DecisionKind::same_floor), broken);
  // Between 4 mm of the link, and its tilts at 2 m, and 7 mm of the floors.
  const double z = solution.frame_from_node[1].translation.z();
  EXPECT_NEAR(z, 0.006 * 49.0 / (49.0 + 16.0 + 16.0), 0.0012);
  EXPECT_EQ(broken, std::vector<bool>{false});
  const JointSolution step = TwoScans(0.0, 0.15).solve(said(DecisionKind::same_floor), broken);
  EXPECT_EQ(broken, std::vector<bool>{true});
  EXPECT_NEAR(step.frame_from_node[1].translation.z(), 0.15, 1e-6);
}

}  // namespace
}  // namespace limen
