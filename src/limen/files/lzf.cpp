// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/lzf.h"

#include <algorithm>
#include <cstdint>

namespace limen {
namespace {

/// A packed byte expands to at most so many (three bytes to 264); guards the allocation.
constexpr std::size_t kMostExpansion = 132;

}  // namespace

std::optional<std::string> expand_lzf(std::string_view packed, std::size_t size) {
  if (size / kMostExpansion > packed.size()) return {};
  std::string out(size, '\0');
  std::size_t at = 0;
  std::size_t in = 0;
  const auto byte = [&](std::size_t k) {
    return static_cast<std::size_t>(static_cast<std::uint8_t>(packed[k]));
  };
  while (in < packed.size()) {
    const std::size_t control = byte(in++);
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > packed.size() - in || run > size - at) return {};
      std::copy_n(packed.data() + in, run, out.data() + at);
      in += run;
      at += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) {
      if (in >= packed.size()) return {};
      length += byte(in++);
    }
    length += 2;
    if (in >= packed.size()) return {};
    const std::size_t distance = ((control & 31U) << 8U) + byte(in++) + 1;
    if (distance > at || length > size - at) return {};
    // One byte at a time: the reference may overlap what it writes.
    for (std::size_t k = 0; k < length; ++k, ++at) out[at] = out[at - distance];
  }
  if (at != size) return {};
  return out;
}

}  // namespace limen
