// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/schema_words.h"
#include "limen/report/json/schemas.h"

namespace limen {
namespace schema {
namespace {

Json outcomes() {
  return {{"enum", {"registered", "probable", "ambiguous", "under_constrained", "no_match"}}};
}

Json sigma_schema() {
  return object({{"rotation_rad", numbers(3, "one standard deviation about x, y, z of the target, radians")},
                 {"translation_m", numbers(3, "along x, y, z, of the point centre, metres")},
                 {"centre", numbers(3, "the point known best, target coordinates")},
                 {"covariance", rows(6, "of (rotation, translation of centre)")},
                 {"formal_covariance", rows(6, "the same from the scatter of the points alone")}},
                {"rotation_rad", "translation_m", "centre", "covariance"});
}

Json evidence_schema() {
  return object({{"score", number("higher is better")},
                 {"agreeing_m2", number("surface of each scan that agrees with the other")},
                 {"contradicted_m2", number("surface where the other scanner saw empty space")},
                 {"rms_m", number("of points about the planes of the other side")},
                 {"plane_distance_rms_m", number("between matched planes, weighted by overlap")},
                 {"matched_planes", whole("pairs of planes")},
                 {"matched_openings", whole("pairs of openings")},
                 {"matched_segments", whole("of lists of segments")},
                 {"agreeing_length_m", number("of lists of segments")},
                 {"explained_share", number("against a model: of the walls that the scan saw")},
                 {"room", text("of the model, in which the first station is")}},
                {"score", "agreeing_m2", "contradicted_m2", "rms_m", "matched_planes", "matched_openings"});
}

Json alternative_schema() {
  return object({{"target_from_source", ref("pose")},
                 {"probability", {{"type", {"number", "null"}}}},
                 {"sigma", ref("sigma")},
                 {"tie", {{"type", "boolean"}, {"description", "it cannot be distinguished from the best"}}},
                 {"evidence", ref("evidence")}},
                {"target_from_source", "probability", "sigma", "tie", "evidence"});
}

Json place_schema() {
  return object({{"at", numbers(3, "target coordinates")},
                 {"radius_m", number("within which the true position is with the stated confidence")},
                 {"formal_radius_m", number("the same from the scatter of the points alone")},
                 {"distance_m", number("of the far end from the middle")}},
                {"at", "radius_m"});
}

Json input_schema() {
  return object({{"path", text("as it was given")},
                 {"kind", {{"enum", {"scan", "model", "segments"}}}},
                 {"points", whole("of a scan")},
                 {"elements", whole("of a model")},
                 {"segments", whole("of a list")},
                 {"sha256", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}},
                 {"with", list_of({{"type", "string"}}, "further scans of the side")},
                 {"low", numbers(3, "of the extent, metres")},
                 {"high", numbers(3, "of the extent, metres")},
                 {"middle", numbers(3, "of the central 90 % along each axis")},
                 {"inner_low", numbers(3, "of the central 98 % along each axis")},
                 {"inner_high", numbers(3, "of the central 98 % along each axis")},
                 {"metres_per_unit", number("of the numbers in the file; everything here is metres")},
                 {"offset_applied", numbers(3, "that the file names in a comment, already added, metres")},
                 {"centre_known", {{"type", "boolean"}}},
                 {"mobile", {{"type", "boolean"}}},
                 {"scanner", ref("scanner")}},
                {"path", "kind", "low", "high", "middle", "inner_low", "inner_high", "metres_per_unit"});
}

Json definitions() {
  return {{"pose", rows(4, "rigid 4 x 4 matrix: x_in_target = pose * x_in_source, metres")},
          {"sigma", sigma_schema()},
          {"evidence", evidence_schema()},
          {"alternative", alternative_schema()},
          {"place", place_schema()},
          {"input", input_schema()},
          {"scanner", scanner_schema()},
          {"motion", object({{"about", numbers(3, "the source's middle, source coordinates")},
                             {"shift_m", numbers(3, "of that point")},
                             {"axis", numbers(3, "of the turn, target frame")},
                             {"turn_rad", number("about that point")}},
                            {"about", "shift_m", "axis", "turn_rad"})},
          {"precision", object({{"confidence", number("0.95")},
                                {"middle", ref("place")},
                                {"far_end", ref("place")},
                                {"across_unobserved", {{"type", "boolean"}}}},
                               {"confidence", "middle", "far_end", "across_unobserved"})},
          {"unobserved", object({{"kind", {{"enum", {"rotation", "translation"}}}},
                                 {"direction", numbers(3, "target frame")},
                                 {"name", text("in words")}},
                                {"kind", "direction", "name"})},
          {"match", object({{"source_plane", whole("as limen planes numbers them")},
                            {"target_plane", whole("as limen planes numbers them")},
                            {"distance_m", number("along the target's normal")},
                            {"angle_rad", number("between the normals")},
                            {"overlap_m2", number("of the two")}},
                           {"source_plane", "target_plane", "distance_m", "angle_rad", "overlap_m2"})},
          {"opening_match", object({{"source_opening", whole("as limen openings numbers them")},
                                    {"target_opening", whole("as limen openings numbers them")},
                                    {"shift_across_m", number("within the wall")},
                                    {"shift_up_m", number("within the wall")},
                                    {"by_outline", {{"type", "boolean"}}}},
                                   {"source_opening", "target_opening", "shift_across_m", "shift_up_m"})},
          {"wall", object({{"source_plane", whole("")},
                           {"target_plane", whole("")},
                           {"openings", whole("that show them to be one wall")},
                           {"thickness_m", number("")},
                           {"sigma_m", number("one standard deviation")}},
                          {"source_plane", "target_plane", "openings", "thickness_m", "sigma_m"})},
          {"cause", object({{"cause", text("overlap, units, axes, place of the scanner, another pair")},
                            {"measured", text("what the data show")},
                            {"remedy", text("what to do")}},
                           {"cause", "measured", "remedy"})}};
}

Json fields() {
  Json probability = {{"type", {"number", "null"}}, {"minimum", 0}, {"maximum", 1}};
  Json share = {{"type", "number"}, {"minimum", 0}, {"maximum", 1}};
  return {{"outcome", outcomes()},
          {"reason", text("one sentence: why this outcome")},
          {"target_from_source", nullable("pose")},
          {"sigma", nullable("sigma")},
          {"probability", probability},
          {"probability_of_nothing_shared", share},
          {"probability_of_twin", share},
          {"probability_of_unlisted_pose", share},
          {"start", object({{"shift_m", number("of the source's middle from where the start puts it")},
                            {"turn_rad", number("")},
                            {"sigmas", number("the larger of both, in the deviations given")},
                            {"refuted", {{"type", "boolean"}}}},
                           {"shift_m", "turn_rad", "sigmas", "refuted"})},
          {"evidence", nullable("evidence")},
          {"published", {{"type", "object"}}},
          {"motion", nullable("motion")},
          {"precision", nullable("precision")},
          {"unobserved", list_of(ref("unobserved"), "directions the scans do not fix")},
          {"alternatives", list_of(ref("alternative"), "different poses, best first")},
          {"matches", list_of(ref("match"), "pairs of planes that agree")},
          {"moved_planes", list_of(ref("match"),
                                   "planes that were probably not built where the model has them, or were "
                                   "moved between two scans")},
          {"matched_openings", list_of(ref("opening_match"), "pairs of openings that agree")},
          {"wall_thickness", list_of(ref("wall"), "of walls between the scans")},
          {"inputs", object({{"source", ref("input")}, {"target", ref("input")}}, {"source", "target"})},
          {"notes", list_of({{"type", "string"}}, "what was noticed about the inputs")},
          {"options", {{"type", "object"}}},
          {"next_steps", list_of({{"type", "string"}}, "what to do next; DIR is the folder of this file")},
          {"likely_causes", list_of(ref("cause"), "of no_match, the likeliest first")},
          {"version", text("of limen")},
          {"seed", {{"type", "integer"}, {"minimum", 0}}},
          {"stages", {{"type", "object"}, {"additionalProperties", {{"type", "number"}}}}}};
}

}  // namespace
}  // namespace schema

std::string result_schema() {
  using namespace schema;
  return schema_text(
      "result.json of limen register",
      object(fields(), {"outcome", "reason", "target_from_source", "sigma", "probability", "evidence",
                        "motion", "precision", "unobserved", "alternatives", "matches", "matched_openings",
                        "wall_thickness", "inputs", "options", "next_steps", "version", "seed", "stages"}),
      definitions());
}

}  // namespace limen
