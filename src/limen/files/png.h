// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limen {

/// A PNG of one byte of grey per pixel, row after row from the top. The size is a multiple of `width`.
std::string png_of_grey(const std::vector<std::uint8_t>& grey, std::size_t width);

}  // namespace limen
