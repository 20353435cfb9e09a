// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// Letters to insert, drop, replace or swap with their neighbour to make one word of another (optimal string
/// alignment).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The one of `known` that was meant by a word that is none of them: it differs by a third of its letters at
/// most, or begins with what was written. Empty where none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace limen
