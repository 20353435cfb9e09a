// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/io/cloud/join_clouds.h"
#include "limen/io/cloud/thin_cloud.h"
#include "limen/io/table/cloud_writer.h"

namespace limen {

/// The writer for the ending of the file: .ply, .las, .laz, .e57, or text (.xyz, .txt, .asc,
/// .csv). Throws Error for any other.
std::unique_ptr<CloudWriter> make_cloud_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// Whether make_cloud_writer knows the ending.
bool is_cloud_ending(const std::filesystem::path& path);

/// Whether a name ends as that of any file of points does.
bool has_cloud_ending(const std::filesystem::path& path);

/// What became of clouds that were written to one file.
struct WrittenClouds {
  std::uint64_t read = 0;     ///< points of the input
  std::uint64_t written = 0;  ///< points of the output
  double spacing_m = 0.0;     ///< of what was thinned; 0: it was not
  std::vector<std::string> notes;
};

/// A cloud of a file, in place for an output frame, with the scanner position if that is known. `origin`: the
/// centre, where the user tells it; small clouds are looked into where the file does not tell one.
PlacedCloud placed_cloud(const OpenPoints& input, std::size_t cloud, const Rigid3& target_from_world,
                         const std::optional<Vector3d>& origin = {}, Monitor& monitor = silent_monitor());
/// All clouds of a file.
std::vector<PlacedCloud> placed_clouds(const OpenPoints& input, const Rigid3& target_from_world,
                                       const std::optional<Vector3d>& origin = {},
                                       Monitor& monitor = silent_monitor());

/// Throws Error where the clouds' numbers are of several units, or of one that the format of `output` cannot
/// state: all but LAS and LAZ are in metres. Returns the unit in metres. `output`: its name.
double require_one_unit(const std::vector<PlacedCloud>& clouds, const std::filesystem::path& output);

/// Writes all points, piece after piece; .ply, .las or .e57 by the ending of `output`. LAS holds no points
/// without coordinates: they are left out, and a note tells so.
WrittenClouds write_clouds(const JoinedClouds& clouds, const std::filesystem::path& output,
                           Monitor& monitor = silent_monitor());

/// Whether write_stations() copies the clouds of a file as they are: they are E57 too.
bool is_copied(const OpenPoints& input, const std::filesystem::path& output);

/// Each of them as a scan of its own in one E57 file. `system`: as in JoinedClouds.
WrittenClouds write_stations(const std::vector<PlacedCloud>& stations, const std::filesystem::path& output,
                             Monitor& monitor = silent_monitor(), const std::string& system = {});

/// A file thinned to another one; in an .e57 each of its scans stays one, with its share of the points.
WrittenClouds thin_file(const OpenPoints& input, ThinOptions thinning, const std::filesystem::path& output,
                        Monitor& monitor = silent_monitor());

}  // namespace limen
