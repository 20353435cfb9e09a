// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/evaluation_schema.h"

#include "limen/report/json/schema_words.h"

namespace limen {

std::string evaluation_schema() {
  using namespace schema;
  Json outcome = words({"registered", "ambiguous", "under_constrained", "no_match"});
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
           {"measured_at", three("middle of the source, else its origin; source coordinates")},
           {"rotation_error_vector_rad", three("found less true, target frame")},
           {"translation_error_vector_m", three("found less true, target frame")},
           {"largest_error_in_sigmas", number_or_null("the worst of six, in the stated deviations")},
           {"within_sigma", {{"type", {"boolean", "null"}}, {"description", "none beyond three"}}}},
          {"outcome", "rotation_error_deg", "translation_error_m", "measured_at", "rotation_error_vector_rad",
           "translation_error_vector_m", "largest_error_in_sigmas", "within_sigma"}),
      Json::object());
}

}  // namespace limen
