// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/schema_words.h"
#include "limen/report/json/schemas.h"

namespace limen {

std::string evaluation_schema() {
  using namespace schema;
  Json outcome = words({"registered", "probable", "ambiguous", "under_constrained", "no_match"});
  outcome["enum"].push_back(nullptr);
  const auto three = [](const char* description) {
    return Json{{"anyOf", {numbers(3, description), Json{{"type", "null"}}}}};
  };
  return schema_text(
      "What limen evaluate prints",
      object(
          {{"outcome", outcome},
           {"rotation_error_deg", number_or_null("angle of the turn between the two")},
           {"translation_error_m", number_or_null("of the point measured_at")},
           {"measured_at", three("centre of the source, else its origin; source coordinates")},
           {"rotation_error_vector_rad", three("found minus true, target frame")},
           {"translation_error_vector_m", three("found minus true, target frame")},
           {"largest_error_in_sigmas", number_or_null("the worst of six, in the stated deviations")},
           {"within_sigma", {{"type", {"boolean", "null"}}, {"description", "none beyond three"}}}},
          {"outcome", "rotation_error_deg", "translation_error_m", "measured_at", "rotation_error_vector_rad",
           "translation_error_vector_m", "largest_error_in_sigmas", "within_sigma"}),
      Json::object());
}

std::string project_evaluation_schema() {
  using namespace schema;
  const Json error = object({{"file", text("of the scan")},
                             {"translation_error_m", number("at its scanner; of a pass, amid the stations")},
                             {"rotation_error_deg", number("angle of the turn between the two")}},
                            {"file", "translation_error_m", "rotation_error_deg"});
  Json reference = text("the scan against which the others err least");
  reference["type"] = {"string", "null"};
  return schema_text(
      "What limen evaluate prints of a project",
      object({{"scans", whole("of the project, models and copies not counted")},
              {"registered", whole("of them")},
              {"reference", reference},
              {"within_m", number("the bound of --within-m")},
              {"within_deg", number("the bound of --within-deg")},
              {"within", whole("registered scans that err by no more than both")},
              {"translation_error_median_m",
               number_or_null("of registered scans, the reference left out; null: no other is registered")},
              {"translation_error_largest_m", number_or_null("of the same")},
              {"beyond", list_of(error, "registered scans that are not within the bounds")},
              {"errors", list_of(error, "all registered scans")}},
             {"scans", "registered", "reference", "within_m", "within_deg", "within",
              "translation_error_median_m", "translation_error_largest_m", "beyond", "errors"}),
      Json::object());
}

}  // namespace limen
