// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/scan_options.h"
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

std::string summary(const Features& features, const PlanesOptions& options) {
  std::string text =
      fmt::format("{} planes (points within {:.1f} mm; noise {:.1f} mm)\n", features.planes.size(),
                  1e3 * features.inlier_threshold_m, 1e3 * features.noise_m);
  if (!features.planes.empty()) text += "      points    area m2   rms mm   normal\n";
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, features.planes.size()); ++i) {
    const PlanarPolygon& plane = features.planes[i];
    const Vector3d& n = plane.plane.normal;
    text += fmt::format("{:12} {:10.2f} {:8.2f}   {:6.3f} {:6.3f} {:6.3f}\n", plane.inliers, plane.area_m2,
                        1e3 * plane.rms_m, n.x(), n.y(), n.z());
  }
  if (features.planes.size() > kShown) text += fmt::format("... {} more\n", features.planes.size() - kShown);
  return text + fmt::format("written to {}\n", options.output);
}

int run_model(const PlanesOptions& options, const Session& session) {
  const BimModel model =
      read_model_input(options.scan, session, metres_per_unit_of(options.reading.units), "--units");
  session.monitor->begin_stage("planes");
  AtomicFile file(options.output);
  const Features features = model_features(model).features;
  const std::string json = features_json(features, summarise(options.scan, model));
  return deliver(file, json, summary(features, options), session);
}

int run(PlanesOptions options, const Session& session) {
  options.extract.detect.detector = value_called(kPlaneDetectors, options.detector).value();
  options.extract.detect.seed = session.common.seed;
  set_threshold(options.threshold, options.extract);
  if (options.min_inliers != 0) {
    options.extract.grow.min_inliers = options.min_inliers;
    options.extract.interior.min_inliers = options.min_inliers;
  }
  options.extract.check();
  refuse_same_file(options.output, options.scan);
  if (is_bim_file(options.scan)) return run_model(options, session);
  FeatureScan read = read_feature_scan(options, session);
  session.monitor->begin_stage("planes");
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(options.output);
  PrepareOptions preparing;
  preparing.extract = options.extract;
  preparing.gravity = gravity_of(options.gravity);
  preparing.planes_only = true;
  const Features features = features_of(std::move(read.scan), preparing, read.input, session);
  const std::string json = features_json(features, read.input);
  return deliver(file, json, summary(features, options), session);
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
      ->one_of({"auto", "grow", "msac", "scan_lines"});
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
