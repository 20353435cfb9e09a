// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "limen/cli/terminal/command.h"
#include "limen/cli/terminal/command_line.h"
#include "limen/report/html/html_cover.h"

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

/// What the one who hands a report on writes on it.
struct CoverChoice {
  ReportCover cover;
  std::string logo;  ///< a file; empty: none
  std::string language = "en";

  [[nodiscard]] bool empty() const;
};

/// --title, --project, --operator, --date, --logo and --language.
void add_cover_options(CommandLine& command, CoverChoice& choice);

/// The cover with its logo, which is read here. Throws Error where the file is no PNG, JPEG or SVG, or has
/// more than 2 MB.
ReportCover cover_of(const CoverChoice& choice);

}  // namespace limen
