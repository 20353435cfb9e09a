// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/synthetic_survey.h"
#include <gtest/gtest.h>

#include "limen/geometry/random_vectors.h"
#include "limen/project/solve/adjust_planes.h"
#include "limen/project/solve/survey_points.h"

namespace limen {
namespace {

constexpr double kSigmaM = 0.002;

/// Scans that share nothing but targets: three of one place each, the survey about the same origin.
struct TargetsOnly {
  std::vector<ProjectNode> nodes = std::vector<ProjectNode>(3);
  std::vector<Rigid3> control_from_node;
  Survey survey;

  explicit TargetsOnly(const std::vector<std::size_t>& points_of_scans) {
    RandomStream random(5, 1);
    survey.file = "control.csv";
    survey.node_names = {"a", "b", "c"};
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      nodes[n].scan = n;
      control_from_node.push_back(random_pose(random, 30.0));
      for (std::size_t k = 0; k < points_of_scans[n]; ++k) add_point(static_cast<int>(n), random);
    }
  }

  void add_point(int node, RandomStream& random) {
    const Matrix3d covariance = kSigmaM * kSigmaM * Matrix3d::Identity();
    const Vector3d place = uniform_vector(Vector3d(-4, -4, -1), Vector3d(4, 4, 2), random);
    SurveyMark mark;
    mark.name = "P";
    mark.name += std::to_string(survey.marks.size());
    mark.role = PointRole::control;
    const Vector3d x = control_from_node[static_cast<std::size_t>(node)] * place;
    mark.point.known = KnownPlace{x + noise3(kSigmaM, random), covariance};
    mark.given = mark.point.known->x;
    mark.point.sights.push_back({node, place + noise3(kSigmaM, random), covariance});
    survey.marks.push_back(mark);
  }

  /// As assemble() goes about it.
  PlacedSurvey place(SolvedGraph& solved, const std::vector<TriedPair>& pairs = {}) {
    ProjectGraph made = make_graph(nodes, pairs, {});
    add_target_links(survey, made);
    add_survey_links(survey, made);
    solved = solve_graph(made.graph, 0.001);
    if (confirm_by_points(survey, solved, made)) solved = solve_graph(made.graph, 0.001);
    PlacedSurvey placed = place_survey(survey, made, solved);
    EXPECT_FALSE(adjust_planes(nodes, pairs, made, {}, solved, placed).contradicted);
    return placed;
  }

  /// What a pair of these scans tells.
  [[nodiscard]] TriedPair pair(std::size_t source, std::size_t target, double off_m,
                               double look_alike) const {
    TriedPair pair{source, target, {}};
    pair.result.outcome = Outcome::registered;
    pair.result.best.target_from_source = inverse(control_from_node[target]) * control_from_node[source];
    pair.result.best.target_from_source.translation.x() += off_m;
    pair.result.best.probability = 1.0 - look_alike;
    pair.result.best.score = pair.result.best.agreeing_m2 = 30.0;
    pair.result.others = OtherExplanations{0.0, look_alike, 0.0};
    pair.result.sigma.centre = inverse(control_from_node[target]) * control_from_node[source].translation;
    return pair;
  }
};

TEST(Survey, ScansThatOnlyTargetsJoinStandInOneFrame) {
  TargetsOnly building({4, 5, 2});
  SolvedGraph solved;
  const PlacedSurvey placed = building.place(solved);
  EXPECT_TRUE(placed.placed);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(solved.nodes[n].state, NodeState::registered) << n;
    EXPECT_EQ(solved.nodes[n].component, 0) << n;
    EXPECT_TRUE(placed.controlled[n]);
    const Rigid3 error = solved.nodes[n].frame_from_node * inverse(building.control_from_node[n]);
    EXPECT_LT(rotation_angle(error.rotation), 0.003) << n;
    EXPECT_LT(
        (solved.nodes[n].frame_from_node.translation - building.control_from_node[n].translation).norm(),
        0.008)
        << n;
  }
  // Two targets hold no scan.
  EXPECT_EQ(solved.nodes[2].component, -1);
  EXPECT_FALSE(placed.controlled[2]);
}

/// Targets without coordinates that the first two scans see.
void share_targets(TargetsOnly& building, int count) {
  RandomStream random(9, 1);
  building.survey.file.clear();
  for (int k = 0; k < count; ++k) building.add_point(0, random);
  for (SurveyMark& mark : building.survey.marks) {
    const Vector3d x = building.control_from_node[0] * mark.point.sights.front().x_in_node;
    const Matrix3d covariance = mark.point.sights.front().covariance;
    PointSight other{1, inverse(building.control_from_node[1]) * x + noise3(kSigmaM, random), covariance};
    other.number = 1;
    mark.point.sights.push_back(other);
    mark.role = PointRole::tie;
    mark.point.known.reset();
    mark.given.reset();
  }
}

