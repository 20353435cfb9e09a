// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "limen/model/bim_model.h"
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
  Vector3d inner_low = Vector3d::Zero();       ///< of the central 98 % along each axis: a few echoes from the
  Vector3d inner_high = Vector3d::Zero();      ///< house across the street are left out
  bool centre_known = false;                   ///< it is known from where the points were seen
  bool mobile = false;                         ///< the scanner moved
  double metres_per_unit = 1.0;                ///< of the numbers in the file; everything here is metres
  Vector3d offset_applied = Vector3d::Zero();  ///< that the file names in a comment, already added; metres
  ScannerPlace place;                          ///< of a scan: where the scanner stood, and how that is known
};
InputSummary summarise(const std::string& path, const Scan& scan);
InputSummary summarise(const std::string& path, const BimModel& model);

/// An option by its command-line name.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;
using OptionList = std::vector<std::pair<std::string, OptionValue>>;

/// What a registration found, between what, and how it was asked: all that result.json and the report hold.
struct RegistrationReport {
  RegistrationResult result;
  InputSummary source;
  InputSummary target;
  OptionList options;
  std::uint64_t seed = 0;
  std::vector<std::string> notes;  ///< what was noticed about the inputs, sentences
};

/// A pose of the report between the numbers as they stand in the files, whatever their units: what
/// transform.txt holds. It scales where the units differ.
Matrix4d file_matrix(const RegistrationReport& report, const Rigid3& target_from_source);

/// Whether an offset that a file names in a comment was added to the numbers of either side.
bool has_offset(const RegistrationReport& report);

/// The same pose between the numbers as a program reads them that adds no such offset: what transform_raw.txt
/// holds.
Matrix4d raw_matrix(const RegistrationReport& report, const Rigid3& target_from_source);

}  // namespace limen
