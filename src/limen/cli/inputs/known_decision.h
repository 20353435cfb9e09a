// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "limen/project/decide/decisions.h"

namespace limen {

/// The decision with its scans called as in project.json. What it names must be there, or it would never be
/// heeded: its scans, none of them a copy of another, and the pose. Throws Error that tells what there is; a
/// project that was not finished tells nothing, and any decision is taken. What is gone can be forgotten.
Decision as_known(Decision decision, const std::filesystem::path& folder);

/// How project.json calls the scan that a name means; the name itself where it means none, or several.
std::function<std::string(const std::string&)> full_names(const std::filesystem::path& folder);

}  // namespace limen
