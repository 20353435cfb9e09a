// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/feature_command.h"
#include "limen/extract/model/model_edges.h"
#include "limen/extract/model/model_surface.h"
#include "limen/extract/model/sample_model.h"
#include "limen/extract/segments/segments.h"
#include "limen/report/json/features_json.h"

namespace limen {
namespace {

struct SegmentsCommand : FeatureChoice {
  SegmentOptions segments;
  double sampled_m = 0.0;
};

/// The edges of a model: exactly as drawn, or (2023, IV-A) those that points spread over it show.
Features segments_of(const BimModel& model, const SegmentsCommand& command, const Session& session) {
  Features features;
  features.local_origin = model.local_origin;
  if (command.sampled_m > 0) {
    ModelSamplingOptions sampling;
    sampling.spacing_m = command.sampled_m;
    sampling.seed = session.common.seed;
    features.segments = sampled_model_segments(model, sampling, command.segments);
    return features;
  }
  features.segments = sharp_edges(visible_surface(model).polygons, command.segments.min_length_m);
  return features;
}

/// How it is known from where the scan was taken.
const char* centre_words(const InputSummary& input) {
  if (input.kind == "model") return "not needed for a model";
  if (input.place.source == PlaceSource::estimated) return "estimated";
  if (input.place.source == PlaceSource::unknown) return "unknown, so only borders of holes are used";
  return "known";
}

std::string summary(const Features& features, const InputSummary& input) {
  double total_m = 0.0;
  for (const Segment& segment : features.segments) total_m += segment.length();
  std::string text = fmt::format("{} segments, {:.1f} m in all; the scanner position is {}\n",
                                 features.segments.size(), total_m, centre_words(input));
  if (!features.segments.empty()) text += "  length m   direction\n";
  return text + first_lines(features.segments, 10, [](const Segment& segment) {
           const Vector3d d = segment.direction();
           return fmt::format("{:10.3f}   {:6.3f} {:6.3f} {:6.3f}\n", segment.length(), d.x(), d.y(), d.z());
         });
}

int run(const SegmentsCommand& command, const Session& session) {
  command.segments.check();
  FeatureTask task;
  task.stage = "segments";
  task.of_scan.planes_only = true;
  task.of_scan.segments = true;
  task.of_scan.edges = command.segments;
  task.of_model = [&](const BimModel& model) { return segments_of(model, command, session); };
  task.json = segments_json;
  task.summary = summary;
  return take_features(command, std::move(task), session);
}

}  // namespace

void add_segments_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<SegmentsCommand>();
  CommandLine* command = add_command(app, session, "segments",
                                     "Find the 3-D line segments of a scan or a building model: its edges",
                                     [options, &session] { return run(*options, session); });
  add_feature_options(*command, *options);
  SegmentOptions& o = options->segments;
  add_length_option(*command, "--min-length-m", o.min_length_m,
                    "Length of the shortest segment (default 0.2)");
  add_length_option(*command, "--join-gap-m", o.join_gap_m,
                    "Pieces of one line are joined across gaps up to this (default 0.15)");
  add_length_option(*command, "--max-border-sigma-m", o.max_border_sigma_m,
                    "Borders of surfaces with a larger standard deviation are left out (default 0.006)");
  add_length_option(*command, "--sampled-m", options->sampled_m,
                    "For a model: find edges in points sampled at this spacing, instead of the exact edges");
  command->add_option("--min-angle-deg DEGREES", o.min_angle_deg,
                      "Smallest angle between two surfaces that form an edge (default 12)");
}

}  // namespace limen
