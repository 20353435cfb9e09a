// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace limen {

/// The names in a list: one a line, relative to the list's folder, without blanks around; empty lines and
/// those that begin with # do not count, nor does a byte order mark. Throws Error where it is no list.
std::vector<std::string> names_in_list(const std::string& path);

}  // namespace limen
