// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "support/json_schema.h"
#include <gtest/gtest.h>

#include "limen/report/json/json_values.h"
#include "limen/report/json/result_json.h"
#include "limen/report/json/schemas.h"

namespace limen {
namespace {

using testing_schema::Validator;

RegistrationReport full_report(Outcome outcome) {
  RegistrationReport report;
  RegistrationResult& result = report.result;
  result.outcome = outcome;
  result.reason = "a reason";
  result.best.probability = 0.75;
  result.best.explained_share = 0.5;
  result.best.room = "Hall";
  result.best.sigma.covariance.setIdentity();
  result.best.sigma.formal_covariance.setIdentity();
  result.sigma = result.best.sigma;
  result.others = OtherExplanations{0.1, 0.1, 0.05};
  result.alternatives = {result.best};
  result.alternatives[0].matched_segments = 3;
  result.unobserved = {{false, Vector3d::UnitX(), "shift along x"}};
  result.matches = {{0, 1, 0.001, 0.002, 3.0}};
  result.openings = {{0, 1, 0.01, 0.02, true}};
  result.thickness = {{0, 1, 2, 0.3, 0.002}};
  result.stages = {{"reading", 0.5}};
  report.source.path = "a.ply";
  report.source.sha256 = std::string(64, 'a');
  report.target.path = "b.ifc";
  report.target.kind = "model";
  report.options = {{"method", std::string("auto")}};
  return report;
}

TEST(ResultSchema, HoldsForEveryOutcome) {
  const Validator validator(Json::parse(result_schema()));
  for (const Outcome outcome : {Outcome::registered, Outcome::probable, Outcome::ambiguous,
                                Outcome::under_constrained, Outcome::no_match}) {
    EXPECT_EQ(validator.fault(Json::parse(result_json(full_report(outcome)))), "") << to_string(outcome);
  }
  RegistrationReport segments = full_report(Outcome::registered);
  segments.source.kind = segments.target.kind = "segments";
  segments.result.best.probability.reset();
  segments.result.others.reset();
  EXPECT_EQ(validator.fault(Json::parse(result_json(segments))), "");
  RegistrationReport published = full_report(Outcome::ambiguous);
  published.result.published = PublishedScore{"2022", 1.0, "m2", false, 5};
  EXPECT_EQ(validator.fault(Json::parse(result_json(published))), "");
}

TEST(ResultSchema, RefusesWhatIsNoResult) {
  const Validator validator(Json::parse(result_schema()));
  const Json good = Json::parse(result_json(full_report(Outcome::registered)));
  Json bad = good;
  bad.erase("reason");
  EXPECT_EQ(validator.fault(bad), "$ lacks reason");
  bad = good;
  bad["outcome"] = "perhaps";
  EXPECT_EQ(validator.fault(bad), "$.outcome is another word");
  bad = good;
  bad["target_from_source"][2].erase(0);
  EXPECT_NE(validator.fault(bad), "");
  bad = good;
  bad["surprise"] = 1;
  EXPECT_EQ(validator.fault(bad), "$.surprise is not in the schema");
}

}  // namespace
}  // namespace limen
