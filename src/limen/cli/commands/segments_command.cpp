// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/scan_options.h"
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

/// Segments, and how it is known from where the scan was taken.
struct FoundSegments {
  std::vector<Segment> segments;
  Vector3d local_origin = Vector3d::Zero();
  const char* centre = "known";
};

FoundSegments segments_of(Scan&& scan, const SegmentsCommand& command, InputSummary& input,
                          const Session& session) {
  session.monitor->begin_stage("segments");
  PrepareOptions preparing;
  preparing.extract.detect.seed = session.common.seed;
  preparing.gravity = gravity_of(command.gravity);
  preparing.planes_only = true;
  preparing.segments = true;
  preparing.edges = command.segments;
  Features features = features_of(std::move(scan), preparing, input, session);
  FoundSegments found;
  found.segments = std::move(features.segments);
  found.local_origin = features.local_origin;
  if (input.place.source == PlaceSource::estimated) found.centre = "estimated";
  if (input.place.source == PlaceSource::unknown) found.centre = "unknown, so only borders of holes are used";
  return found;
}

/// The edges of a model: exactly as drawn, or (2023, IV-A) those that points spread over it show.
FoundSegments segments_of(const BimModel& model, const SegmentsCommand& command, const Session& session) {
  FoundSegments found;
  found.centre = "not needed for a model";
  session.monitor->begin_stage("segments");
  if (command.sampled_m > 0) {
    ModelSamplingOptions sampling;
    sampling.spacing_m = command.sampled_m;
    sampling.seed = session.common.seed;
    found.segments = sampled_model_segments(model, sampling, command.segments);
    return found;
  }
  found.segments = sharp_edges(visible_surface(model).polygons, command.segments.min_length_m);
  return found;
}

std::string summary(const FoundSegments& found, const std::string& output) {
  double total_m = 0.0;
  for (const Segment& segment : found.segments) total_m += segment.length();
  std::string text = fmt::format("{} segments, {:.1f} m in all; the scanner position is {}\n",
                                 found.segments.size(), total_m, found.centre);
  if (!found.segments.empty()) text += "  length m   direction\n";
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, found.segments.size()); ++i) {
    const Vector3d d = found.segments[i].direction();
    text +=
        fmt::format("{:10.3f}   {:6.3f} {:6.3f} {:6.3f}\n", found.segments[i].length(), d.x(), d.y(), d.z());
  }
  if (found.segments.size() > kShown) text += fmt::format("... {} more\n", found.segments.size() - kShown);
  return text + fmt::format("written to {}\n", output);
}

int run_model(const SegmentsCommand& command, const Session& session) {
  const BimModel model =
      read_model_input(command.scan, session, metres_per_unit_of(command.reading.units), "--units");
  AtomicFile file(command.output);
  const FoundSegments found = segments_of(model, command, session);
  const std::string json = segments_json(found.segments, model.local_origin, summarise(command.scan, model));
  return deliver(file, json, summary(found, command.output), session);
}

int run(const SegmentsCommand& command, const Session& session) {
  command.segments.check();
  refuse_same_file(command.output, command.scan);
  if (is_bim_file(command.scan)) return run_model(command, session);
  FeatureScan read = read_feature_scan(command, session);
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(command.output);
  const FoundSegments found = segments_of(std::move(read.scan), command, read.input, session);
  const std::string json = segments_json(found.segments, found.local_origin, read.input);
  return deliver(file, json, summary(found, command.output), session);
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
