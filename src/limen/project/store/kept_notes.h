// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace limen {

/// Notes are kept by what a file holds, and a file may have another name in the next run: marks stand for
/// names.

/// What is in a kept note for name number `number`.
std::string name_mark(std::size_t number);

/// The notes with a mark for the name of their file (number 0), with which a note may begin.
std::vector<std::string> without_name(std::vector<std::string> notes, const std::string& name);

/// The notes with this run's names for all marks.
std::vector<std::string> with_names(std::vector<std::string> notes, const std::vector<std::string>& names);

}  // namespace limen
