// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/base/atomic_file.h"
#include "limen/cli/command.h"
#include "limen/io/read_scan.h"
#include "limen/model/bim_model.h"

namespace limen {

/// "x,y,z" as three numbers. Throws Error that names `option`.
Vector3d parse_point(const std::string& text, const std::string& option);

/// Adds --gravity up|unknown, and auto where that is offered: whether the z axis of the files points up.
void add_gravity_option(CLI::App& command, std::string& gravity, bool with_auto = false);

/// What every command that takes features from a scan to a file asks for.
struct FeatureOptions {
  std::string& scan;
  std::string& output;
  std::string& origin;
  std::string& gravity;
};
/// Adds SCAN, --output, --origin and --gravity.
void add_feature_options(CLI::App& command, const FeatureOptions& options);

/// What the user said of a scan: `origin` "x,y,z" or empty (`option` names it in messages), `gravity`
/// "auto", "up" or "unknown".
ReadOptions read_options(const std::string& origin, const std::string& option, const std::string& gravity);

/// Reads the one scan of a file.
Scan read_input(const std::string& path, const ReadOptions& options, const Session& session);

/// Reads a building model and notes its warnings.
BimModel read_model_input(const std::string& path, const Session& session);

/// The end of a command that takes features: `json` goes into the file and to who asked for it, `summary` to
/// a reader. Returns the exit status.
int deliver(AtomicFile& file, const std::string& json, const std::string& summary, const Session& session);

/// Throws Error where `output` is the file `input`: a result never replaces what it was made from.
void refuse_same_file(const std::string& output, const std::string& input);

}  // namespace limen
