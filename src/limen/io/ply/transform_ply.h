// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/io/table/transformed_cloud.h"

namespace limen {

/// The part of transform_cloud for PLY files.
TransformedCloud transform_ply(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output, const ReadOptions& options);

}  // namespace limen
