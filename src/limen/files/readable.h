// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace limen {

/// Why a file cannot be read: that there is none, that it is a folder ("is a folder, not a {wanted}"), or
/// what the system says. Empty where it can be read.
std::string why_unreadable(const std::filesystem::path& path, const char* wanted = "file");

/// Throws Error with that, where there is such a reason.
void require_readable(const std::filesystem::path& path, const std::string& remedy,
                      const char* wanted = "file");

}  // namespace limen
