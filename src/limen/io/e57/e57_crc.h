// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace limen {

/// CRC-32C (Castagnoli, reflected, complemented at both ends): the check sum of E57 pages. Uses the
/// processor's instruction where it has one.
std::uint32_t crc32c(std::string_view bytes);
/// The same by tables alone.
std::uint32_t crc32c_by_table(std::string_view bytes);

/// Eight bytes of a file as a number, the machine's order.
inline std::uint64_t load_eight(const char* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

}  // namespace limen