TEST(Survey, TargetsThatTwoScansSeeJoinThem) {
  for (const bool look_alike : {false, true}) {
    TargetsOnly building({0, 0, 0});
    share_targets(building, 4);
    std::vector<TriedPair> pairs;
    if (look_alike) pairs.push_back(building.pair(1, 0, 4.8, 0.4));
    SolvedGraph solved;
    const PlacedSurvey placed = building.place(solved, pairs);
    EXPECT_FALSE(placed.placed);
    for (const std::size_t n : {0U, 1U})
      EXPECT_EQ(solved.nodes[n].state, NodeState::registered) << look_alike;
    const Rigid3 found = inverse(solved.nodes[0].frame_from_node) * solved.nodes[1].frame_from_node;
    const Rigid3 truth = inverse(building.control_from_node[0]) * building.control_from_node[1];
    const Rigid3 error = found * inverse(truth);
    EXPECT_LT(rotation_angle(error.rotation), 0.004) << look_alike;
    EXPECT_LT((error * building.nodes[0].digest.middle - building.nodes[0].digest.middle).norm(), 0.01);
    building.nodes[1].scan = 1;
    const std::vector<ProjectPoint> points = stated_points(building.survey, placed, building.nodes);
    ASSERT_EQ(points.size(), 4U);
    for (const ProjectPoint& point : points) {
      EXPECT_EQ(point.state, PointState::compared);
      EXPECT_FALSE(point.found);
      for (const ProjectSight& sight : point.sights) {
        ASSERT_TRUE(sight.missed_m);
        EXPECT_LT(*sight.missed_m, 5.0 * kSigmaM);
      }
    }
  }
}

TEST(Survey, TooFewOrFalseTargetsJoinNoScans) {
  for (const int count : {2, 4}) {
    TargetsOnly building({0, 0, 0});
    share_targets(building, count);
    // Two of four lie elsewhere.
    if (count == 4) {
      for (const std::size_t m : {0U, 1U})
        building.survey.marks[m].point.sights[1].x_in_node += Vector3d(0.3, 0.2, 0.1 + 0.4 * double(m));
    }
    SolvedGraph solved;
    building.place(solved);
    EXPECT_EQ(solved.nodes[1].component, -1) << count;
    EXPECT_EQ(building.survey.notes.size(), count == 4 ? 1U : 0U);
    for (const ProjectPoint& point : stated_points(building.survey, {}, building.nodes))
      EXPECT_EQ(point.state, PointState::not_placed);
  }
}

TEST(Survey, TargetsThatContradictTheScansAreNotUsed) {
  TargetsOnly building({0, 0, 0});
  share_targets(building, 4);
  for (SurveyMark& mark : building.survey.marks) {
    for (PointSight& sight : mark.point.sights) sight.x_in_node *= 0.3048;
  }
  SolvedGraph solved;
  building.place(solved, {building.pair(1, 0, 0.0, 0.0)});
  const Rigid3 found = inverse(solved.nodes[0].frame_from_node) * solved.nodes[1].frame_from_node;
  const Rigid3 truth = inverse(building.control_from_node[0]) * building.control_from_node[1];
  EXPECT_LT((found.translation - truth.translation).norm(), 1e-3);
  ASSERT_EQ(building.survey.notes.size(), 1U);
  EXPECT_NE(building.survey.notes.front().find("check their unit"), std::string::npos);
}

TEST(Survey, CoordinatesWithExchangedColumnsDefineNoFrame) {
  for (const bool flat : {false, true}) {
    TargetsOnly building({4, 0, 0});
    // Mirrored points of a plane fit a scan that is upside down.
    building.survey.up = {building.control_from_node[0].rotation.transpose().col(2), Vector3d::Zero(),
                          Vector3d::Zero()};
    for (SurveyMark& mark : building.survey.marks) {
      Vector3d& x = mark.point.known->x;
      const Vector3d in_node = inverse(building.control_from_node[0]) * x;
      if (flat) {
        x.z() = 0.0;
        mark.point.sights.front().x_in_node = inverse(building.control_from_node[0]) * x;
      } else {
        mark.point.sights.front().x_in_node = in_node;
      }
      std::swap(x.x(), x.y());
    }
    SolvedGraph solved;
    const PlacedSurvey placed = building.place(solved);
    EXPECT_FALSE(placed.placed) << flat;
    ASSERT_EQ(building.survey.notes.size(), 1U) << flat;
    EXPECT_NE(building.survey.notes.front().find("x and y are exchanged"), std::string::npos);
  }
}

