// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/result_json.h"

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/version.h"
#include "limen/report/json/json_values.h"
#include "limen/report/summary/advice.h"
#include "limen/report/summary/precision.h"

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
  Json json = {{"rotation_rad", json_of(sigma.rotation_rad)},
               {"translation_m", json_of(sigma.translation_m)},
               {"centre", json_of(sigma.centre)},
               {"covariance", covariance_json(sigma.covariance)}};
  if (!sigma.formal_covariance.isZero(0.0))
    json["formal_covariance"] = covariance_json(sigma.formal_covariance);
  return json;
}

Json place_json(const PlacePrecision& place) {
  Json json = {{"at", json_of(place.at)}, {"radius_m", place.radius_m}};
  if (place.formal_radius_m) json["formal_radius_m"] = *place.formal_radius_m;
  return json;
}

Json precision_json(const RegistrationReport& report) {
  const auto precision = precision_of(report, report.result.best);
  if (!precision) return {};
  Json json = {{"confidence", kStatedConfidence},
               {"middle", place_json(precision->middle)},
               {"far_end", place_json(precision->far_end)}};
  json["far_end"]["distance_m"] = precision->far_distance_m;
  json["across_unobserved"] = precision->across_open;
  return json;
}

Json motion_json(const RegistrationReport& report) {
  const PoseMotion motion = motion_of(report, report.result.best);
  return {{"about", json_of(motion.about)},
          {"shift_m", json_of(motion.shift_m)},
          {"axis", json_of(motion.axis)},
          {"turn_rad", motion.turn_rad}};
}

Json causes_json(const RegistrationReport& report) {
  return list_json(likely_causes(report), [&](const LikelyCause& cause) -> Json {
    return {{"cause", cause.name}, {"measured", cause.measured}, {"remedy", cause.remedy}};
  });
}

Json unobserved_json(const std::vector<UnobservedFreedom>& freedoms) {
  return list_json(freedoms, [&](const UnobservedFreedom& freedom) -> Json {
    return {{"kind", freedom.rotation ? "rotation" : "translation"},
            {"direction", json_of(freedom.direction)},
            {"name", freedom.name}};
  });
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
  return list_json(alternatives, [&](const Hypothesis& pose) -> Json {
    return {{"target_from_source", pose_json(pose.target_from_source)},
            {"probability", json_of(pose.probability)},
            {"sigma", sigma_json(pose.sigma)},
            {"tie", pose.tie},
            {"evidence", evidence_json(pose)}};
  });
}

Json matches_json(const std::vector<PlaneMatch>& matches) {
  return list_json(matches, [&](const PlaneMatch& match) -> Json {
    return {{"source_plane", match.source},
            {"target_plane", match.target},
            {"distance_m", match.distance_m},
            {"angle_rad", match.angle_rad},
            {"overlap_m2", match.overlap_m2}};
  });
}

Json openings_json(const std::vector<MatchedOpenings>& matches) {
  return list_json(matches, [&](const MatchedOpenings& match) -> Json {
    return {{"source_opening", match.source},
            {"target_opening", match.target},
            {"shift_across_m", match.shift_across_m},
            {"shift_up_m", match.shift_up_m},
            {"by_outline", match.by_outline}};
  });
}

Json thickness_json(const std::vector<MeasuredThickness>& walls) {
  return list_json(walls, [&](const MeasuredThickness& wall) -> Json {
    return {{"source_plane", wall.source_plane},
            {"target_plane", wall.target_plane},
            {"openings", wall.openings},
            {"thickness_m", wall.value_m},
            {"sigma_m", wall.sigma_m}};
  });
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
  json["metres_per_unit"] = input.metres_per_unit;
  if (!input.offset_applied.isZero(0.0)) json["offset_applied"] = json_of(input.offset_applied);
  json["inner_low"] = json_of(input.inner_low);
  json["inner_high"] = json_of(input.inner_high);
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

/// Those of an earlier run, transform_1.txt, transform_raw.txt and so on.
void remove_variants(const std::filesystem::path& folder) {
  static constexpr std::string_view kStart = "transform_";
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name.starts_with(kStart) && name.ends_with(".txt");
    const std::string number = ours ? name.substr(kStart.size(), name.size() - kStart.size() - 4) : "";
    if (number == "raw") old.push_back(entry.path());
    if (!number.empty() && number.find_first_not_of("0123456789") == std::string::npos)
      old.push_back(entry.path());
  }
  for (const std::filesystem::path& path : old) std::filesystem::remove(path);
}

}  // namespace

