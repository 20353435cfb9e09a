// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "limen/io/transform_cloud.h"

namespace limen {

/// A file in memory and its name for messages.
struct NamedBytes {
  std::string_view bytes;
  std::string name;
};

/// The part of transform_cloud for PLY files.
TransformedCloud transform_ply(const NamedBytes& input, const Rigid3& target_from_source,
                               const std::filesystem::path& output, const ReadOptions& options);

}  // namespace limen
