// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/deviation/deviation_schema.h"

#include "limen/report/json/schema_words.h"

namespace limen {
namespace schema {

Json deviation_element_schema() {
  const Json kinds = words({"wall", "slab", "roof", "column", "beam", "stair", "railing", "covering", "plate",
                            "window", "door", "furniture", "terrain", "other"});
  Json loa = words({"LOA10", "LOA20", "LOA30", "LOA40", "LOA50"});
  loa["enum"].push_back(nullptr);
  return object({{"element", whole("of the model, from 0")},
                 {"kind", kinds},
                 {"type", text("as the model has it: IfcWall")},
                 {"guid", text("of the model")},
                 {"name", text("of the model")},
                 {"storey", text("of the model")},
                 {"presence", words({"found", "not_found", "not_judged"})},
                 {"points", whole("on its faces")},
                 {"area_m2", number("of its faces")},
                 {"covered_m2", number("with points")},
                 {"passed_m2", number("through which the scanner saw")},
                 {"covered_share", number("of what could be seen")},
                 {"median_m", number("of the distances of its points, outwards positive")},
                 {"mean_m", number("")},
                 {"sigma_m", number("")},
                 {"p95_m", number("of the distances without their sign")},
                 {"loa", loa},
                 {"shift", ref("shift")}},
                {"element", "kind", "type", "guid", "name", "storey", "presence", "points", "area_m2",
                 "covered_m2", "passed_m2", "covered_share"});
}

Json element_shift_schema() {
  return object(
      {{"shift_m", numbers(3, "of the element, model frame")},
       {"sigma_m", numbers_or_null(3, "one standard deviation; null: open")},
       {"held", whole("number of directions that the points determine, 0 to 3")},
       {"open", list_of(numbers(3, "of unit length"), "directions that the points leave undetermined")}},
      {"shift_m", "sigma_m", "held", "open"});
}

Json unmodelled_schema() {
  return object({{"points", whole("")},
                 {"centre", numbers(3, "model coordinates")},
                 {"low", numbers(3, "of its box")},
                 {"high", numbers(3, "of its box")},
                 {"size_m", numbers(3, "of its box")},
                 {"within_model", flag("it lies inside the model's box")}},
                {"points", "centre", "low", "high", "size_m", "within_model"});
}

namespace {

Json summary_schema() {
  const Json counts = {{"type", "object"}, {"additionalProperties", {{"type", "integer"}}}};
  return object({{"points", whole("")},
                 {"points_on_faces", whole("")},
                 {"points_far_from_all_faces", whole("")},
                 {"seen_from_known", flag("the scanner position is known")},
                 {"elements", counts},
                 {"found_by_loa", counts},
                 {"common_shift", ref("shift")},
                 {"unmodelled_pieces", whole("")}},
                {"points", "points_on_faces", "points_far_from_all_faces", "seen_from_known", "elements",
                 "found_by_loa", "common_shift", "unmodelled_pieces"});
}

Json input_schemas() {
  const Json scan = object({{"path", text("as it was given")},
                            {"points", whole("")},
                            {"with", list_of({{"type", "string"}}, "further scans")}},
                           {"path", "points"});
  const Json model =
      object({{"path", text("as it was given")}, {"elements", whole("")}}, {"path", "elements"});
  return object({{"scan", scan}, {"model", model}}, {"scan", "model"});
}

Json fields_of_deviation() {
  const Json pose = object({{"result", {{"type", {"string", "null"}}, {"description", "file of the pose"}}},
                            {"outcome", {{"type", {"string", "null"}}, {"description", "of that file"}}},
                            {"model_from_scan", rows(4, "rigid 4 x 4 matrix, metres")}},
                           {"result", "outcome", "model_from_scan"});
  return {{"inputs", input_schemas()},
          {"pose", pose},
          {"options", {{"type", "object"}}},
          {"summary", summary_schema()},
          {"elements", list_of(ref("element"), "in the order of the model")},
          {"unmodelled", list_of(ref("unmodelled"), "objects that are not in the model, the largest first")},
          {"version", text("of limen")}};
}

}  // namespace
}  // namespace schema

std::string deviation_schema() {
  using namespace schema;
  return schema_text("deviation.json of limen deviation",
                     object(fields_of_deviation(),
                            {"inputs", "pose", "options", "summary", "elements", "unmodelled", "version"}),
                     {{"element", deviation_element_schema()},
                      {"shift", element_shift_schema()},
                      {"unmodelled", unmodelled_schema()}});
}

}  // namespace limen
