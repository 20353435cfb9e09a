// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/cover_option.h"

namespace limen {

void add_cover_options(CommandLine& command, ReportCover& cover) {
  const auto add = [&command](const char* name, std::string& text, const char* description) {
    command.add_option(name, text, description)->type_name("WORDS");
  };
  add("--title", cover.title, "Title of the report");
  add("--project", cover.project, "Project that the report names");
  add("--operator", cover.operator_name, "Who made the registration, for the report");
  add("--date", cover.date, "Date on the report, printed as given");
}

}  // namespace limen