std::string result_json(const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  const bool found = result.outcome != Outcome::no_match;
  Json json;
  json["outcome"] = to_string(result.outcome);
  json["reason"] = result.reason;
  json["target_from_source"] = found ? pose_json(result.best.target_from_source) : Json();
  json["sigma"] = found && !result.published ? sigma_json(result.sigma) : Json();
  json["probability"] = found && !result.published ? json_of(result.best.probability) : Json();
  if (result.others) {
    json["probability_of_nothing_shared"] = result.others->nothing_shared;
    json["probability_of_twin"] = result.others->look_alike;
    json["probability_of_unlisted_pose"] = result.others->unlisted_pose;
  }
  if (found && result.start)
    json["start"] = {{"shift_m", result.start->shift_m},
                     {"turn_rad", result.start->turn_rad},
                     {"sigmas", result.start->sigmas},
                     {"refuted", result.start->refuted()}};
  json["evidence"] = found ? evidence_json(result.best) : Json();
  if (result.published) json["published"] = published_json(*result.published);
  json["motion"] = found ? motion_json(report) : Json();
  json["precision"] = found ? precision_json(report) : Json();
  if (const auto planes = plane_distance_rms(result.matches); found && planes)
    json["evidence"]["plane_distance_rms_m"] = *planes;
  json["unobserved"] = unobserved_json(result.unobserved);
  json["alternatives"] = found ? alternatives_json(result.alternatives) : Json::array();
  json["matches"] = matches_json(result.matches);
  json["moved_planes"] = matches_json(result.moved);
  json["matched_openings"] = openings_json(result.openings);
  json["wall_thickness"] = thickness_json(result.thickness);
  json["inputs"] = {{"source", input_json(report.source)}, {"target", input_json(report.target)}};
  json["notes"] = report.notes;
  json["options"] = options_json(report.options);
  if (!found) json["likely_causes"] = causes_json(report);
  json["next_steps"] = next_steps(report);
  json["version"] = kVersion;
  json["seed"] = report.seed;
  json["stages"] = stages_json(result.stages);
  return to_text(json);
}

std::string transform_text(const Rigid3& target_from_source) {
  return matrix_text(to_matrix(target_from_source));
}

std::string matrix_text(const Matrix4d& matrix) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    // + 0.0 turns a negative zero into zero.
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", matrix(i, 0) + 0.0, matrix(i, 1) + 0.0,
                        matrix(i, 2) + 0.0, matrix(i, 3) + 0.0);
  }
  return text;
}

std::string alternative_file(std::size_t number) {
  return fmt::format("transform_{}.txt", number);
}

void write_numbers(const std::filesystem::path& folder, const RegistrationReport& report) {
  const RegistrationResult& result = report.result;
  const std::string json = result_json(report);
  remove_variants(folder);
  if (result.outcome == Outcome::no_match) {
    write_file(folder / "result.json", json);
    std::filesystem::remove(folder / "transform.txt");
    return;
  }
  // Held until they are written: write_files() takes views.
  std::vector<std::pair<std::filesystem::path, std::string>> texts = {
      {folder / "transform.txt", matrix_text(file_matrix(report, result.best.target_from_source))}};
  if (has_offset(report))
    texts.emplace_back(folder / "transform_raw.txt",
                       matrix_text(raw_matrix(report, result.best.target_from_source)));
  for (std::size_t k = 0; k < result.alternatives.size(); ++k) {
    if (result.alternatives[k].tie)
      texts.emplace_back(folder / alternative_file(k + 1),
                         matrix_text(file_matrix(report, result.alternatives[k].target_from_source)));
  }
  texts.emplace_back(folder / "result.json", json);
  std::vector<FileToWrite> files;
  files.reserve(texts.size());
  for (const auto& [path, text] : texts) files.push_back({path, text});
  write_files(files);
}

}  // namespace limen
