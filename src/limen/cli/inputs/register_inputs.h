// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "limen/cli/terminal/command.h"
#include "limen/io/cloud/point_print.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/register/prepare/prepare_scan.h"
#include "limen/register/register.h"
#include "limen/report/json/result_json.h"

namespace limen {

/// Whether two names are of one file, or of files that are equal byte for byte.
bool same_bytes(const std::string& a, const std::string& b);

/// Notices where both sides of a registration are one scan, or one is a part or a thinned copy of the other.
/// Sides are shown to it as they are read; a model is no scan.
class SamePointsWatch {
 public:
  SamePointsWatch(std::string source, std::string target)
      : source_(std::move(source)), target_(std::move(target)) {}

  /// A sentence for the user, the first time that there is reason: with the source, before the long work,
  /// where the files are equal, else with the target.
  std::string note_on(const RegisterInput& side, bool is_source);
  /// The sentence again; empty: both are scans of their own.
  [[nodiscard]] const std::string& note() const { return note_; }

 private:
  std::string source_;
  std::string target_;
  PointPrint of_source_;
  std::string note_;
};

/// Whether both files hold segments. Throws Error where only one does: a scan and a list of segments share
/// nothing that could be matched.
bool are_segment_files(const std::string& source, const std::string& target);

/// Reads both and registers them; everything of the report but `options`.
RegistrationReport register_segment_files(const std::string& source, const std::string& target,
                                          Gravity gravity, const Session& session);

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
