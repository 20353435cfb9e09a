// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/evaluate_command.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/report/evaluation.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

/// An error of more than this many standard deviations in any freedom contradicts the stated sigma.
constexpr double kWithinSigmas = 3.0;

struct EvaluateOptions {
  std::string result;
  std::string truth;
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
                      error->translation_m, result.source_middle ? "middle of the source" : "source's origin",
                      error->measured_at.x(), error->measured_at.y(), error->measured_at.z());
  if (error->largest_sigmas) {
    text +=
        fmt::format("against sigma      worst of six errors is {:.2f} sigma: {}\n", *error->largest_sigmas,
                    *error->largest_sigmas <= kWithinSigmas ? "within 3" : "beyond 3");
  }
  return text;
}

int run(const EvaluateOptions& options, const Session& session) {
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
  CommandLine* command = add_command(app, session, "evaluate", "Compare a pose with the true one",
                                     [options, &session] { return run(*options, session); });
  command->add_option("RESULT", options->result, "result.json, or a text of 4 x 4 numbers")->required();
  command
      ->add_option(
          "TRUTH", options->truth,
          "The true pose: a text of 4 x 4 numbers, a JSON object with transform, or the truth.json of "
          "limen simulate")
      ->required();
}

}  // namespace limen
