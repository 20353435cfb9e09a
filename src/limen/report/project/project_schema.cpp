// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_schema.h"

#include "limen/report/json/schema_words.h"

namespace limen {
namespace schema {
namespace {

Json correction_schema() {
  const Json knot = object(
      {{"time_s", number("of the points' own clock")},
       {"distance_m", number("travelled")},
       {"place", numbers(3, "of the scanner, corrected; frame")},
       {"turn_rad", numbers(3, "about the pivot, frame axes")},
       {"shift_m", numbers(3, "of the pivot")},
       {"moved_m", numbers(3, "by what both move the position")},
       {"turn_sigma_rad", numbers(3, "one standard deviation")},
       {"moved_sigma_m", numbers(3, "one standard deviation")}},
      {"time_s", "distance_m", "place", "turn_rad", "shift_m", "moved_m", "turn_sigma_rad", "moved_sigma_m"});
  return object({{"pivot", numbers(3, "frame")},
                 {"knots", list_of(knot, "along the way, in the order of time")},
                 {"walk_m2_per_m", number("rate of the random walk of the shift, per axis")},
                 {"walk_rad2_per_m", number("rate of the random walk of the turn, per axis")}},
                {"pivot", "knots", "walk_m2_per_m", "walk_rad2_per_m"});
}

Json project_scan_schema() {
  return object(
      {{"file", text("as it was given")},
       {"index", whole("of the scan within its file, from 0")},
       {"kind", words({"scan", "model"})},
       {"mobile", flag("of a scan")},
       {"points", whole("of a scan")},
       {"sha256", text("of the file's bytes")},
       {"copy_of", text("another file of the same bytes")},
       {"readable", flag("")},
       {"state", words({"registered", "probable", "ambiguous", "under_constrained", "floating"})},
       {"component", {{"type", {"integer", "null"}}, {"description", "0: the project's; null: none"}}},
       {"frame_from_scan", nullable("pose")},
       {"component_from_scan", ref("pose")},
       {"sigma", nullable("sigma")},
       {"radius_95_m", number("of a ball that holds its position with 95 %")},
       {"loa",
        {{"type", {"integer", "null"}}, {"description", "Level of Accuracy of the USIBD by that radius"}}},
       {"within_tolerance", flag("that radius is at most the tolerance asked for")},
       {"correction", correction_schema()},
       {"stated_position",
        object({{"x", numbers(3, "as --poses has it, or the file, metres")},
                {"sigma_m", numbers(3, "its uncertainty (1 sigma)")},
                {"missed_m",
                 number_or_null("its distance from where the scans put it; null: too few to compare")},
                {"contradicted", flag("it is off by more than chance explains (once in a thousand)")}},
               {"x", "sigma_m", "missed_m", "contradicted"})},
       {"rigid", text("of a mobile pass: why its drift was not corrected")},
       {"alternatives", list_of(ref("pose"), "other poses that fit as well")},
       {"doubt", number_or_null("probability that its pose is wrong")},
       {"reason", text("one sentence")}},
      {"file", "index", "kind", "sha256", "readable", "state", "component", "frame_from_scan", "sigma",
       "doubt", "reason"});
}

Json link_schema() {
  const Json other = object({{"number", whole("among the poses of the pair")},
                             {"pose", ref("pose")},
                             {"agreeing_m2", number("surface of each scan that agrees with the other")}},
                            {"number", "pose", "agreeing_m2"});
  return object(
      {{"source", whole("of scans, from 0")},
       {"target", whole("of scans, from 0")},
       {"state", words({"verified", "bridge", "ambiguous", "rejected", "weak", "in_place"})},
       {"pair", words({"given", "registered", "probable", "ambiguous", "under_constrained", "no_match"})},
       {"pose", ref("pose")},
       {"pose_number", whole("among the poses of the pair, 0 the best")},
       {"sigma", ref("sigma")},
       {"agreeing_m2", number("surface of each scan that agrees with the other")},
       {"overlap", number_or_null("share of the planes of the smaller scan that agree, by area")},
       {"plane_rms_m", number_or_null("root mean square of the distances between planes that agree")},
       {"adjusted_rms_m", number_or_null("the same under the adjusted poses; null of bent passes")},
       {"twin", number("probability that a look-alike place was taken for it")},
       {"chance", number("probability that it is wrong otherwise")},
       {"redundancy", number_or_null("share of its six numbers that others check, 0 to 6")},
       {"loop_error_m", number_or_null("shift between it and the adjusted poses; null: nothing checks it")},
       {"loop_error_rad", number_or_null("turn between it and the adjusted poses")},
       {"loops", whole("that close through it")},
       {"alternatives", list_of(other, "other poses of the pair")},
       {"reason", text("one sentence")}},
      {"source", "target", "state", "pair", "pose", "pose_number", "sigma", "agreeing_m2", "overlap",
       "plane_rms_m", "adjusted_rms_m", "twin", "chance", "redundancy", "loop_error_m", "loop_error_rad",
       "loops", "alternatives", "reason"});
}

Json point_schema() {
  const Json sight =
      object({{"scan", whole("of scans, from 0")},
              {"used", flag("it enters the solution")},
              {"missed_m", number_or_null("distance from the position by the other observations")}},
             {"scan", "used", "missed_m"});
  return object({{"name", text("as in the files")},
                 {"role", words({"control", "check", "tie"})},
                 {"state", words({"used", "left_out", "compared", "not_placed"})},
                 {"scanner", flag("the point is a scanner position")},
                 {"given", numbers(3, "by the surveyor")},
                 {"given_sigma_m", numbers_or_null(3, "one standard deviation")},
                 {"found", {{"anyOf", {numbers(3, "by the scans"), Json{{"type", "null"}}}}}},
                 {"found_sigma_m", numbers_or_null(3, "one standard deviation")},
                 {"missed_m", numbers_or_null(3, "given minus found")},
                 {"missed_sigma_m", numbers_or_null(3, "one standard deviation")},
                 {"w", numbers_or_null(3, "missed, in standard deviations")},
                 {"chi_square", number_or_null("of the three")},
                 {"redundancy", number_or_null("share of its three numbers that others check, 0 to 3")},
                 {"detectable_m", numbers_or_null(3, "the smallest gross error that would be detected")},
                 {"seen_by", list_of(sight, "the scans that saw it")},
                 {"reason", text("one sentence")}},
                {"name", "role", "state", "found", "seen_by", "reason"});
}

Json project_definitions() {
  return {{"pose", rows(4, "rigid 4 x 4 matrix, metres")},
          {"sigma", pose_sigma_schema()},
          {"scan", project_scan_schema()},
          {"link", link_schema()},
          {"point", point_schema()},
          {"loop", object({{"links", list_of({{"type", "integer"}}, "of links, from 0")},
                           {"error_m", number("shift after one round")},
                           {"error_rad", number("turn after one round")},
                           {"chi_square", number_or_null("of the six numbers")},
                           {"closes", flag("")}},
                          {"links", "error_m", "error_rad", "chi_square", "closes"})},
          {"question", object({{"text", text("in words")},
                               {"answers", list_of({{"type", "string"}}, "for limen project decide")},
                               {"scans", list_of({{"type", "integer"}}, "that would move, from 0")},
                               {"for_the_present_place", list_of({{"type", "integer"}}, "links, from 0")},
                               {"for_another_place", list_of({{"type", "integer"}}, "links, from 0")}},
                              {"text", "answers", "scans", "for_the_present_place", "for_another_place"})},
          {"decision", object({{"decision", text("as it was given")},
                               {"state", words({"kept", "contradicted", "unused"})},
                               {"reason", text("one sentence")}},
                              {"decision", "state", "reason"})}};
}

Json project_fields() {
  const Json crs = object({{"name", text("of the coordinate system, as far as it is known")},
                           {"code", text("EPSG:NUMBER, as far as it is known")},
                           {"wkt", text("well-known text, else as it was given")},
                           {"said_by", words({"user", "file"})}},
                          {"name", "code", "wkt", "said_by"});
  const Json frame =
      object({{"kind", words({"control", "mobile", "model", "file", "station", "none"})},
              {"scan", {{"type", {"integer", "null"}}, {"description", "whose frame it is, from 0"}}},
              {"file", {{"type", {"string", "null"}}, {"description", "whose frame it is"}}},
              {"sigma_against",
               {{"type", {"integer", "null"}},
                {"description",
                 "the scan, from 0, that is held fixed: sigma of every other scan is relative to it; null: "
                 "no scan is fixed, sigma is relative to the control points"}}},
              {"crs", crs}},
             {"kind", "scan", "file"});
  const Json trajectories =
      object({{"files", list_of({{"type", "string"}}, "as they were given")},
              {"columns", list_of({{"type", "string"}}, "of a text, where they were given")},
              {"utm_zone", text("or the coordinate system of positions in latitude and longitude")},
              {"time_offset_s", number("added to their times")},
              {"lever_arm_m", numbers(3, "forward, right, down")}},
             {"files", "columns", "utm_zone", "time_offset_s", "lever_arm_m"});
  const Json control =
      object({{"reason", text("one sentence")}, {"variance_factor", number_or_null("of the control points")}},
             {"reason", "variance_factor"});
  const Json bundle =
      object({{"rms_m", number("of the distances between planes that agree, all links, adjusted poses")},
              {"planes", whole("pairs of planes")},
              {"worst_link", whole("of links, from 0")},
              {"worst_rms_m", number("its own")}},
             {"rms_m", "planes", "worst_link", "worst_rms_m"});
  return {{"outcome", words({"registered", "partial", "no_match"})},
          {"reason", text("one sentence")},
          {"frame", frame},
          {"trajectories", trajectories},
          {"components", whole("number of groups of scans with no link between them")},
          {"scans", list_of(ref("scan"), "scans and models, in the order of the call")},
          {"links", list_of(ref("link"), "pairs that overlap")},
          {"loops", list_of(ref("loop"), "rounds of links")},
          {"questions", list_of(ref("question"), "questions to somebody who knows the building")},
          {"decisions", list_of(ref("decision"), "answers that were given")},
          {"control", control},
          {"points", list_of(ref("point"), "control, check and tie points")},
          {"bundle", bundle},
          {"pairs_tried", whole("")},
          {"variance_factor", number_or_null("of the links")},
          {"notes", list_of({{"type", "string"}}, "for a user")},
          {"options", {{"type", "object"}}},
          {"version", text("of limen")}};
}

}  // namespace
}  // namespace schema

std::string project_schema() {
  using namespace schema;
  return schema_text("project.json of limen project",
                     object(project_fields(),
                            {"outcome", "reason", "frame", "components", "scans", "links", "loops",
                             "questions", "pairs_tried", "variance_factor", "notes", "options", "version"}),
                     project_definitions());
}

}  // namespace limen
