// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace limen {

/// SHA-256 of a file's bytes, 64 hexadecimal digits, read piece by piece; empty where `path` is not a regular
/// file (a pipe can be read once only). Throws Error where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

/// The same of bytes that are there.
std::string sha256_of(std::string_view bytes);

}  // namespace limen
