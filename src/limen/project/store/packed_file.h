// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace limen {

/// What an entry of a store is, beside its bytes.
struct EntryHead {
  std::string_view kind;      ///< four letters
  std::uint32_t version = 0;  ///< of the format
  std::string_view key;       ///< by which it is looked up
};

/// Writes bytes, deflated, under their head and a SHA-256 of head and bytes; whole or not at all.
void write_packed(const std::filesystem::path& path, const EntryHead& head, std::string_view bytes);

/// The bytes again; empty where there is no such file, or one of another version of the format. Throws Error
/// where the file is not what was written under this head: damaged, or of another kind or key.
std::optional<std::string> read_packed(const std::filesystem::path& path, const EntryHead& head);

}  // namespace limen
