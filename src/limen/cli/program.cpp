// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/program.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/text.h"
#include "limen/base/version.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/help/program_doc.h"
#include "limen/cli/help/program_help.h"
#include "limen/cli/terminal/command.h"
#include "limen/cli/terminal/command_line.h"
#include "limen/cli/terminal/console.h"
#include "limen/cli/terminal/terminal.h"

#ifdef LIMEN_WITH_SIMULATOR
#endif

namespace limen {
namespace {

int fail(const std::string& message, int status) {
  std::fflush(stdout);
  // Not fmt::print: a terminal that is gone is no reason to throw.
  std::fputs(fmt::format("limen: error: {}\n", message_line(message)).c_str(), stderr);
  return status;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names = {"help"};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// "outptu is not ...", and what may have been meant.
std::string unknown_word(const std::string& word, const std::string& what,
                         const std::vector<std::string>& known) {
  const std::string meant = nearest_word(word, known);
  return fmt::format("{} is not {}{}", word.empty() ? "an empty word" : word, what,
                     meant.empty() ? "" : fmt::format("; did you mean {}?", meant));
}

/// The first word that looks like an option and is none of the command's; empty where there is none.
std::string unknown_option(const CLI::App& command) {
  for (const std::string& word : command.remaining()) {
    if (word.size() < 2 || word[0] != '-' ||
        (word[1] != '-' && std::isalpha(static_cast<unsigned char>(word[1])) == 0))
      continue;
    return word.substr(0, word.find('='));
  }
  return {};
}

/// What is wrong with the command line, and where its usage is shown.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (!chosen.empty()) {
    const CLI::App& command = *chosen.front();
    const std::string name = typed_name(command);
    const std::string option = unknown_option(command);
    const std::string problem =
        option.empty()
            ? error.what()
            : unknown_word(option, fmt::format("an option of limen {}", name), option_names(command));
    return fmt::format("{} (see limen {} --help)", problem, name);
  }
  const std::vector<std::string> unknown = app.remaining();
  const bool about_commands = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  std::string problem = about_commands ? "a command is needed" : error.what();
  if (about_commands && !unknown.empty()) {
    const bool option = unknown.front().starts_with('-');
    problem = unknown_word(unknown.front(), option ? "an option of limen" : "a command",
                           option ? option_names(app) : command_names(app));
  }
  return fmt::format("{} (see limen --help)", problem);
}

/// Names that JSON cannot tell are refused before the work, not at its end. Throws Error.
void require_utf8(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (!is_utf8(word)) throw Error("is not UTF-8 and cannot be written to JSON", word, "rename it");
  }
}

/// `limen help` is `limen --help`, and `limen help COMMAND` is `limen COMMAND --help`.
std::vector<std::string> without_help_command(int argc, char** argv) {
  std::vector<std::string> words(argv, argv + argc);
  if (words.size() < 2 || words[1] != "help") return words;
  words.erase(words.begin() + 1);
  words.resize(std::min<std::size_t>(words.size(), 2));
  words.emplace_back("--help");
  return words;
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

void add_commands(CommandLine& app, Session& session) {
  add_info_command(app, session);
  add_planes_command(app, session);
  add_openings_command(app, session);
  add_segments_command(app, session);
  add_register_command(app, session);
  add_project_command(app, session);
  add_transform_command(app, session);
  add_transform_project_command(app, session);
  add_thin_command(app, session);
  add_view_command(app, session);
  add_serve_command(app, session);
  add_evaluate_command(app, session);
  add_deviation_command(app, session);
#ifdef LIMEN_WITH_SIMULATOR
  add_simulate_command(app, session);
#endif
  add_schema_command(app, session);
  add_completion_command(app, session);
}

/// The work itself, stoppable by the user; what it printed has arrived when it returns.
int run_guarded(Session& session) {
  const InterruptGuard guard(*session.monitor);
  const CancelScope scope(*session.monitor);
  const int status = session.action();
  flush_out();
  return status;
}

int fail_as(const Session& session, const std::string& message, int status) {
  // Work that was stopped may end in other ways than it should: a helper that received the same signal, say.
  const bool stopped = session.monitor && session.monitor->cancelled();
  session.wipe_progress();
  return stopped ? fail("interrupted", kExitInterrupted) : fail(message, status);
}

/// Runs what the command line asked for; every exception becomes one line and a status.
std::string internal_words(const std::exception& error) {
  return fmt::format("{} (this is an internal error of limen: please report it)", error.what());
}

int run_action(const std::vector<std::string>& words, Session& session) {
  constexpr int kReaderGone = 128 + 13;  // as SIGPIPE would end it
  try {
    require_utf8(words);
    set_thread_count(session.common.threads);
    session.monitor = make_monitor(session.common.quiet);
    const int status = run_guarded(session);
    session.monitor.reset();
    return status;
  } catch (const ReaderGone&) {
    session.monitor.reset();
    return kReaderGone;
  } catch (const Error& error) {
    return fail_as(session, error.what(), status_of(error.fault()));
  } catch (const std::bad_alloc&) {
    return fail_as(session, "out of memory (give fewer points or a larger machine)", kExitInternal);
  } catch (const std::system_error& error) {
    const bool threads = error.code() == std::errc::resource_unavailable_try_again;
    return fail_as(session,
                   threads ? "the system allows no more threads (give --threads 1, or raise its limits)"
                           : internal_words(error),
                   kExitInternal);
  } catch (const std::exception& error) {
    return fail_as(session, internal_words(error), kExitInternal);
  }
}

}  // namespace

int run_program(int argc, char** argv) {
  prepare_program();
  std::vector<std::string> texts = without_help_command(argc, argv);
  if (asked_project_move(argc, argv)) texts[1] = kProjectMove;
  std::vector<char*> words;
  for (std::string& text : texts) words.push_back(text.data());
  Session session;
  CLI::App app(
      "limen finds how laser scans of one building fit together, indoors and outdoors, and where in a "
      "building model a scan was taken. It needs no targets and no starting pose.",
      "limen");
  app.formatter(make_help_formatter());
  app.set_help_flag("-h,--help", "Show this help and exit");
  app.set_version_flag("-V,--version", fmt::format("limen {}", kVersion), "Show the version and exit");
  app.require_subcommand(1);
  app.allow_windows_style_options(false);  // a path may begin with /
  CommandLine line(app);
  add_common_options(line, session);
  add_commands(line, session);
  if (argc > 2 && std::string_view(argv[1]) == "help") {
    const std::vector<std::string> known = command_names(app);
    if (std::find(known.begin(), known.end(), argv[2]) == known.end())
      return fail(unknown_word(argv[2], "a command", known) + " (see limen --help)", kExitBadInput);
  }
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);
    return fail(usage_error(app, error), kExitBadInput);
  }
  return run_action(texts, session);
}

}  // namespace limen
