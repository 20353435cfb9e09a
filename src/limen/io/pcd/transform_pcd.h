// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/io/table/transformed_cloud.h"

namespace limen {

/// The part of transform_cloud for PCD files.
TransformedCloud transform_pcd(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output);

}  // namespace limen
