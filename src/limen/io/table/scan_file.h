// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limen/model/scan.h"

namespace limen {

class Trajectory;

/// What a user may say about a scan file that the file itself does not.
struct ReadOptions {
  /// Optical centre in the coordinates of the points as `limen info` tells them (an offset that the file
  /// carries in a comment is part of them), metres. Empty: what the file says, else 0,0,0 where that can be
  /// the scanner (the points lie around it and none is closer than a scanner can measure), else unknown.
  std::optional<Vector3d> origin;
  bool level = true;  ///< the file's z axis points up (--gravity up)
  /// Of the file's numbers, where the user says so; empty: what the file says, else 1.
  std::optional<double> metres_per_unit = {};
  /// A file whose scans would take more than this is thinned while it is read, and a note tells so; 0: never.
  std::uint64_t memory_bytes = 0;
  /// Positions of a mobile scanner by time. They replace what the file says, but not `origin`. Empty: none.
  std::shared_ptr<const Trajectory> trajectory = {};

  /// Throws Error where the origin is not finite or the unit not more than 0.
  void check() const;
};

/// The scans of a file and what is worth telling about it.
struct ScanFile {
  std::string format;               ///< in a user's words: "PLY, binary, little-endian"
  std::vector<std::string> fields;  ///< names of the values per point, as the file has them
  std::vector<Scan> scans;
  double metres_per_unit = 1.0;  ///< of the file's numbers, already applied: the scans are in metres
  /// That a comment of the file names, already added to the scans; metres. Other programs may not add it.
  Vector3d offset_applied = Vector3d::Zero();
  std::size_t dropped = 0;   ///< points left out: not finite, or missing returns
  std::size_t unusable = 0;  ///< of those the ones that the file did not call missing: not finite, or absurd
  std::vector<std::string> notes;  ///< sentences about what was assumed or left out
};

/// A file in memory and its name for messages.
struct NamedBytes {
  std::string_view bytes;
  std::string name;
};

/// What became of a point file that was moved.
struct TransformedCloud {
  std::size_t points = 0;
  std::string format;              ///< of the input, in a user's words
  std::vector<std::string> notes;  ///< sentences about what was left out or could not be moved
};

}  // namespace limen
