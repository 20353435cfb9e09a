// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/project/decide/decisions.h"

namespace limen {

/// What a decision names must be there, or it would never be heeded: its scans, none of them a copy of
/// another, and the pose. Throws Error that tells what there is; a project that was not finished tells
/// nothing, and any decision is taken.
void require_known(const Decision& decision, const std::filesystem::path& folder);

}  // namespace limen
