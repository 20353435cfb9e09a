// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/base/error.h"

namespace limen {

/// That there is no file of this name, and what to do.
Error missing_file(const std::string& name);

/// Why a file cannot be read: that there is none, that it is a folder ("is a folder, not a {wanted}"), or
/// what the system says. Empty where it can be read.
std::string why_unreadable(const std::filesystem::path& path, const char* wanted = "file");

/// Throws Error with that, where there is such a reason.
void require_readable(const std::filesystem::path& path, const std::string& remedy,
                      const char* wanted = "file");

}  // namespace limen
