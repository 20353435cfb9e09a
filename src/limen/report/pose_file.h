// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/model/result.h"

namespace limen {

/// What a file says about a pose: result.json says all of it, a text of 4 x 4 numbers only the matrix.
struct PoseFile {
  std::optional<Rigid3> target_from_source;  ///< empty where the outcome is no_match
  std::optional<Outcome> outcome;
  std::optional<double> probability;  ///< of the pose
  std::optional<PoseSigma> sigma;
  std::optional<Vector3d> source_middle;  ///< middle of the source's extent, metres, source world
  std::string source_path;                ///< as it was given to register; empty where unknown
  std::string target_path;
  std::string source_sha256;  ///< of the registered file's bytes, 64 hexadecimal digits; empty where unknown
  std::string target_sha256;
  /// Of the numbers in the registered files, where the file says; the poses are in metres.
  std::optional<double> source_metres_per_unit;
  std::optional<double> target_metres_per_unit;
  std::vector<Rigid3> alternatives;  ///< the other poses, in the order of the file
  bool of_numbers = false;           ///< a text: its translation is in the unit of the files, not in metres
};

/// The pose number `choice` of a file: 0 is its answer, 1 and more its alternatives in their order. Throws
/// Error where the file holds no pose, or fewer; `path` names it in messages.
Rigid3 chosen_pose(const PoseFile& file, int choice, const std::filesystem::path& path);

/// Reads result.json (or any JSON object with `target_from_source` or `transform`, four rows of four), or a
/// text of 16 numbers in four rows. Throws Error that names the file and the fault, also where the matrix is
/// not rigid.
PoseFile read_pose_file(const std::filesystem::path& path);

/// The true pose of a pair, metres. Read from what read_pose_file() reads (a text in the unit that `result`
/// says the files have), or from the truth of a simulated case: an
/// object with `scans`, each with `file` (or `name`) and `world_from_scan`; there the scans are found by the
/// file names in `result`; the model that was scanned, where it is the target, by `file` of `model`. Throws
/// Error where a scan is not in it.
Rigid3 read_true_pose(const std::filesystem::path& path, const PoseFile& result);

/// A scan of such a truth.
struct TrueScan {
  std::string file;  ///< name, perhaps with folders; empty where only `name` is stated
  std::string name;  ///< of the file, less its ending
  int index = 0;     ///< within the file
  Rigid3 world_from_scan;
  std::optional<Vector3d> scanner;  ///< where a station's scanner stood, in the scan's own frame

  [[nodiscard]] bool is_of(const std::filesystem::path& path) const {
    return file == path.filename() || name == path.stem();
  }
  /// How many names at the end of a path, the file's and those of the folders before it, are the same as in
  /// `file`; 0: it is another file.
  [[nodiscard]] int names_shared_with(const std::filesystem::path& path) const;
};

/// The scans of the truth of a simulated case or project. Throws Error as read_true_pose().
std::vector<TrueScan> read_true_scans(const std::filesystem::path& path);

}  // namespace limen
