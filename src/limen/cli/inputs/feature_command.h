// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/terminal/command.h"
#include "limen/model/bim_model.h"
#include "limen/model/features.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// What every command that takes features from a scan or a model to a file is asked for.
struct FeatureChoice {
  std::string scan;
  std::string output;
  std::string origin;
  std::string gravity = "auto";
  ReadingChoice reading;
};
/// Adds SCAN, --output, --origin, --gravity, --memory and --trajectory with what belongs to it.
void add_feature_options(CommandLine& command, FeatureChoice& choice);

/// What such a command takes, and what it says of it. Features are in the file's own frame.
struct FeatureTask {
  const char* stage = "";
  PrepareOptions of_scan;  ///< without what the user says of every scan
  std::function<Features(const BimModel&)> of_model;
  std::function<std::string(const Features&, const InputSummary&)> json;     ///< for the file
  std::function<std::string(const Features&, const InputSummary&)> summary;  ///< for a reader
};
/// Reads the scan or model, takes the features, and writes them. Returns the exit status.
int take_features(const FeatureChoice& choice, FeatureTask task, const Session& session);

}  // namespace limen
