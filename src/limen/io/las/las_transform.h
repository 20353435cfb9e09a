// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "limen/base/progress.h"
#include "limen/geometry/rigid.h"
#include "limen/io/table/transformed_cloud.h"

namespace limen {

/// A coordinate system as LAS names it: by well-known text in version 1.4, by the keys of GeoTIFF before.
struct LasSystem {
  std::string wkt;   ///< empty: the source's records stay
  std::string code;  ///< "EPSG:2154"; empty: it has no number
};

/// Moves a LAS or LAZ file in memory and writes it as LAS, or as LAZ where `output` ends so, of the same
/// version and point format. Coordinates
/// move; scale, offset and bounding box follow; every other value of the points and every record around them
/// is kept byte for byte, but for what describes the compression. Steps are not coarser than the old ones
/// where the range allows. Points stream, the file may be larger than memory.
/// `system`: of the moved coordinates; its records take the place of those of the source.
/// The file appears whole or not at all; throws Error for what cannot be read or written.
TransformedCloud transform_las(std::string_view bytes, const std::string& name,
                               const Rigid3& target_from_source, const std::filesystem::path& output,
                               Monitor& monitor = silent_monitor(), const LasSystem& system = {});

}  // namespace limen
