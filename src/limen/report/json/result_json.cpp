// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/result_json.h"

#include <algorithm>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/version.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

Json pose_json(const Rigid3& target_from_source) {
  return json_of(to_matrix(target_from_source));
}

Json covariance_json(const Matrix6d& covariance) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < 6; ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < 6; ++j) row.push_back(covariance(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json sigma_json(const PoseSigma& sigma) {
  return {{"rotation_rad", json_of(sigma.rotation_rad)},
          {"translation_m", json_of(sigma.translation_m)},
          {"centre", json_of(sigma.centre)},
          {"covariance", covariance_json(sigma.covariance)}};
}

Json probability_json(const std::optional<double>& probability) {
  return probability ? Json(*probability) : Json();
}

Json unobserved_json(const std::vector<UnobservedFreedom>& freedoms) {
  Json list = Json::array();
  for (const UnobservedFreedom& freedom : freedoms) {
    list.push_back({{"kind", freedom.rotation ? "rotation" : "translation"},
                    {"direction", json_of(freedom.direction)},
                    {"name", freedom.name}});
  }
  return list;
}

Json published_json(const PublishedScore& published) {
  return {{"method", published.method},
          {"criterion", published.value},
          {"unit", published.unit},
          {"lower_is_better", published.lower_is_better},
          {"hypotheses", published.hypotheses}};
}

Json evidence_json(const Hypothesis& pose) {
  Json json = {{"score", pose.score},
               {"agreeing_m2", pose.agreeing_m2},
               {"contradicted_m2", pose.contradicted_m2},
               {"rms_m", pose.rms_m},
               {"matched_planes", pose.matched_planes},
               {"matched_openings", pose.matched_openings}};
  if (pose.matched_segments > 0) {
    json["matched_segments"] = pose.matched_segments;
    json["agreeing_length_m"] = pose.agreeing_length_m;
  }
  if (pose.explained_share) json["explained_share"] = *pose.explained_share;
  if (!pose.room.empty()) json["room"] = pose.room;
  return json;
}

Json alternatives_json(const std::vector<Hypothesis>& alternatives) {
  Json list = Json::array();
  for (const Hypothesis& pose : alternatives) {
    list.push_back({{"target_from_source", pose_json(pose.target_from_source)},
                    {"probability", probability_json(pose.probability)},
                    {"sigma", sigma_json(pose.sigma)},
                    {"evidence", evidence_json(pose)}});
  }
  return list;
}

Json matches_json(const std::vector<PlaneMatch>& matches) {
  Json list = Json::array();
  for (const PlaneMatch& match : matches) {
    list.push_back({{"source_plane", match.source},
                    {"target_plane", match.target},
                    {"distance_m", match.distance_m},
                    {"angle_rad", match.angle_rad},
                    {"overlap_m2", match.overlap_m2}});
  }
  return list;
}

Json openings_json(const std::vector<MatchedOpenings>& matches) {
  Json list = Json::array();
  for (const MatchedOpenings& match : matches) {
    list.push_back({{"source_opening", match.source},
                    {"target_opening", match.target},
                    {"shift_across_m", match.shift_across_m},
                    {"shift_up_m", match.shift_up_m},
                    {"by_outline", match.by_outline}});
  }
  return list;
}

Json thickness_json(const std::vector<MeasuredThickness>& walls) {
  Json list = Json::array();
  for (const MeasuredThickness& wall : walls) {
    list.push_back({{"source_plane", wall.source_plane},
                    {"target_plane", wall.target_plane},
                    {"openings", wall.openings},
                    {"thickness_m", wall.value_m},
                    {"sigma_m", wall.sigma_m}});
  }
  return list;
}

Json input_json(const InputSummary& input) {
  Json json = {{"path", input.path}, {"kind", input.kind}};
  if (input.kind == "scan") {
    json["points"] = input.points;
  } else {
    json[input.kind == "model" ? "elements" : "segments"] = input.elements;
  }
  if (!input.sha256.empty()) json["sha256"] = input.sha256;
  if (!input.with.empty()) json["with"] = input.with;
  json["low"] = json_of(input.low);
  json["high"] = json_of(input.high);
  json["middle"] = json_of(input.middle);
  if (input.kind != "scan") return json;
  json["centre_known"] = input.centre_known;
  json["mobile"] = input.mobile;
  json["scanner"] = json_of(input.place);
  return json;
}

Json options_json(const OptionList& options) {
  Json object = Json::object();
  for (const auto& [name, value] : options) {
    std::visit([&object, &key = name](const auto& plain) { object[key] = plain; }, value);
  }
  return object;
}

Json stages_json(const std::vector<StageTime>& stages) {
  Json object = Json::object();
  for (const StageTime& stage : stages) {
    object[stage.name] = object.value(stage.name, 0.0) + stage.seconds;
  }
  return object;
}

/// Middle of the central 90 % of the points along each axis, about the local origin: a few echoes of the
/// house across the street, seen through a window, do not move it.
Vector3d middle_of(const std::vector<Vector3d>& points) {
  if (points.empty()) return Vector3d::Zero();
  constexpr std::size_t kEnough = 20000;
  const std::size_t stride = 1 + points.size() / kEnough;
  Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (std::size_t i = 0; i < points.size(); i += stride) values.push_back(points[i][axis]);
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 20;
    middle[axis] = 0.5 * (values[cut] + values[values.size() - 1 - cut]);
  }
  return middle;
}

}  // namespace

