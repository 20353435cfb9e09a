// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/model/scan.h"

namespace limen {

/// What a user may say about a scan file that the file itself does not.
struct ReadOptions {
  /// Optical centre in the file's coordinates, metres. Empty: what the file says, else 0,0,0 where that can
  /// be the scanner (the points lie around it and none is closer than a scanner can measure), else unknown.
  std::optional<Vector3d> origin;
  bool level = true;  ///< the file's z axis points up (--gravity up)

  void check() const;
};

/// Reads every scan of a file; the format is recognised by content, then by extension. Most formats hold one,
/// PTX holds several. Throws Error that names file, place and remedy for anything that cannot be read.
std::vector<Scan> read_scans(const std::filesystem::path& path, const ReadOptions& options = {},
                             Monitor& monitor = silent_monitor());

/// Reads a file of one scan; several static stations of a PTX are joined into one scan with per-point
/// centres.
Scan read_scan(const std::filesystem::path& path, const ReadOptions& options = {},
               Monitor& monitor = silent_monitor());

}  // namespace limen
