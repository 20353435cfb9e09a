// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "limen/cli/commands/commands.h"
#include "limen/cli/help/completion.h"
#include "limen/cli/help/program_help.h"
#include "limen/cli/terminal/terminal.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

std::string completion_of(const std::string& shell, const ProgramDoc& doc) {
  if (shell == "bash") return bash_completion(doc);
  return shell == "zsh" ? zsh_completion(doc) : fish_completion(doc);
}

/// The text is the result itself: it comes with --quiet too.
int deliver_text(const std::string& text, const Session& session) {
  if (session.common.json) {
    session.answer(to_text(Json{{"text", text}}));
  } else {
    print_out(text);
  }
  return kExitOk;
}

}  // namespace

void add_completion_command(CommandLine& app, Session& session) {
  auto shell = std::make_shared<std::string>();
  CommandLine* completion =
      add_command(app, session, "completion", "Print the script by which a shell completes limen's commands",
                  [shell, &app, &session] {
                    return deliver_text(completion_of(*shell, describe_program(app.parser())), session);
                  });
  completion->add_option("SHELL", *shell, "For which shell")->required()->one_of({"bash", "zsh", "fish"});
  add_command(app, session, "man", "Print the manual page", [&app, &session] {
    return deliver_text(man_page(describe_program(app.parser())), session);
  })->group("");
}

}  // namespace limen
