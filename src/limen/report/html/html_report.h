// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limen/report/html/html_cover.h"
#include "limen/report/html/html_scene.h"
#include "limen/report/json/result_json.h"
#include "limen/report/summary/words.h"

namespace limen {

/// The verdict as a surveyor would say it. Plain text, not yet escaped.
struct VerdictWords {
  std::string headline;                ///< "Registered: the two scans fit in one way only"
  std::vector<std::string> sentences;  ///< what to expect, what is open
  std::string reason;                  ///< in the program's own words, where no sentence fits
  std::string symbol;                  ///< one character: no outcome is shown by colour alone
};
VerdictWords verdict_words(const RegistrationReport& report);

/// What a reader opens of one registration: a page that needs nothing but itself, and its three sections.
struct ReportPages {
  std::string page;  ///< HTML
  std::string top;   ///< SVG
  std::string front;
  std::string side;
};
ReportPages report_pages(const RegistrationReport& report, const ReportScene& scene,
                         const ReportCover& cover = {});

/// Writes report.html, section_top.svg, section_front.svg and section_side.svg into `folder`. Throws Error
/// where that fails.
void write_report(const std::filesystem::path& folder, const RegistrationReport& report,
                  const ReportScene& scene, const ReportCover& cover = {});

/// Removes what an earlier run left of them.
void remove_report(const std::filesystem::path& folder);

}  // namespace limen
