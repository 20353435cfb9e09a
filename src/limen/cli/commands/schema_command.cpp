// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "limen/cli/commands/commands.h"
#include "limen/cli/terminal/terminal.h"
#include "limen/report/deviation/deviation_schema.h"
#include "limen/report/json/schemas.h"
#include "limen/report/project/project_schema.h"

namespace limen {
namespace {

using SchemaMaker = std::string (*)();

const std::map<std::string, SchemaMaker>& schema_makers() {
  static const std::map<std::string, SchemaMaker> makers{
      {"deviation", deviation_schema}, {"evaluation", evaluation_schema},
      {"openings", openings_schema},   {"planes", planes_schema},
      {"project", project_schema},     {"project-deviation", project_deviation_schema},
      {"result", result_schema},       {"project-evaluation", project_evaluation_schema},
      {"segments", segments_schema}};
  return makers;
}

}  // namespace

void add_schema_command(CommandLine& app, Session& session) {
  auto file = std::make_shared<std::string>();
  CommandLine* command =
      add_command(app, session, "schema", "Print the JSON Schema of a file that limen writes", [file] {
        print_out(schema_makers().at(*file)());
        return kExitOk;
      });
  std::vector<std::string> names;
  for (const auto& [name, maker] : schema_makers()) names.push_back(name);
  command
      ->add_option(
          "FILE", *file,
          "Which file: result (of register), project, deviation, project-deviation, planes, openings, "
          "segments, or evaluation and project-evaluation (what evaluate prints of a pair and of a project)")
      ->required()
      ->one_of(names);
}

}  // namespace limen
