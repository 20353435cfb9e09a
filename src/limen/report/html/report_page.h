// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace limen {

// The page's own sources (report/page), built into the library: no file is looked for when it runs.

/// HTML with {{name}} where parts go: the head of every page, with the policy that it may load nothing.
std::string_view page_head();
/// The same of the whole page of a registration.
std::string_view report_pattern();
/// CSS
std::string_view report_style();
/// JavaScript: all files of report/page, in the order in which they build on one another.
std::string_view report_script();

/// The same of the page that shows clouds alone; its style adds to that of the report.
std::string_view view_pattern();
std::string_view view_style();
std::string_view view_script();

/// The same of a project's page; its style adds to both.
std::string_view project_pattern();
std::string_view project_style();
std::string_view project_script();

/// CSS of pages of tables and plans without a view in space.
std::string_view table_style();

/// Texts in other languages: English, a tab, the other, a line each.
std::string_view french_texts();
std::string_view german_texts();

}  // namespace limen
