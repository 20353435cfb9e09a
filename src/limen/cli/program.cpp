// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/program.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/version.h"
#include "limen/cli/command.h"
#include "limen/cli/deviation_command.h"
#include "limen/cli/evaluate_command.h"
#include "limen/cli/info_command.h"
#include "limen/cli/openings_command.h"
#include "limen/cli/planes_command.h"
#include "limen/cli/register_command.h"
#include "limen/cli/segments_command.h"
#include "limen/cli/terminal.h"
#include "limen/cli/transform_command.h"

#ifdef LIMEN_WITH_SIMULATOR
#include "limen/cli/simulate_command.h"
#endif

namespace limen {
namespace {

/// One line, whatever the message holds.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

int fail(const std::string& message, int status) {
  std::cout.flush();
  fmt::print(stderr, "limen: error: {}\n", one_line(message));
  return status;
}

/// What is wrong with the command line, and where its usage is told.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (!chosen.empty()) {
    return fmt::format("{} (limen {} --help tells the usage)", error.what(), chosen.front()->get_name());
  }
  const std::vector<std::string> unknown = app.remaining();
  const std::string problem = unknown.empty() ? "a command is needed" : unknown.front() + " is not a command";
  const bool about_commands = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  return fmt::format("{} (limen --help tells the usage)", about_commands ? problem : error.what());
}

int status_of(Fault fault) {
  switch (fault) {
    case Fault::input:
      return kExitBadInput;
    case Fault::internal:
      return kExitInternal;
    case Fault::cancelled:
      return kExitInterrupted;
  }
  return kExitInternal;
}

void add_commands(CLI::App& app, Session& session) {
  add_info_command(app, session);
  add_planes_command(app, session);
  add_openings_command(app, session);
  add_segments_command(app, session);
  add_register_command(app, session);
  add_transform_command(app, session);
  add_evaluate_command(app, session);
  add_deviation_command(app, session);
#ifdef LIMEN_WITH_SIMULATOR
  add_simulate_command(app, session);
#endif
}

/// Runs what the command line asked for; every exception becomes one line and a status.
int run_action(Session& session) {
  try {
    set_thread_count(session.common.threads);
    session.monitor = make_monitor(session.common.quiet);
    const InterruptGuard guard(*session.monitor);
    const int status = session.action();
    session.monitor.reset();
    if (std::fflush(stdout) != 0) {
      return fail("standard output: cannot be written (free some room, or read all of it)", kExitBadInput);
    }
    return status;
  } catch (const Error& error) {
    session.monitor.reset();
    return fail(error.what(), status_of(error.fault()));
  } catch (const std::bad_alloc&) {
    session.monitor.reset();
    return fail("out of memory (give fewer points or a larger machine)", kExitInternal);
  } catch (const std::exception& error) {
    session.monitor.reset();
    return fail(fmt::format("{} (this is a fault of limen: please report it)", error.what()), kExitInternal);
  }
}

}  // namespace

int run_program(int argc, char** argv) {
  Session session;
  CLI::App app("limen registers laser scans of one building, indoors and outdoors, by its planar polygons.",
               "limen");
  app.set_version_flag("--version", fmt::format("limen {}", kVersion), "Tell the version and exit");
  app.require_subcommand(1);
  add_common_options(app, session);
  add_commands(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);
    return fail(usage_error(app, error), kExitBadInput);
  }
  return run_action(session);
}

}  // namespace limen
