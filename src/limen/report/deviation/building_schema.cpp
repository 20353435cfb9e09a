// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/deviation/deviation_schema.h"
#include "limen/report/json/schema_words.h"

namespace limen {
namespace schema {
namespace {

Json building_element_schema() {
  Json element = deviation_element_schema();
  element["properties"]["model"] = whole("of models, from 0");
  element["properties"]["seen_by"] = whole("scans with enough points on it");
  element["properties"]["moved"] = flag("it is displaced by more than moved_m, beyond doubt");
  for (const char* name : {"model", "seen_by", "moved"}) element["required"].push_back(name);
  return element;
}

Json building_summary_schema() {
  const Json counts = {{"type", "object"}, {"additionalProperties", {{"type", "integer"}}}};
  return object(
      {{"points", whole("of all scans")},
       {"points_on_faces", whole("")},
       {"points_far_from_all_faces", whole("")},
       {"elements", counts},
       {"elements_in_several_models", whole("the later ones are left out")},
       {"moved", whole("elements that are displaced")},
       {"found_by_loa", counts},
       {"common_shift", ref("shift")},
       {"unmodelled_pieces", whole("")},
       {"issues", whole("in the BCF file; 0 if none was asked for")},
       {"cloud_points", whole("in deviation.ply")}},
      {"points", "points_on_faces", "points_far_from_all_faces", "elements", "elements_in_several_models",
       "moved", "found_by_loa", "common_shift", "unmodelled_pieces", "issues", "cloud_points"});
}

Json building_model_schema() {
  return object({{"path", text("as it was given")},
                 {"elements", whole("")},
                 {"frame_from_model", rows(4, "rigid 4 x 4 matrix, metres")},
                 {"place", words({"project", "with the first", "in the frame"})}},
                {"path", "elements", "frame_from_model", "place"});
}

Json building_scan_schema() {
  return object({{"path", text("as it was given")},
                 {"index", whole("of the scan within its file, from 0")},
                 {"model_from_scan", rows(4, "into the coordinates of the first model, metres")},
                 {"pose_sigma_m", number("standard deviation of its position")},
                 {"bent", flag("each point was moved by the drift correction at its time")},
                 {"points", whole("")},
                 {"points_on_faces", whole("")},
                 {"points_far_from_all_faces", whole("")},
                 {"seen_from_known", flag("the scanner position is known")},
                 {"common_shift", ref("shift")}},
                {"path", "index", "model_from_scan", "pose_sigma_m", "bent", "points", "points_on_faces",
                 "points_far_from_all_faces", "seen_from_known", "common_shift"});
}

}  // namespace
}  // namespace schema

std::string project_deviation_schema() {
  using namespace schema;
  const Json left_out = object({{"path", text("")}, {"index", whole("")}, {"reason", text("one sentence")}},
                               {"path", "index", "reason"});
  return schema_text(
      "deviation.json of limen deviation DIR/project.json",
      object({{"project", text("its file")},
              {"models", list_of(building_model_schema(), "the first one's coordinates are used")},
              {"scans", list_of(building_scan_schema(), "that were measured")},
              {"left_out", list_of(left_out, "scans that were not")},
              {"options", {{"type", "object"}}},
              {"summary", building_summary_schema()},
              {"elements", list_of(ref("element"), "of all models, the worst first")},
              {"unmodelled",
               list_of(ref("unmodelled"), "objects that are not in the models, the largest first")},
              {"version", text("of limen")}},
             {"project", "models", "scans", "left_out", "options", "summary", "elements", "unmodelled",
              "version"}),
      {{"element", building_element_schema()},
       {"shift", element_shift_schema()},
       {"unmodelled", unmodelled_schema()}});
}

}  // namespace limen
