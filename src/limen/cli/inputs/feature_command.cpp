// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/feature_command.h"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limen/base/atomic_file.h"
#include "limen/bim/read_bim.h"
#include "limen/model/plausible_size.h"

namespace limen {
namespace {

/// The one scan, and what is reported of it.
struct FeatureScan {
  Scan scan;
  InputSummary input;
};

FeatureScan read_feature_scan(const FeatureChoice& choice, const Session& session) {
  const ReadOptions reading =
      with_choice(read_options(choice.origin, "--origin", choice.gravity), choice.reading);
  session.monitor->begin_stage("reading");
  InputScan input = read_input_scan(choice.scan, reading, session, "--units");
  FeatureScan read{std::move(input.scan), {}};
  read.input = summarise(choice.scan, read.scan);
  read.input.offset_applied = input.offset_applied;
  if (const std::string hint = degrees_hint(read.scan); !hint.empty())
    session.note(fmt::format("{}: {}", choice.scan, hint));
  return read;
}

}  // namespace

void add_feature_options(CommandLine& command, FeatureChoice& choice) {
  command.add_option("SCAN", choice.scan, "A scan of any format limen reads")->required();
  command.add_option("-o,--output FILE", choice.output, "The JSON file to write")->required();
  command.add_option("--origin x,y,z", choice.origin,
                     "Scanner position, in the coordinates of the points, metres");
  add_gravity_option(command, choice.gravity, true);
  add_units_option(command, choice.reading.units);
  add_memory_option(command, choice.reading.memory);
  add_trajectory_options(command, choice.reading);
}

int take_features(const FeatureChoice& choice, FeatureTask task, const Session& session) {
  refuse_same_file(choice.output, choice.scan);
  std::optional<BimModel> model;
  FeatureScan read;
  if (is_bim_file(choice.scan)) {
    model = read_model_input(choice.scan, session, metres_per_unit_of(choice.reading.units), "--units");
    read.input = summarise(choice.scan, *model);
  } else {
    read = read_feature_scan(choice, session);
  }
  session.monitor->begin_stage(task.stage);
  // Opened before the long work: a place that cannot be written to is an error at once.
  AtomicFile file(choice.output);
  Features features;
  if (model) {
    features = task.of_model(*model);
  } else {
    task.of_scan.extract.detect.seed = session.common.seed;
    task.of_scan.gravity = gravity_of(choice.gravity);
    PreparedScan prepared = prepare_scan(std::move(read.scan), task.of_scan, *session.monitor);
    note_place(read.input, prepared.place, session);
    features = in_own_frame(std::move(prepared));
  }
  const std::string json = task.json(features, read.input);
  session.monitor->throw_if_cancelled();
  file.write(json);
  file.commit();
  session.say(task.summary(features, read.input) + fmt::format("written to {}\n", choice.output));
  session.answer(json);
  return kExitOk;
}

}  // namespace limen