TEST(Survey, CoordinatesInAnotherUnitDefineNoFrame) {
  for (const double unit : {0.001, 0.3048}) {
    TargetsOnly building({4, 0, 0});
    for (SurveyMark& mark : building.survey.marks) mark.point.known->x /= unit;
    SolvedGraph solved;
    EXPECT_FALSE(building.place(solved).placed);
    ASSERT_EQ(building.survey.notes.size(), 1U);
    EXPECT_NE(building.survey.notes.front().find(unit == 0.001 ? "only in mm" : "only in ft"),
              std::string::npos)
        << building.survey.notes.front();
  }
}

TEST(Survey, WhatStoodByTheSurveyAloneKeepsAFrameOfItsOwn) {
  TargetsOnly building({4, 4, 0});
  ProjectGraph made = make_graph(building.nodes, {building.pair(1, 0, 0.0, 0.0)}, {});
  add_survey_links(building.survey, made);
  SolvedGraph solved = solve_graph(made.graph, 0.001);
  // Both are in doubt: what they see holds no frame, and the survey's node, which was theirs, is gone.
  for (SolvedNode& node : solved.nodes) node.state = NodeState::ambiguous;
  const std::vector<TriedPair> pairs = {building.pair(1, 0, 0.0, 0.0)};
  PlacedSurvey placed = place_survey(building.survey, made, solved);
  EXPECT_FALSE(placed.placed);
  adjust_planes(building.nodes, pairs, made, {}, solved, placed);
  int frames = 0;
  for (std::size_t n = 0; n < 2; ++n) {
    frames += solved.nodes[n].covariance.isZero() ? 1 : 0;
    EXPECT_LT(solved.nodes[n].covariance.diagonal().head<3>().maxCoeff(), 0.01) << n;
  }
  EXPECT_EQ(frames, 1);
}

TEST(Survey, TargetsRefuteALinkAndSettleALookAlike) {
  // c hangs on a by a link that is 0.3 m off, and on b by one that may lie on a look-alike place.
  TargetsOnly building({4, 4, 4});
  const std::vector<TriedPair> pairs = {building.pair(2, 0, 0.3, 0.0), building.pair(2, 1, 0.0, 0.2)};
  SolvedGraph solved;
  const PlacedSurvey placed = building.place(solved, pairs);
  EXPECT_TRUE(placed.placed);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_TRUE(is_placed(solved.nodes[n].state)) << n;
    EXPECT_LT(
        (solved.nodes[n].frame_from_node.translation - building.control_from_node[n].translation).norm(),
        0.01)
        << n;
  }
  ASSERT_EQ(solved.links.size(), 2U);
  EXPECT_EQ(solved.links[0].pose, -1);
  EXPECT_EQ(solved.links[1].pose, 0);
  EXPECT_TRUE(solved.loops.empty() || solved.loops.front().links.size() <= 2);
}

TEST(Survey, ScansInDoubtAreHeldByTheirNeighboursTargetsOnly) {
  // b has targets; c hangs on b by a link that may lie on a look-alike place, and so it does: its own target
  // fits nothing.
  TargetsOnly building({0, 4, 1});
  SolvedGraph solved;
  const PlacedSurvey placed = building.place(solved, {building.pair(2, 1, 1.0, 0.2)});
  EXPECT_EQ(solved.nodes[1].state, NodeState::registered);
  EXPECT_EQ(solved.nodes[2].state, NodeState::ambiguous);
  EXPECT_TRUE(placed.points.back().sights.empty());
  const std::vector<ProjectPoint> stated = stated_points(building.survey, placed, building.nodes);
  EXPECT_EQ(stated.back().state, PointState::not_placed);
  EXPECT_EQ(stated.front().state, PointState::used);
}

