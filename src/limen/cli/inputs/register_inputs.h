// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/register/register.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// What the user says of one side of a registration.
struct SideOptions {
  std::string path;
  std::vector<std::string> with;  ///< further scans of this side, each with the file of its pose
  ReadOptions reading;            ///< of scans
  std::string units_option;       ///< by which the command names the unit of this side
};

/// One side as it was read, and what the report says of it.
struct InputSide {
  RegisterInput input;
  InputSummary summary;
};

/// Reads a scan, a group of scans or a building model, by content. Warnings of a model are noted.
InputSide read_side(const SideOptions& options, const Session& session);

}  // namespace limen
