// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// Without the byte order mark that some programs put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// What stands between the columns of a table whose first line this is: a semicolon, a tab, else a comma.
char table_mark(std::string_view header);

/// The cells of a line, without blanks around; a quoted cell may hold the mark.
std::vector<std::string> table_cells(std::string_view line, char mark);

/// No line of a table has more cells than its first has columns; empty ones at the end do not count, nor do
/// lines that are empty or begin with #. Throws Error that names the file, the line and both numbers, or says
/// why the file cannot be read.
void require_table_width(const std::filesystem::path& path);

}  // namespace limen