TEST(Survey, PointsThatOtherScansForetellConfirmAScanInDoubt) {
  // Links that may lie on look-alike places; two targets in each scan, and each two fit what the four others
  // tell.
  TargetsOnly building({2, 2, 2});
  const std::vector<TriedPair> pairs = {building.pair(1, 0, 0.0, 0.2), building.pair(2, 1, 0.0, 0.2)};
  SolvedGraph solved;
  EXPECT_TRUE(building.place(solved, pairs).placed);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(solved.nodes[n].state, NodeState::registered) << n;
    EXPECT_LT(
        (solved.nodes[n].frame_from_node.translation - building.control_from_node[n].translation).norm(),
        0.02)
        << n;
  }
  // The last scan a metre off, on a look-alike place: its points fit nobody's, and it is not confirmed.
  TargetsOnly wrong({4, 4, 2});
  const std::vector<TriedPair> look_alikes = {wrong.pair(1, 0, 0.0, 0.2), wrong.pair(2, 1, 1.0, 0.2)};
  wrong.place(solved, look_alikes);
  EXPECT_EQ(solved.nodes[0].state, NodeState::registered);
  EXPECT_EQ(solved.nodes[1].state, NodeState::registered);
  EXPECT_EQ(solved.nodes[2].state, NodeState::ambiguous);
}

/// A pass of 120 m that strays by centimetres, and shares nothing with anything but targets.
struct SurveyedPass {
  static constexpr int kKnots = 25;
  std::vector<ProjectNode> nodes = std::vector<ProjectNode>(1);
  Rigid3 control_from_node;

  SurveyedPass() {
    ScanDigest& digest = nodes[0].digest;
    digest.mobile = true;
    digest.drift_m = 0.01;
    for (int k = 0; k < kKnots; ++k) {
      digest.track.way.times_s.push_back(500.0 + 2.0 * k);
      digest.track.way.distances_m.push_back(5.0 * k);
      digest.track.way.places.emplace_back(5.0 * k - 60.0, 0.0, 2.0);
    }
    RandomStream random(3, 2);
    control_from_node = random_pose(random, 50.0);
  }

  /// Given less true, frame of the pass.
  [[nodiscard]] static Vector3d strayed_m(double place) {
    const double phase = 2.0 * M_PI * place / (kKnots - 1);
    return {0.02 * std::sin(phase), 0.03 * std::cos(phase), -0.015 * std::sin(2.0 * phase)};
  }

  /// Control points on both sides, so many along the way, each seen when it is passed.
  [[nodiscard]] Survey survey(int along) const {
    RandomStream random(8, 4);
    Survey made;
    made.file = "control.csv";
    made.node_names = {"pass"};
    const Matrix3d covariance = kSigmaM * kSigmaM * Matrix3d::Identity();
    for (int k = 0; k < 2 * along; ++k) {
      const double place = (k / 2) * (kKnots - 1.0) / (along - 1.0);
      const Vector3d truth(5.0 * place - 60.0, k % 2 == 0 ? 9.0 : -8.0, 0.5 + k % 3);
      SurveyMark mark;
      mark.name = "P";
      mark.name += std::to_string(k);
      mark.role = PointRole::control;
      mark.point.known = KnownPlace{control_from_node * truth + noise3(kSigmaM, random), covariance};
      mark.given = mark.point.known->x;
      PointSight sight{0, truth + strayed_m(place) + noise3(kSigmaM, random), covariance};
      sight.strayed_m = 0.02;
      sight.place = place;
      mark.point.sights.push_back(sight);
      made.marks.push_back(mark);
    }
    return made;
  }
};

TEST(Survey, TargetsSeenAtTheirTimesBendAPassBack) {
  const SurveyedPass street;
  Survey survey = street.survey(13);
  ProjectGraph made = make_graph(street.nodes, {}, {});
  add_survey_links(survey, made);
  SolvedGraph solved = solve_graph(made.graph, 0.001);
  PlacedSurvey placed = place_survey(survey, made, solved);
  const JointFinding finding = adjust_planes(street.nodes, {}, made, {}, solved, placed);
  ASSERT_EQ(finding.passes.size(), 1U);
  ASSERT_TRUE(placed.placed);
  const BentPass& pass = finding.passes.front();
  double squares = 0.0;
  for (int k = 0; k < SurveyedPass::kKnots; ++k) {
    const auto knot = static_cast<std::size_t>(k);
    const Vector3d given = street.nodes[0].digest.track.way.places[knot];
    const Vector3d wanted = street.control_from_node * (given - SurveyedPass::strayed_m(k));
    const Vector3d whole = pass.frame_from_node * given;
    const Vector3d lever = whole - pass.frame_from_node.translation;
    const Vector3d found =
        whole + pass.knots[knot].value.tail<3>() + pass.knots[knot].value.head<3>().cross(lever);
    squares += (found - wanted).squaredNorm() / SurveyedPass::kKnots;
  }
  // As a whole it strays by 27 mm.
  EXPECT_LT(std::sqrt(squares), 0.005);
  for (const ProjectPoint& point : stated_points(survey, placed, street.nodes)) {
    EXPECT_EQ(point.state, PointState::used) << point.name << " " << point.reason;
    EXPECT_TRUE(point.sights.front().used);
    EXPECT_LT(point.sights.front().missed_m, 0.01) << point.name;
  }
}

