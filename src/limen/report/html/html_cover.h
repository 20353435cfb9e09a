// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "limen/report/html/language.h"

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

/// Logo, title, project, operator and date, named in English; ready HTML, empty where none is given.
std::string cover_facts(const ReportCover& cover);

/// Where the operator signs, in English; ready HTML, empty where no operator is given.
std::string signature_html(const ReportCover& cover);

}  // namespace limen
