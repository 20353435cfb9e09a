// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_cover.h"

#include <fmt/format.h>

#include "limen/report/html/html_bytes.h"

namespace limen {
namespace {

std::string fact(const char* name, const std::string& value) {
  return value.empty()
             ? ""
             : fmt::format("<div><dt>{}</dt><dd translate=\"no\">{}</dd></div>", name, escaped(value));
}

}  // namespace

std::string cover_facts(const ReportCover& cover) {
  std::string text;
  if (!cover.logo.empty())
    text += fmt::format("<img class=\"logo\" alt=\"\" src=\"{}\">\n", escaped(cover.logo));
  if (!cover.title.empty())
    text += fmt::format("<p class=\"cover-title\" translate=\"no\">{}</p>\n", escaped(cover.title));
  const std::string facts =
      fact("Project", cover.project) + fact("Operator", cover.operator_name) + fact("Date", cover.date);
  if (!facts.empty())
    text += fmt::format("<dl class=\"cover\" lang=\"{}\">{}</dl>\n", code_of(cover.language), facts);
  return text;
}

std::string signature_html(const ReportCover& cover) {
  if (cover.operator_name.empty()) return {};
  return fmt::format(
      "<dl class=\"signature\">{}<div><dt>Date</dt><dd translate=\"no\">{}</dd></div>"
      "<div><dt>Signature</dt><dd></dd></div></dl>\n",
      fact("Operator", cover.operator_name), escaped(cover.date));
}

}  // namespace limen
