// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace limen {

/// Expands bytes in the LZF format (as in PCD "binary_compressed"): literal runs of up to 32 bytes, and
/// back references of 3 to 264 bytes over at most 8 KiB. Empty where the bytes are damaged or do not expand
/// to exactly `size` bytes.
std::optional<std::string> expand_lzf(std::string_view packed, std::size_t size);

}  // namespace limen
