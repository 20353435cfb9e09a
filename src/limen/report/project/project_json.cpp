// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/project_json.h"

#include "limen/base/version.h"
#include "limen/report/json/json_values.h"
#include "limen/report/project/station_accuracy.h"
#include "limen/report/summary/precision.h"

namespace limen {
namespace {

Json pose_sigma_json(const PoseSigma& sigma) {
  return {{"rotation_rad", json_of(sigma.rotation_rad)},
          {"translation_m", json_of(sigma.translation_m)},
          {"centre", json_of(sigma.centre)}};
}

Json correction_json(const PassCorrection& correction) {
  Json knots = list_json(correction.knots, [&](const PassKnot& knot) -> Json {
    return {{"time_s", knot.time_s},
            {"distance_m", knot.distance_m},
            {"place", json_of(knot.place)},
            {"turn_rad", json_of(knot.turn_rad)},
            {"shift_m", json_of(knot.shift_m)},
            {"moved_m", json_of(knot.moved_m)},
            {"turn_sigma_rad", json_of(knot.turn_sigma_rad)},
            {"moved_sigma_m", json_of(knot.moved_sigma_m)}};
  });
  return {{"pivot", json_of(correction.pivot)},
          {"knots", std::move(knots)},
          {"walk_m2_per_m", correction.shift_rate_m2_per_m},
          {"walk_rad2_per_m", correction.turn_rate_rad2_per_m}};
}

Json scan_json(const ProjectScan& scan, const std::optional<StationAccuracy>& accuracy) {
  Json json = {{"file", scan.file}, {"index", scan.index}, {"kind", scan.model ? "model" : "scan"}};
  if (!scan.model) {
    json["mobile"] = scan.mobile;
    json["points"] = scan.points;
  }
  json["sha256"] = scan.sha256;
  if (!scan.copy_of.empty()) json["copy_of"] = scan.copy_of;
  json["readable"] = scan.readable;
  json["state"] = to_string(scan.state);
  json["component"] = scan.component >= 0 ? Json(scan.component) : Json();
  // A pose in the frame of another component must not be taken for one in the project's.
  const bool in_frame = scan.frame_from_scan && scan.component == 0;
  json["frame_from_scan"] = in_frame ? json_of(to_matrix(*scan.frame_from_scan)) : Json();
  if (scan.frame_from_scan && !in_frame)
    json["component_from_scan"] = json_of(to_matrix(*scan.frame_from_scan));
  json["sigma"] = scan.frame_from_scan ? pose_sigma_json(scan.sigma) : Json();
  if (accuracy && !accuracy->held_fixed) {
    json["radius_95_m"] = accuracy->radius_m;
    json["loa"] = accuracy->loa > 0 ? Json(accuracy->loa) : Json();
    if (accuracy->within_tolerance) json["within_tolerance"] = *accuracy->within_tolerance;
  }
  // As the pose: only in the project's frame.
  if (scan.correction && in_frame) json["correction"] = correction_json(*scan.correction);
  if (scan.stated) {
    json["stated_position"] = {{"x", json_of(scan.stated->x)},
                               {"sigma_m", json_of(Vector3d(scan.stated->covariance.diagonal().cwiseSqrt()))},
                               {"missed_m", scan.stated->missed_m ? Json(*scan.stated->missed_m) : Json()},
                               {"contradicted", scan.stated->contradicted}};
  }
  if (!scan.rigid.empty()) json["rigid"] = scan.rigid;
  if (!scan.alternatives.empty()) {
    json["alternatives"] =
        list_json(scan.alternatives, [&](const Rigid3& pose) -> Json { return json_of(to_matrix(pose)); });
  }
  json["doubt"] = scan.frame_from_scan ? Json(scan.doubt) : Json();
  json["reason"] = scan.reason;
  return json;
}

Json link_json(const ProjectResult& result, std::size_t k) {
  const ProjectLink& link = result.links[k];
  Json json = {{"source", link.source},
               {"target", link.target},
               {"state", to_string(link.solved.state)},
               {"pair", link.given ? "given" : to_string(link.pair)},
               {"pose", json_of(to_matrix(link.target_from_source))},
               {"pose_number", link.number},
               {"sigma", pose_sigma_json(link.sigma)},
               {"agreeing_m2", link.agreeing_m2},
               {"overlap", json_of(overlap_of(result, k))},
               {"plane_rms_m", json_of(plane_distance_rms(link.matches))},
               {"adjusted_rms_m", json_of(plane_distance_rms(link.adjusted))},
               {"twin", link.look_alike},
               {"chance", link.chance},
               {"redundancy", link.solved.redundancy},
               {"loop_error_m", is_checked(link) ? Json(link.solved.loop_error_m) : Json()},
               {"loop_error_rad", is_checked(link) ? Json(link.solved.loop_error_rad) : Json()},
               {"loops", loops_through(result, k)}};
  Json alternatives = list_json(link.alternatives, [&](const ProjectAlternative& other) -> Json {
    return {{"number", other.number},
            {"pose", json_of(to_matrix(other.target_from_source))},
            {"agreeing_m2", other.agreeing_m2}};
  });
  json["alternatives"] = std::move(alternatives);
  json["reason"] = link.reason;
  return json;
}

Json loop_json(const GraphLoop& loop) {
  return {{"links", loop.links},
          {"error_m", loop.error_m},
          {"error_rad", loop.error_rad},
          {"chi_square", loop.chi_square},
          {"closes", loop.closes}};
}

Json decision_json(const ProjectDecision& stated) {
  return {
      {"decision", words_of(stated.decision)}, {"state", to_string(stated.state)}, {"reason", stated.reason}};
}

Json question_json(const ProjectQuestion& question) {
  Json answers =
      list_json(question.answers, [&](const Decision& answer) -> Json { return words_of(answer); });
  return {{"text", question.text},
          {"answers", answers},
          {"scans", question.scans},
          {"for_the_present_place", question.current},
          {"for_another_place", question.rival}};
}

Json point_json(const ProjectPoint& point) {
  Json json = {{"name", point.name}, {"role", to_string(point.role)}, {"state", to_string(point.state)}};
  if (point.scanner) json["scanner"] = true;
  if (point.given) {
    json["given"] = json_of(*point.given);
    json["given_sigma_m"] = json_of(point.given_sigma);
  }
  json["found"] = point.found ? json_of(*point.found) : Json();
  if (point.found) json["found_sigma_m"] = json_of(point.found_sigma);
  if (point.found && point.given) {
    json["missed_m"] = json_of(point.test.residual);
    json["missed_sigma_m"] = json_of(point.test.sigma);
    json["w"] = json_of(point.test.w);
    json["chi_square"] = point.test.squared;
    if (point.state == PointState::used) {
      json["redundancy"] = point.test.redundancy;
      json["detectable_m"] = json_of(point.test.detectable);
    }
  }
  Json sights = list_json(point.sights, [&](const ProjectSight& sight) -> Json {
    return {{"scan", sight.scan},
            {"used", sight.used},
            {"missed_m", sight.missed_m ? Json(*sight.missed_m) : Json()}};
  });
  json["seen_by"] = std::move(sights);
  json["reason"] = point.reason;
  return json;
}

}  // namespace

std::string project_json(const ProjectResult& result, const OptionList& options, const FrameSystem& system) {
  Json json;
  json["outcome"] = to_string(result.outcome);
  json["reason"] = result.reason;
  const bool of_scan = result.frame_scan >= 0;
  json["frame"] = {{"kind", result.frame_kind},
                   {"scan", of_scan ? Json(result.frame_scan) : Json()},
                   {"file", of_scan ? Json(result.scans[static_cast<std::size_t>(result.frame_scan)].file)
                            : result.frame_kind == "control" ? Json(result.control_file)
                                                             : Json()},
                   {"sigma_against", result.sigma_scan >= 0 ? Json(result.sigma_scan) : Json()}};
  if (system.system.known())
    json["frame"]["crs"] = {{"name", system.system.name},
                            {"code", system.system.code},
                            {"wkt", system.system.wkt.empty() ? system.system.stated : system.system.wkt},
                            {"said_by", system.said_by}};
  const StatedTrajectories& stated = system.trajectories;
  if (!stated.files.empty())
    json["trajectories"] = {{"files", stated.files},
                            {"columns", stated.reading.columns},
                            {"utm_zone", stated.reading.utm_zone},
                            {"time_offset_s", stated.reading.time_offset_s},
                            {"lever_arm_m", json_of(stated.reading.lever_arm_m)}};
  json["components"] = result.components;
  json["scans"] = Json::array();
  for (std::size_t k = 0; k < result.scans.size(); ++k)
    json["scans"].push_back(scan_json(result.scans[k], accuracy_of(result, k)));
  json["links"] = Json::array();
  for (std::size_t k = 0; k < result.links.size(); ++k) json["links"].push_back(link_json(result, k));
  json["loops"] = list_json(result.loops, loop_json);
  json["questions"] = list_json(result.questions, question_json);
  if (!result.decisions.empty()) json["decisions"] = list_json(result.decisions, decision_json);
  if (!result.control_file.empty() || !result.points.empty()) {
    json["control"] = {{"reason", result.control_words}, {"variance_factor", result.control_factor}};
    json["points"] = list_json(result.points, point_json);
  }
  if (const std::optional<BundleError> bundle = bundle_error(result))
    json["bundle"] = {{"rms_m", bundle->rms_m},
                      {"planes", bundle->planes},
                      {"worst_link", bundle->worst},
                      {"worst_rms_m", bundle->worst_rms_m}};
  json["pairs_tried"] = result.pairs_tried;
  json["variance_factor"] = result.variance_factor;
  json["notes"] = result.notes;
  json["options"] = Json::object();
  for (const auto& [name, value] : options)
    std::visit([&json, &key = name](const auto& plain) { json["options"][key] = plain; }, value);
  json["version"] = kVersion;
  return to_text(json);
}

}  // namespace limen
