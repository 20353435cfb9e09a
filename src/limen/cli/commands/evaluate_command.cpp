// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/cli/commands/commands.h"
#include "limen/report/evaluation.h"
#include "limen/report/json/json_values.h"
#include "limen/report/project/evaluate_project.h"

namespace limen {
namespace {

/// An error of more than this many standard deviations in any freedom contradicts the stated sigma.
constexpr double kWithinSigmas = 3.0;

struct EvaluateOptions {
  std::string result;
  std::string truth;
  double within_m = 0.02;
  double within_deg = 0.1;
};

std::string as_json(const PoseFile& result, const std::optional<PoseError>& error) {
  Json json;
  json["outcome"] = result.outcome ? Json(to_string(*result.outcome)) : Json();
  json["rotation_error_deg"] = error ? Json(degrees(error->rotation_rad)) : Json();
  json["translation_error_m"] = error ? Json(error->translation_m) : Json();
  json["measured_at"] = error ? json_of(error->measured_at) : Json();
  json["rotation_error_vector_rad"] = error ? json_of(error->rotation_vector_rad) : Json();
  json["translation_error_vector_m"] = error ? json_of(error->shift_m) : Json();
  const bool measured = error && error->largest_sigmas;
  const double sigmas = measured ? *error->largest_sigmas : 0.0;
  json["largest_error_in_sigmas"] = measured ? Json(sigmas) : Json();
  json["within_sigma"] = measured ? Json(sigmas <= kWithinSigmas) : Json();
  return to_text(json);
}

std::string as_text(const PoseFile& result, const std::optional<PoseError>& error) {
  std::string text;
  if (result.outcome) text += fmt::format("outcome            {}\n", to_string(*result.outcome));
  if (!error) return text + "no pose to compare\n";
  text += fmt::format("rotation error     {:.6f} deg\n", degrees(error->rotation_rad));
  text += fmt::format("translation error  {:.6f} m, at the {} ({:.3f}, {:.3f}, {:.3f})\n",
                      error->translation_m, result.source_middle ? "centre of the source" : "source's origin",
                      error->measured_at.x(), error->measured_at.y(), error->measured_at.z());
  if (error->largest_sigmas) {
    text +=
        fmt::format("against sigma      worst of six errors is {:.2f} sigma: {}\n", *error->largest_sigmas,
                    *error->largest_sigmas <= kWithinSigmas ? "within 3" : "beyond 3");
  }
  return text;
}

bool is_within(const PlaceError& error, const EvaluateOptions& options) {
  return error.shift_m <= options.within_m && degrees(error.turn_rad) <= options.within_deg;
}

std::vector<PlaceError> beyond(const ProjectErrors& errors, const EvaluateOptions& options) {
  std::vector<PlaceError> all;
  for (const PlaceError& error : errors.each) {
    if (!is_within(error, options)) all.push_back(error);
  }
  return all;
}

std::string project_json(const ProjectErrors& errors, const EvaluateOptions& options) {
  const auto stated = [](const std::vector<PlaceError>& list) {
    Json all = Json::array();
    for (const PlaceError& error : list)
      all.push_back({{"file", error.file},
                     {"translation_error_m", error.shift_m},
                     {"rotation_error_deg", degrees(error.turn_rad)}});
    return all;
  };
  const std::vector<PlaceError> far = beyond(errors, options);
  Json json;
  json["scans"] = errors.scans;
  json["registered"] = errors.each.size();
  json["reference"] = errors.each.empty() ? Json() : Json(errors.each[errors.reference].file);
  json["within_m"] = options.within_m;
  json["within_deg"] = options.within_deg;
  json["within"] = errors.each.size() - far.size();
  // Of the reference alone there is no error.
  const bool compared = errors.each.size() > 1;
  json["translation_error_median_m"] = compared ? Json(errors.shift_of(0.5)) : Json();
  json["translation_error_largest_m"] = compared ? Json(errors.shift_of(1.0)) : Json();
  json["beyond"] = stated(far);
  json["errors"] = stated(errors.each);
  return to_text(json);
}

std::string project_text(const ProjectErrors& errors, const EvaluateOptions& options) {
  std::string text = fmt::format("registered         {} of {} scans\n", errors.each.size(), errors.scans);
  if (errors.each.size() < 2) return text + "no poses to compare\n";
  const std::vector<PlaceError> far = beyond(errors, options);
  text += fmt::format("within             {} of them, {:g} m and {:g} deg\n", errors.each.size() - far.size(),
                      options.within_m, options.within_deg);
  text += fmt::format("translation error  median {:.4f} m, largest {:.4f} m, against {}\n",
                      errors.shift_of(0.5), errors.shift_of(1.0), errors.each[errors.reference].file);
  for (const PlaceError& error : far)
    text += fmt::format("beyond             {}: {:.4f} m, {:.4f} deg\n", error.file, error.shift_m,
                        degrees(error.turn_rad));
  return text;
}

int run_project(const EvaluateOptions& options, const Session& session) {
  if (!(options.within_deg >= 0.0))
    throw Error("is not an angle of 0 or more", "--within-deg", "give degrees, as 0.1");
  const ProjectErrors errors =
      evaluate_project(read_project(options.result), read_true_scans(options.truth), options.truth);
  session.say(project_text(errors, options));
  session.answer(project_json(errors, options));
  return kExitOk;
}

int run(const EvaluateOptions& options, const Session& session) {
  if (is_project(options.result)) return run_project(options, session);
  const PoseFile result = read_pose_file(options.result);
  const Rigid3 truth = read_true_pose(options.truth, result);
  std::optional<PoseError> error;
  if (result.target_from_source) error = compare_poses(result, truth);
  session.say(as_text(result, error));
  session.answer(as_json(result, error));
  return kExitOk;
}

}  // namespace

void add_evaluate_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<EvaluateOptions>();
  CommandLine* command =
      add_command(app, session, "evaluate", "Compare a pose, or the poses of a project, with the true ones",
                  [options, &session] { return run(*options, session); });
  command
      ->add_option("RESULT", options->result, "result.json, a text file with a 4 x 4 matrix, or project.json")
      ->required();
  command
      ->add_option("TRUTH", options->truth,
                   "The true pose: a text file with a 4 x 4 matrix (in the unit of the registered files, as "
                   "transform.txt), a JSON object with transform, or the truth.json of limen simulate; for a "
                   "project its truth/project.json")
      ->required();
  add_length_option(*command, "--within-m", options->within_m,
                    "For a project: list each scan whose position is off by more than this (default 0.02)");
  command->add_option("--within-deg DEG", options->within_deg,
                      "For a project: list each scan whose rotation is off by more than this (default 0.1)");
}

}  // namespace limen
