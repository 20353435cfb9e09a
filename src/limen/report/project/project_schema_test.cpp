// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_schema.h"

#include <limits>

#include "support/json_schema.h"
#include <gtest/gtest.h>

#include "limen/report/project/project_json.h"

namespace limen {
namespace {

using testing_schema::Validator;

/// A project that has one of everything.
ProjectResult result_with_everything() {
  ProjectResult result;
  result.frame_kind = "control";
  result.control_file = "control.csv";
  result.components = 2;
  ProjectScan placed;
  placed.component = 0;
  placed.frame_from_scan = Rigid3{};
  placed.alternatives = {Rigid3{}};
  placed.copy_of = "other.ply";
  placed.correction = PassCorrection{};
  placed.correction->knots = {PassKnot{}, PassKnot{}};
  placed.stated = StatedPosition{{1, 2, 3}, Matrix3d::Identity(), 0.4, false};
  ProjectScan elsewhere = placed;
  elsewhere.stated->missed_m.reset();
  elsewhere.component = 1;
  elsewhere.rigid = "as you asked";
  ProjectScan model;
  model.model = true;
  result.scans = {placed, elsewhere, model, ProjectScan{}};
  ProjectLink link;
  link.source = 0;
  link.target = 1;
  link.alternatives = {{1, Rigid3{}, 3.0}};
  result.links = {link, link};
  result.links[1].given = true;
  result.loops.push_back({});
  result.loops.back().links = {0, 1};
  ProjectPoint used;
  used.state = PointState::used;
  used.scanner = true;
  used.given = used.found = Vector3d(1, 2, 3);
  used.test.detectable = Vector3d(0.01, 0.01, std::numeric_limits<double>::infinity());
  used.sights = {{0, true, 0.001}};
  ProjectPoint unseen;
  unseen.role = PointRole::check;
  unseen.given = Vector3d(1, 2, 3);
  result.points = {used, unseen};
  ProjectQuestion question;
  question.scans = {1};
  question.current = {0};
  question.answers = {{DecisionKind::accept, {"a.ply", "b.ply"}, 0}};
  result.questions = {question};
  result.decisions.push_back({{DecisionKind::level, {"a.ply"}, 0}, DecisionState::kept, "leans"});
  result.notes = {"a note"};
  return result;
}

TEST(ProjectSchema, HoldsForEverythingThatAProjectMayHave) {
  const Validator validator(testing_schema::json::parse(project_schema()));
  const auto fault = [&](const ProjectResult& result) {
    const OptionList options = {{"seed", std::int64_t{1}}};
    return validator.fault(testing_schema::json::parse(project_json(result, options)));
  };
  ProjectResult result = result_with_everything();
  for (const ProjectOutcome outcome :
       {ProjectOutcome::registered, ProjectOutcome::partial, ProjectOutcome::no_match}) {
    result.outcome = outcome;
    EXPECT_EQ(fault(result), "");
  }
  for (const NodeState state : {NodeState::registered, NodeState::probable, NodeState::ambiguous,
                                NodeState::under_constrained, NodeState::floating}) {
    result.scans[0].state = state;
    EXPECT_EQ(fault(result), "") << to_string(state);
  }
  result.links[0].pair = Outcome::probable;
  EXPECT_EQ(fault(result), "");
  EXPECT_EQ(fault(ProjectResult{}), "$.frame.kind is another word");
  result.frame_kind = "station";
  result.frame_scan = 0;
  EXPECT_EQ(fault(result), "");
}

}  // namespace
}  // namespace limen
