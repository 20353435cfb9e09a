// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "limen/io/las/las_header.h"
#include "limen/io/table/point_file.h"

namespace limen {

/// Opens a LAS (1.0 to 1.4) or LAZ file in memory, point formats 0 to 10; one cloud. The values per point are
/// x y z intensity return_number number_of_returns scan_direction_flag edge_of_flight_line classification
/// synthetic key_point withheld overlap scanner_channel user_data scan_angle (degrees) point_source_id
/// gps_time red green blue nir wave_packet_..., as far as the format has them, and the extra bytes by their
/// names in lower case. Uncompressed points are columns that point into `bytes`.
/// Throws Error where the header cannot be or promises more points than there is room for.
std::unique_ptr<PointFile> open_las(std::string_view bytes, const std::string& name);

}  // namespace limen
