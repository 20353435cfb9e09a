// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limen/base/progress.h"
#include "limen/geometry/rigid.h"

namespace limen {

/// What became of an E57 file whose poses were replaced.
struct MovedE57 {
  std::size_t scans = 0;
  std::size_t images = 0;
  std::uint64_t points = 0;        ///< of all scans, as the file says
  std::vector<std::string> notes;  ///< sentences about what is worth knowing
};

/// The description (XML) of an E57 file with another coordinate system (well-known text).
std::string with_coordinate_system(const std::string& xml, const std::string& wkt);

/// Writes the file with all its scans (and images) moved: only the poses differ, each the motion times the
/// old pose, 17 digits. Points, images and every other byte of the description are those of the source;
/// bounds stay, since they are in the scans' frames. `wkt`: the coordinate system of the target, in the place
/// of the source's; empty: that stays. Works page by page, whatever the size of the file. The file appears
/// whole or not at all. Throws Error for damaged pages (by number and byte) and for what cannot be read or
/// written.
MovedE57 replace_e57_poses(std::string_view bytes, const std::string& name, const Rigid3& target_from_source,
                           const std::filesystem::path& output, Monitor& monitor = silent_monitor(),
                           const std::string& wkt = {});

}  // namespace limen
