// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "limen/base/progress.h"
#include "limen/geometry/rigid.h"
#include "limen/io/las/las_header.h"
#include "limen/io/table/cloud_writer.h"
#include "limen/io/table/point_file.h"
#include "limen/io/table/scan_file.h"

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

/// Writes LAS 1.4, or LAZ where the name ends in .laz (a COPC: .copc.laz), point format 6, with colours 7,
/// with near infrared 8. Columns that the format knows go to their places; a column that fits none, or not
/// exactly, becomes extra bytes of its own type and name. Coordinates are steps of 10 to 100 micrometres from
/// a round offset near `plan.near`; 8-bit colours are spread over 16 bits. The first text of
/// `plan.georeference` goes into the file's WKT record. Rows with a coordinate that is not finite are left
/// out. Throws Error where a point is too far from `plan.near` (21 km and more) for the steps.
std::unique_ptr<CloudWriter> make_las_writer(const std::filesystem::path& path, const CloudPlan& plan);

/// Opens a LAS (1.0 to 1.4) or LAZ file in memory, point formats 0 to 10; one cloud. The values per point are
/// x y z intensity return_number number_of_returns scan_direction_flag edge_of_flight_line classification
/// synthetic key_point withheld overlap scanner_channel user_data scan_angle (degrees) point_source_id
/// gps_time red green blue nir wave_packet_..., as far as the format has them, and the extra bytes by their
/// names in lower case. Uncompressed points are columns that point into `bytes`.
/// Throws Error where the header cannot be or promises more points than there is room for.
std::unique_ptr<PointFile> open_las(std::string_view bytes, const std::string& name);

}  // namespace limen