TEST(Survey, OfAPassATargetIsWhereItsTimeSaysOrWhereThePassCameNearest) {
  const SurveyedPass street;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "limen_pass_targets_test";
  std::filesystem::create_directories(folder);
  ProjectInputs inputs;
  inputs.targets = (folder / "targets.csv").string();
  std::ofstream(inputs.targets) << "name,scan,x,y,z,sigma,time\n"
                                   "P,pass.ply,1,9,1,0.002,523\nP,pass.ply,1.01,9,1,0.002,541.5\n"
                                   "Q,pass.ply,-57.5,9,1,0.002,\nR,pass.ply,1,9,1,0.002,600\n";
  std::vector<ProjectScan> scans(1);
  scans[0].file = "pass.ply";
  const Survey survey = read_survey(inputs, street.nodes, scans);
  ASSERT_EQ(survey.marks.size(), 3U);
  const std::vector<PointSight>& twice = survey.marks[0].point.sights;
  ASSERT_EQ(twice.size(), 2U);
  EXPECT_NEAR(twice[0].place.value_or(-1.0), 11.5, 1e-12);
  EXPECT_NEAR(twice[1].place.value_or(-1.0), 20.75, 1e-12);
  EXPECT_EQ(twice[1].number, 1U);
  EXPECT_NEAR(survey.marks[1].point.sights.front().place.value_or(-1.0), 0.5, 1e-12);
  EXPECT_TRUE(survey.marks[2].point.sights.empty());
  ASSERT_FALSE(survey.notes.empty());
  EXPECT_NE(survey.notes.back().find("R of pass.ply"), std::string::npos) << survey.notes.back();
  std::filesystem::remove_all(folder);
}

TEST(Survey, NamesOfScansArePlacesOfScannersAndStrangersAreStated) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "limen_survey_test";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const char* text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  };
  ProjectInputs inputs;
  inputs.control = write("control.csv",
                         "name,x,y,z,sigma\nhall.ply,652000.1235,6862000.5,35.25,0.02\n"
                         "P1,652010,6862010,36,0.002\nP9,652010,6862010,36,0.002\n");
  inputs.targets = write("targets.csv",
                         "name,scan,x,y,z,sigma\nP1,all.e57 #1,1,2,3,0.002\nP1,cellar.ply,1,2,3,0.002\n"
                         "T1,\"scans/hall.ply\",1.5,2,3,0.002\n");
  std::vector<ProjectScan> scans(3);
  scans[0].file = "scans/hall.ply";
  scans[1].file = scans[2].file = "scans/all.e57";
  scans[2].index = 1;
  std::vector<ProjectNode> nodes(3);
  for (std::size_t n = 0; n < 3; ++n) nodes[n].scan = n;
  nodes[0].digest.local_origin = {1, 1, 1};
  nodes[0].digest.stations = {Vector3d(0, 0, 1.6)};
  const Survey survey = read_survey(inputs, nodes, scans);
  ASSERT_EQ(survey.marks.size(), 4U);  // P1, P9, T1, hall.ply
  EXPECT_EQ(survey.marks[0].point.sights.front().node, 2);
  EXPECT_TRUE(survey.marks[1].point.sights.empty());
  EXPECT_EQ(survey.marks[2].role, PointRole::tie);
  EXPECT_EQ(survey.marks[2].point.sights.front().x_in_node, Vector3d(0.5, 1, 2));
  EXPECT_TRUE(survey.marks[3].scanner);
  EXPECT_EQ(survey.marks[3].point.sights.front().x_in_node, Vector3d(0, 0, 1.6));
  // A tenth of a millimetre survives a national grid.
  EXPECT_NEAR(survey.marks[3].point.known->x.x() - survey.marks[0].point.known->x.x(), -9.8765, 1e-9);
  ASSERT_EQ(survey.notes.size(), 2U);
  EXPECT_NE(survey.notes[0].find("P9"), std::string::npos);
  EXPECT_NE(survey.notes[1].find("cellar.ply"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace limen
