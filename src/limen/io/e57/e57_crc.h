// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace limen {

/// CRC-32C (Castagnoli, reflected, complemented at both ends): the check sum of E57 pages. Uses the
/// processor's instruction where it has one.
std::uint32_t crc32c(std::string_view bytes);
/// The same by tables alone.
std::uint32_t crc32c_by_table(std::string_view bytes);

}  // namespace limen
