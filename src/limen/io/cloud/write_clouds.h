// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/io/cloud/join_clouds.h"
#include "limen/io/cloud/thin_cloud.h"

namespace limen {

/// What became of clouds that were written to one file.
struct WrittenClouds {
  std::uint64_t read = 0;     ///< points of the input
  std::uint64_t written = 0;  ///< points of the output
  double spacing_m = 0.0;     ///< of what was thinned; 0: it was not
  std::vector<std::string> notes;
};

/// The clouds of a file, in place for an output frame, with the optical centres that are known. `origin`: the
/// centre, where the user tells it; small files are looked into where they do not tell one.
std::vector<PlacedCloud> placed_clouds(const OpenPoints& input, const Rigid3& target_from_world,
                                       const std::optional<Vector3d>& origin = {},
                                       Monitor& monitor = silent_monitor());

/// Writes all points, piece after piece; .ply, .las or .e57 by the ending of `output`. LAS holds no points
/// without coordinates: they are left out, and a note tells so.
WrittenClouds write_clouds(const JoinedClouds& clouds, const std::filesystem::path& output,
                           Monitor& monitor = silent_monitor());

/// Each of them as a scan of its own in one E57 file.
WrittenClouds write_stations(const std::vector<JoinedClouds>& stations, const std::filesystem::path& output,
                             Monitor& monitor = silent_monitor());

/// As write_clouds, thinned on the way.
WrittenClouds write_thinned(const JoinedClouds& clouds, const ThinOptions& thinning,
                            const std::filesystem::path& output, Monitor& monitor = silent_monitor());

}  // namespace limen
