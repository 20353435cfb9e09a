// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/schema_words.h"
#include "limen/report/json/schemas.h"

namespace limen {
namespace schema {
namespace {

Json found_in_schema() {
  return object({{"path", text("as it was given")},
                 {"points", whole("of a scan; 0 of a model")},
                 {"centre_known", flag("the scanner position is known")},
                 {"scanner", ref("scanner")}},
                {"path", "points", "centre_known"});
}

Json ring_schema(const char* description) {
  return list_of(numbers(3, "a corner, metres"), description);
}

Json outline_schema(const char* description) {
  return list_of(ring_schema("counter-clockwise about the normal; holes clockwise"), description);
}

Json plane_schema() {
  return object({{"normal", numbers(3, "of unit length, towards the scanner where oriented")},
                 {"offset", number("normal . x = offset, metres")},
                 {"inliers", whole("points")},
                 {"rms_m", number("of the points about the plane")},
                 {"area_m2", number("of all parts, without holes")},
                 {"oriented", flag("the normal points to where it was seen from")},
                 {"outline", outline_schema("of the largest part: its outer ring, then its holes")},
                 {"parts", list_of(outline_schema("as outline"), "the other parts")}},
                {"normal", "offset", "inliers", "rms_m", "area_m2", "oriented", "outline", "parts"});
}

Json opening_schema() {
  Json sides = numbers_or_null(4, "of the lower, right, upper and left side; null: not seen");
  Json corners = ring_schema("lower left, lower right, upper right, upper left");
  corners["minItems"] = corners["maxItems"] = 4;
  return object({{"corners", corners},
                 {"facade", whole("its plane, as in planes; -1: none of them")},
                 {"evidence", whole("rays that show it")},
                 {"view", words({"through", "recess", "hole"})},
                 {"edge_sigma_m", sides},
                 {"reveal_depth_m", number("how deep its frame lies in the wall; 0: not seen")},
                 {"reveal_sigma_m", number("one standard deviation")},
                 {"reveal_complete", flag("the wall is as thick as the reveal is deep")},
                 {"outline", ring_schema("of an opening that is not a rectangle; else empty")}},
                {"corners", "facade", "evidence", "view", "edge_sigma_m", "reveal_depth_m", "reveal_sigma_m",
                 "reveal_complete", "outline"});
}

Json planes_fields() {
  return {{"input", ref("input")},
          {"inlier_threshold_m", number("largest distance of a point from its plane")},
          {"noise_m", number("of the points about smooth faces, one standard deviation")},
          {"planes", list_of(ref("plane"), "their numbers count from 0")}};
}

Json with_input(Json definitions) {
  definitions["input"] = found_in_schema();
  definitions["scanner"] = scanner_schema();
  return definitions;
}

}  // namespace
}  // namespace schema

std::string planes_schema() {
  using namespace schema;
  Json fields = planes_fields();
  fields["version"] = text("of limen");
  return schema_text("What limen planes writes",
                     object(fields, {"input", "inlier_threshold_m", "noise_m", "planes", "version"}),
                     with_input({{"plane", plane_schema()}}));
}

std::string openings_schema() {
  using namespace schema;
  Json fields = planes_fields();
  fields["openings"] = list_of(ref("opening"), "their numbers count from 0");
  fields["version"] = text("of limen");
  return schema_text(
      "What limen openings writes",
      object(fields, {"input", "inlier_threshold_m", "noise_m", "planes", "openings", "version"}),
      with_input({{"plane", plane_schema()}, {"opening", opening_schema()}}));
}

std::string segments_schema() {
  using namespace schema;
  const Json segment =
      object({{"a", numbers(3, "one end, metres")}, {"b", numbers(3, "the other end")}}, {"a", "b"});
  return schema_text("What limen segments writes",
                     object({{"input", ref("input")},
                             {"segments", list_of(segment, "straight edges")},
                             {"version", text("of limen")}},
                            {"input", "segments", "version"}),
                     with_input(Json::object()));
}

}  // namespace limen
