// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/base/error.h"

namespace limen {

/// That there is no file of this name, and what to do.
Error missing_file(const std::string& name);

/// What something is that is no regular file, by its st_mode: "is a folder, not a {wanted}", or a pipe or a
/// device, which may have no end. Empty where it is one.
std::string why_no_file(unsigned mode, const char* wanted = "file");

/// Why a file cannot be read: that there is none, why_no_file(), or what the system says. Empty where it can
/// be read.
std::string why_unreadable(const std::filesystem::path& path, const char* wanted = "file");

/// Throws Error with that, where there is such a reason.
void require_readable(const std::filesystem::path& path, const std::string& remedy,
                      const char* wanted = "file");

}  // namespace limen
