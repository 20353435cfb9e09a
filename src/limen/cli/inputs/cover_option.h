// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/cli/terminal/command_line.h"
#include "limen/report/html/html_cover.h"

namespace limen {

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
