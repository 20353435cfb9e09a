// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "limen/cli/terminal/command.h"

namespace limen {

/// --pdf
void add_pdf_option(CommandLine& command, bool& pdf);

/// The browser that is to print, found before the work; none where nothing is to be printed. Throws Error
/// where there is none.
std::filesystem::path browser_for_pdf(bool pdf);

/// report.html of the folder as report.pdf beside it. The numbers are not given up for it: where it cannot be
/// printed a warning says so.
void write_pdf(const std::filesystem::path& browser, const std::filesystem::path& folder,
               const Session& session);

}  // namespace limen
