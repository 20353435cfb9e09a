// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/text.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/feature_command.h"
#include "limen/extract/model/model_features.h"
#include "limen/report/json/features_json.h"

namespace limen {
namespace {

struct PlanesOptions : FeatureChoice {
  std::string detector = "auto";
  std::string threshold = "auto";
  int min_inliers = 0;
  ExtractOptions extract;
};

/// A rule by its name, else a length in metres.
void set_threshold(const std::string& text, ExtractOptions& extract) {
  if (const std::optional<ThresholdRule> rule = value_called(kThresholdRules, text)) {
    extract.detect.threshold = *rule;
    return;
  }
  double& metres = extract.grow.inlier_threshold_m;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, metres);
  if (error != std::errc() || rest != end || !(metres >= 0.0) || !std::isfinite(metres)) {
    throw Error(fmt::format("--threshold-m is \"{}\", but must be a length in metres or a rule", text), "",
                "write auto, noise, a_contrario or a number as 0.01");
  }
}

std::string summary(const Features& features) {
  std::string text =
      fmt::format("{} planes (points within {:.1f} mm; noise {:.1f} mm)\n", features.planes.size(),
                  1e3 * features.inlier_threshold_m, 1e3 * features.noise_m);
  if (!features.planes.empty()) text += "      points    area m2   rms mm   normal\n";
  return text + first_lines(features.planes, 10, [](const PlanarPolygon& plane) {
           const Vector3d& n = plane.plane.normal;
           return fmt::format("{:12} {:10.2f} {:8.2f}   {:6.3f} {:6.3f} {:6.3f}\n", plane.inliers,
                              plane.area_m2, 1e3 * plane.rms_m, n.x(), n.y(), n.z());
         });
}

int run(PlanesOptions options, const Session& session) {
  options.extract.detect.detector = value_called(kPlaneDetectors, options.detector).value();
  set_threshold(options.threshold, options.extract);
  if (options.min_inliers != 0) {
    options.extract.grow.min_inliers = options.min_inliers;
    options.extract.interior.min_inliers = options.min_inliers;
  }
  options.extract.check();
  FeatureTask task;
  task.stage = "planes";
  task.of_scan.extract = options.extract;
  task.of_scan.planes_only = true;
  task.of_model = [](const BimModel& model) { return model_features(model).features; };
  task.json = features_json;
  task.summary = [](const Features& features, const InputSummary&) { return summary(features); };
  return take_features(options, std::move(task), session);
}

}  // namespace

void add_planes_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<PlanesOptions>();
  CommandLine* command =
      add_command(app, session, "planes", "Find the planes of a scan or a model and their outlines",
                  [options, &session] { return run(*options, session); });
  add_feature_options(*command, *options);
  command
      ->add_option("--detector", options->detector,
                   "How planes are found (default auto, which is grow); scan_lines needs a scan whose lines "
                   "are known; msac is slow")
      ->one_of(names_in(kPlaneDetectors));
  command->add_option("--threshold-m,--inlier-threshold-m METRES|RULE", options->threshold,
                      "Largest distance of a point from its plane: metres, or a rule: auto (default), noise, "
                      "a_contrario; 0 is auto");
  command->add_option("--min-inliers N", options->min_inliers,
                      "Smallest number of points of a plane; 0: 200, and 40 of what is seen through windows "
                      "(default)");
  add_length_option(*command, "--alpha-m", options->extract.polygons.alpha_m,
                    "Radius of the outlines' alpha shape; 0: from the spacing of the points (default)");
}

}  // namespace limen
