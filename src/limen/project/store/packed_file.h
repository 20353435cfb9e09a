// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace limen {

/// Writes bytes, deflated, under a head that tells their kind, the format's version and their size; whole or
/// not at all. `kind` has four letters.
void write_packed(const std::filesystem::path& path, std::string_view kind, std::uint32_t version,
                  std::string_view bytes);

/// The bytes again; empty where there is no such file, where it is of another kind or version, or damaged (a
/// checksum is kept): what a store does not hold is made anew.
std::optional<std::string> read_packed(const std::filesystem::path& path, std::string_view kind,
                                       std::uint32_t version);

}  // namespace limen
