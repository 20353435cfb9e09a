// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/commands/schema_command.h"

#include <memory>
#include <string>

#include "limen/cli/terminal/terminal.h"
#include "limen/report/json/result_schema.h"

namespace limen {

void add_schema_command(CommandLine& app, Session& session) {
  auto file = std::make_shared<std::string>();
  CommandLine* command =
      add_command(app, session, "schema", "Print the JSON Schema of a file that limen writes", [file] {
        print_out(result_schema());
        return kExitOk;
      });
  command->add_option("FILE", *file, "Which file: that of limen register")->required()->one_of({"result"});
}

}  // namespace limen
