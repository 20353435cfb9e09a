// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "limen/report/json/json_values.h"

namespace limen {

/// An element of a page that holds bytes as base64; nothing where there are none.
std::string blob_element(const std::string& id, const std::vector<std::uint8_t>& bytes);
/// An element with JSON that cannot end the element it is in, nor open a comment there.
std::string json_element(Json json, const std::string& id = "scene");

/// A table that scrolls where it has no room; `head`: the cells of its first row, those of numbers begin with
/// '#'.
std::string scrolled_table(const std::string& label, const std::vector<std::string>& head,
                           const std::string& rows);

using PageParts = std::map<std::string, std::string>;
/// `pattern` with every {{name}} replaced by the part of that name, in one pass: what a part holds is never
/// looked into.
std::string filled_in(std::string_view pattern, const PageParts& parts);

}  // namespace limen
