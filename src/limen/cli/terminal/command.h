// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "limen/base/progress.h"
#include "limen/cli/terminal/command_line.h"

namespace limen {

/// The exit statuses of the program: a contract with scripts.
enum ExitStatus : int {
  kExitOk = 0,             ///< done; of register: registered
  kExitInternal = 1,       ///< a fault of limen
  kExitBadInput = 2,       ///< a file, a value or an option the user gave
  kExitUndecided = 3,      ///< probable, ambiguous or under_constrained
  kExitNoMatch = 4,        ///< nothing in common was found; of deviation: no point on a face
  kExitInterrupted = 130,  ///< stopped by the user
};

/// The heading of the options that every command has.
inline constexpr const char* kCommonGroup = "Common options";

/// The name of the command that is meant by `transform PROJECT -o OUT`.
inline constexpr const char* kProjectMove = "transform-project";

/// The options that every command has.
struct CommonOptions {
  bool quiet = false;      ///< neither progress nor summary
  bool json = false;       ///< the result as JSON on stdout, everything else on stderr
  int threads = 0;         ///< 0: as many as the machine has
  std::uint64_t seed = 1;  ///< of every random choice
};

/// What a command gets from the program and gives back: the common options, the ears of its progress, and
/// the work to be done once the whole command line was understood.
struct Session {
  CommonOptions common;
  std::unique_ptr<Monitor> monitor;
  std::function<int()> action;  ///< set by the chosen command; returns its exit status

  /// The summary for a reader: to stdout, or nowhere with --quiet or --json.
  void say(std::string_view text) const;
  /// The result as JSON text: to stdout, only with --json.
  void answer(std::string_view json_text) const;
  /// A remark: one line to stderr, or nowhere with --quiet.
  void note(std::string_view text) const;
  /// One line on stderr about something that was asked for and is missing; shown also where quiet.
  void warn(std::string_view text) const;
  /// Takes the progress line away, before something else is printed.
  void wipe_progress() const;

 private:
  void tell_line(const std::string& line) const;
};

/// A message as one line that a terminal shows as it is, whatever words of files and users it holds; of long
/// ones beginning and end.
std::string message_line(std::string_view message);

/// Adds the subcommand `name` with its common options. The command adds its own to what is returned; its
/// `run` is called after parsing and returns an exit status.
///
/// One command is one source with one function of commands.h; program.cpp calls them.
CommandLine* add_command(CommandLine& app, Session& session, const std::string& name,
                         const std::string& description, std::function<int()> run);

/// Adds an option that takes a length in metres, finite and not negative.
void add_length_option(CommandLine& app, const std::string& name, double& length_m,
                       const std::string& description);

/// Adds --quiet, --json, --threads and --seed.
void add_common_options(CommandLine& app, Session& session);

}  // namespace limen
