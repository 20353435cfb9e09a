// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "limen/io/las/las_records.h"

namespace limen {

/// The records of a LAZ file, decoded chunk by chunk on all threads. Throws Error where the file cannot be
/// decoded.
std::unique_ptr<LasRecords> open_laz_records(std::string_view bytes, const std::string& name,
                                             const LasHeader& header);

}  // namespace limen
