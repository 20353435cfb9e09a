// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "limen/report/html/language.h"
#include "limen/report/summary/registration_report.h"

namespace limen {

/// What the one who hands a report on writes on it. Empty texts are left out.
struct ReportCover {
  std::string title;
  std::string project;
  std::string operator_name;
  std::string date;  ///< as it is to be read; no clock is asked, so that a page can be made again
  Language language = Language::english;
  std::string logo = {};  ///< an image as a data URI
};

/// The outcome in some sentences for a reader who did not make it: verdict, probability, precision,
/// residuals, what is open. Plain text, not escaped.
std::vector<std::string> cover_summary(const RegistrationReport& report, Language language);

/// Logo, title, project, operator and date, named in English; ready HTML, empty where none is given.
std::string cover_facts(const ReportCover& cover);

/// Where the operator signs, in English; ready HTML, empty where no operator is given.
std::string signature_html(const ReportCover& cover);

/// The head of the page: title, project, operator, date, and the summary where one is asked for in another
/// language than the page's. Ready HTML, may be empty.
std::string cover_html(const RegistrationReport& report, const ReportCover& cover);

}  // namespace limen
