// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/help/program_help.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/cli/terminal/command.h"

namespace limen {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kNameColumns = 26;

/// "-o, --output DIR"; long names stand below one another whether or not there is a short one.
std::string head_of(const OptionDoc& option) {
  std::string text = fmt::format("{}", fmt::join(option.names, ", "));
  if (!option.positional && option.names.front().rfind("--", 0) == 0) text = "    " + text;
  // Lists of choices come with the description: here they would push it off the line.
  const std::string value = option.choices.empty() || option.kind == ValueKind::file ? option.value : "NAME";
  return option.value.empty() || option.positional ? text : text + " " + value;
}

std::string body_of(const OptionDoc& option) {
  return option.text() + (option.required && !option.positional ? " (required)" : "");
}

std::string entry(const std::string& head, const std::string& body) {
  std::string text = "  " + head;
  const bool beside = text.size() + 2 <= kNameColumns;
  if (!beside) text += "\n";
  std::size_t column = beside ? text.size() : 0;
  for (const std::string& line : wrapped(body, kColumns - kNameColumns)) {
    text += std::string(kNameColumns - column, ' ') + line + "\n";
    column = 0;
  }
  return text;
}

template <typename Predicate>
std::string section(const std::string& title, const CommandDoc& command, const Predicate& belongs) {
  std::string text;
  for (const OptionDoc& option : command.options) {
    if (belongs(option)) text += entry(head_of(option), body_of(option));
  }
  return text.empty() ? text : fmt::format("\n{}:\n{}", title, text);
}

std::string usage_of(const CommandDoc& command) {
  if (command.name.empty()) return "Usage: limen COMMAND [OPTIONS]\n";
  std::string text = fmt::format("Usage: limen {}", command.name);
  for (const OptionDoc& option : command.options) {
    if (option.positional) text += " " + option.names.front();
  }
  for (const OptionDoc& option : command.options) {
    if (option.required && !option.positional)
      text += fmt::format(" {} {}", option.names.front(), option.value);
  }
  return text + " [OPTIONS]\n";
}

std::string examples_text(const CommandDoc& command) {
  std::string text;
  for (const ExampleDoc& example : command.examples) {
    text += fmt::format("  # {}\n", example.text);
    for (const std::string& line : CLI::detail::split(example.command, '\n')) text += "  " + line + "\n";
  }
  return text.empty() ? text : "\nExamples:\n" + text;
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode /*mode*/) const override {
    const ProgramDoc doc = describe_program(*app);
    return help_text(doc.program, doc.commands);
  }
};

}  // namespace

std::string help_text(const CommandDoc& command, const std::vector<CommandDoc>& subcommands) {
  std::string text;
  for (const std::string& line : wrapped(command.description, kColumns)) text += line + "\n";
  text += "\n" + usage_of(command);
  text += section("Arguments", command, [](const OptionDoc& option) { return option.positional; });
  if (!subcommands.empty()) {
    text += "\nCommands:\n";
    for (const CommandDoc& it : subcommands) text += entry(it.name, it.description);
  }
  text += section("Options", command,
                  [](const OptionDoc& option) { return !option.positional && !option.common; });
  text += section(kCommonGroup, command, [](const OptionDoc& option) { return option.common; });
  if (command.name.empty()) {
    text += "\nExit status:\n";
    for (const StatusDoc& it : status_docs()) text += entry(fmt::to_string(it.status), it.meaning);
  }
  text += examples_text(command);
  if (command.name.empty()) text += "\nlimen COMMAND --help explains a command in full.\n";
  return text;
}

std::shared_ptr<CLI::FormatterBase> make_help_formatter() {
  return std::make_shared<HelpFormatter>();
}

}  // namespace limen