InputSummary summarise(const std::string& path, const Scan& scan) {
  const Extent extent = extent_of(scan.points);
  InputSummary summary;
  summary.path = path;
  summary.points = scan.size();
  summary.low = scan.local_origin + extent.low;
  summary.high = scan.local_origin + extent.high;
  summary.middle = scan.local_origin + middle_of(scan.points);
  summary.centre_known = scan.centre_known();
  if (scan.centre_known()) summary.place.source = scan.mobile() ? PlaceSource::per_point : scan.centre_source;
  if (scan.centres.size() == 1) summary.place.centre = scan.local_origin + scan.centres.front();
  summary.mobile = scan.mobile();
  return summary;
}

InputSummary summarise(const std::string& path, const BimModel& model) {
  std::vector<Vector3d> corners;
  for (const BimFace& face : model.faces) {
    for (const Vector2d& p : face.outline.outer) corners.push_back(face.frame.to_space(p));
  }
  const Extent extent = extent_of(corners);
  InputSummary summary;
  summary.path = path;
  summary.kind = "model";
  summary.elements = model.elements.size();
  summary.low = model.local_origin + extent.low;
  summary.high = model.local_origin + extent.high;
  summary.middle = 0.5 * (summary.low + summary.high);
  return summary;
}

std::string result_json(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  const bool found = result.outcome != Outcome::no_match;
  Json json;
  json["outcome"] = to_string(result.outcome);
  json["reason"] = result.reason;
  json["target_from_source"] = found ? pose_json(result.best.target_from_source) : Json();
  json["sigma"] = found && !result.published ? sigma_json(result.sigma) : Json();
  json["probability"] = found && !result.published ? probability_json(result.best.probability) : Json();
  if (result.others) {
    json["probability_of_nothing_shared"] = result.others->nothing_shared;
    json["probability_of_twin"] = result.others->twin;
    json["probability_of_unlisted_pose"] = result.others->unlisted_pose;
  }
  json["evidence"] = found ? evidence_json(result.best) : Json();
  if (result.published) json["published"] = published_json(*result.published);
  json["unobserved"] = unobserved_json(result.unobserved);
  json["alternatives"] = alternatives_json(result.alternatives);
  json["matches"] = matches_json(result.matches);
  json["matched_openings"] = openings_json(result.openings);
  json["wall_thickness"] = thickness_json(result.thickness);
  json["inputs"] = {{"source", input_json(report.source)}, {"target", input_json(report.target)}};
  json["options"] = options_json(report.options);
  json["version"] = kVersion;
  json["seed"] = report.seed;
  json["stages"] = stages_json(result.stages);
  return to_text(json);
}

std::string transform_text(const Rigid3& target_from_source) {
  const Matrix4d matrix = to_matrix(target_from_source);
  std::string text;
  for (int i = 0; i < 4; ++i) {
    // + 0.0 turns a negative zero into zero.
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", matrix(i, 0) + 0.0, matrix(i, 1) + 0.0,
                        matrix(i, 2) + 0.0, matrix(i, 3) + 0.0);
  }
  return text;
}

void write_numbers(const std::filesystem::path& folder, const RegistrationReport& report) {
  const std::string json = result_json(report);
  if (report.result.outcome == Outcome::no_match) {
    write_file(folder / "result.json", json);
    std::filesystem::remove(folder / "transform.txt");
    return;
  }
  const std::string transform = transform_text(report.result.best.target_from_source);
  write_files({{folder / "transform.txt", transform}, {folder / "result.json", json}});
}

}  // namespace limen
