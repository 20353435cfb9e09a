// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/result_schema.h"

#include <memory>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "limen/report/json/json_values.h"
#include "limen/report/json/result_json.h"

namespace limen {
namespace {

/// The part of JSON Schema that the schema uses; tells the first fault, or nothing.
class Validator {
 public:
  explicit Validator(Json schema) : root_(std::move(schema)) {}
  [[nodiscard]] std::string fault(const Json& value) const { return fault(value, root_, "$"); }

 private:
  static bool is_type(const Json& value, const std::string& type) {
    if (type == "null") return value.is_null();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    return type == "array" ? value.is_array() : value.is_object();
  }

  static bool has_type(const Json& value, const Json& types) {
    if (types.is_string()) return is_type(value, types);
    return std::any_of(types.begin(), types.end(), [&](const Json& type) { return is_type(value, type); });
  }

  [[nodiscard]] std::string fault(const Json& value, const Json& schema, const std::string& at) const {
    if (schema.contains("$ref"))
      return fault(value, root_["$defs"][schema["$ref"].get<std::string>().substr(8)], at);
    if (schema.contains("anyOf")) {
      for (const Json& one : schema["anyOf"])
        if (fault(value, one, at).empty()) return {};
      return at + " fits none of its forms: " + fault(value, schema["anyOf"][0], at);
    }
    if (schema.contains("type") && !has_type(value, schema["type"])) return at + " has another type";
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      return at + " is another word";
    if (schema.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
      return at + " has another form";
    if (value.is_number() &&
        (value < schema.value("minimum", Json(-1e300)) || value > schema.value("maximum", Json(1e300))))
      return at + " is out of bounds";
    if (value.is_array()) return array_fault(value, schema, at);
    return value.is_object() ? object_fault(value, schema, at) : "";
  }

  [[nodiscard]] std::string array_fault(const Json& value, const Json& schema, const std::string& at) const {
    if (value.size() < schema.value("minItems", 0U) || value.size() > schema.value("maxItems", 1000000U))
      return at + " has another length";
    for (std::size_t k = 0; k < value.size() && schema.contains("items"); ++k) {
      const std::string found = fault(value[k], schema["items"], at + "[" + std::to_string(k) + "]");
      if (!found.empty()) return found;
    }
    return {};
  }

  [[nodiscard]] std::string object_fault(const Json& value, const Json& schema, const std::string& at) const {
    for (const Json& name : schema.value("required", Json::array()))
      if (!value.contains(name.get<std::string>())) return at + " lacks " + name.get<std::string>();
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [name, field] : value.items()) {
      // Nothing is written that the contract does not name.
      if (!properties.empty() && !properties.contains(name)) return at + "." + name + " is not in the schema";
      if (!properties.contains(name)) continue;
      const std::string found = fault(field, properties[name], at + "." + name);
      if (!found.empty()) return found;
    }
    return {};
  }

  Json root_;
};

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
  for (const Outcome outcome :
       {Outcome::registered, Outcome::ambiguous, Outcome::under_constrained, Outcome::no_match}) {
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
