// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "limen/model/bim_model.h"
#include "limen/model/features.h"
#include "limen/model/result.h"
#include "limen/model/scan.h"
#include "limen/model/scanner_place.h"

namespace limen {

/// What a report says about one scan, group of scans or model that went in.
struct InputSummary {
  std::string path;                    ///< as the user wrote it
  std::string kind = "scan";           ///< or "model", or "segments"
  std::string sha256;                  ///< of the file's bytes, 64 hexadecimal digits; empty where not taken
  std::vector<std::string> with;       ///< further scans of the group
  std::size_t elements = 0;            ///< of a model, or segments
  std::size_t points = 0;              ///< that could be used
  Vector3d low = Vector3d::Zero();     ///< extent of the points, metres, world
  Vector3d high = Vector3d::Zero();    ///< extent of the points, metres, world
  Vector3d middle = Vector3d::Zero();  ///< of the central 90 % along each axis: where errors are measured
  bool centre_known = false;           ///< it is known from where the points were seen
  bool mobile = false;                 ///< the scanner moved
  ScannerPlace place;                  ///< of a scan: where the scanner stood, and how that is known
};
InputSummary summarise(const std::string& path, const Scan& scan);
InputSummary summarise(const std::string& path, const BimModel& model);

/// An option by its command-line name.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;
using OptionList = std::vector<std::pair<std::string, OptionValue>>;

/// All that result.json holds.
struct RegistrationReport {
  RegistrationResult result;
  InputSummary source;
  InputSummary target;
  OptionList options;
  std::uint64_t seed = 0;
};

/// The text of result.json. Everything is the same from run to run but `stages`, the seconds of each stage.
/// `target_from_source` is null for no_match; with any other outcome it is the best pose found.
std::string result_json(const RegistrationReport& report);

/// The 4 x 4 matrix as CloudCompare reads it: four lines of four numbers of 17 digits.
std::string transform_text(const Rigid3& target_from_source);

/// Writes result.json and, but for no_match, transform.txt: both, or none where Error is thrown. A transform
/// of an earlier run does not outlive a run that found none.
void write_numbers(const std::filesystem::path& folder, const RegistrationReport& report);

}  // namespace limen
