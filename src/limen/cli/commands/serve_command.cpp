// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/cli/serve/serve.h"

namespace limen {
namespace {

struct ServeCommand {
  std::string folder;
  int port = 0;
  std::string most_upload = "20G";
};

std::uint64_t upload_bound(const std::string& text) {
  try {
    return parse_memory(text);
  } catch (const Error&) {
    throw Error(fmt::format("--most-upload is \"{}\", but must be a size of 1M or more", text), "",
                "write it as 500M, 1G or 2.5G");
  }
}

int run(const ServeCommand& command, const Session& session) {
  serve(command.folder, command.port, upload_bound(command.most_upload), session);
  return kExitOk;
}

}  // namespace

void add_serve_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<ServeCommand>();
  CommandLine* command = add_command(
      app, session, "serve",
      "Serve a web page for this machine only: upload files, register them and look at the results",
      [options, &session] { return run(*options, session); });
  command
      ->add_option("DIR", options->folder, "Folder for the files and the results; created if it is missing")
      ->required();
  command->add_option("--port N", options->port, "Port of 127.0.0.1 (default 0: any free port)")
      ->in_range(0, 65535);
  command->add_option("--most-upload SIZE", options->most_upload,
                      "The largest file that can be uploaded (default 20G)");
}

}  // namespace limen
