// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/command.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/cli/terminal/terminal.h"

namespace limen {
namespace {

/// The text with a line end; nothing stays nothing.
std::string ended(std::string_view text) {
  return fmt::format("{}{}", text, text.empty() || text.back() == '\n' ? "" : "\n");
}

}  // namespace

std::string message_line(std::string_view message) {
  constexpr std::size_t kMostBytes = 1000;
  return shortened(printable(trimmed(one_line(std::string(message)))), kMostBytes);
}

void Session::say(std::string_view text) const {
  if (common.quiet || common.json) return;
  wipe_progress();
  print_out(ended(printable_lines(text)));
}

void Session::answer(std::string_view json_text) const {
  if (!common.json) return;
  wipe_progress();
  print_out(ended(json_text));
}

void Session::note(std::string_view text) const {
  if (!common.quiet) tell_line(fmt::format("limen: {}\n", message_line(text)));
}

void Session::warn(std::string_view text) const {
  tell_line(fmt::format("limen: warning: {}\n", message_line(text)));
}

void Session::tell_line(const std::string& line) const {
  if (auto* terminal = dynamic_cast<TerminalMonitor*>(monitor.get())) {
    terminal->print(line);
  } else {
    std::fputs(line.c_str(), stderr);
  }
}

void Session::wipe_progress() const {
  if (auto* terminal = dynamic_cast<TerminalMonitor*>(monitor.get())) terminal->wipe();
}

void add_common_options(CommandLine& app, Session& session) {
  const std::string group = kCommonGroup;
  CommonOptions& common = session.common;
  app.add_flag("-q,--quiet", common.quiet, "No progress and no summary; errors are still shown")
      ->group(group);
  app.add_flag("--json", common.json, "The result as JSON on stdout, everything else on stderr")
      ->group(group);
  app.add_option("--threads N", common.threads,
                 "Number of threads; it never changes a result (default 0: all of the machine)")
      ->in_range(0, 4096)
      ->group(group);
  app.add_option("--seed N", common.seed, "Seed of the random numbers (default 1)")->group(group);
}

void add_length_option(CommandLine& app, const std::string& name, double& length_m,
                       const std::string& description) {
  const auto finite = [](const std::string& text) -> std::string {
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, number);
    const bool good = read.ec == std::errc() && read.ptr == end && std::isfinite(number) && number >= 0.0;
    return good ? "" : fmt::format("{} is not a length in metres", text);
  };
  app.add_option(name, length_m, description)->check(finite)->type_name("M");
}

CommandLine* add_command(CommandLine& app, Session& session, const std::string& name,
                         const std::string& description, std::function<int()> run) {
  CommandLine* command =
      app.add_command(name, description, [&session, run = std::move(run)] { session.action = run; });
  add_common_options(*command, session);
  return command;
}

}  // namespace limen
