// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "limen/io/table/cloud_writer.h"

namespace limen {

/// Writes LAS 1.4, or LAZ where the name ends in .laz, point format 6, with colours 7, with near infrared 8.
/// Columns that the format knows go to their places; a column that fits none, or not exactly, becomes extra
/// bytes of its own type and name. Coordinates are steps of 10 to 100 micrometres from a round offset near
/// `plan.near`; 8-bit colours are spread over 16 bits. The first text of `plan.georeference` goes into the
/// file's WKT record. Rows with a coordinate that is not finite are left out. Throws Error where a point is
/// too far from `plan.near` (21 km and more) for the steps.
std::unique_ptr<CloudWriter> make_las_writer(const std::filesystem::path& path, const CloudPlan& plan);

}  // namespace limen
