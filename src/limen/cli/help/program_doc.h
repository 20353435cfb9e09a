// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace limen {

/// What follows an option, or is a positional argument.
enum class ValueKind { none, text, file, folder };

/// One option or positional argument as its command tells it.
struct OptionDoc {
  std::vector<std::string> names;    ///< "-o", "--output"; of a positional one: "SOURCE"
  std::string value;                 ///< "DIR", "auto|polygons"; empty for flags
  ValueKind kind = ValueKind::none;  ///< what a shell may complete
  std::vector<std::string> choices;  ///< all values that are taken; with kind file: or a file
  std::string description;
  bool positional = false;
  bool required = false;
  bool common = false;  ///< every command has it

  /// The description, and the choices where it does not name them all.
  [[nodiscard]] std::string text() const;
};

/// A call worth showing, and what it does.
struct ExampleDoc {
  std::string text;
  std::string command;
};

struct CommandDoc {
  std::string name;  ///< "register"; of the program itself: empty
  std::string description;
  std::vector<OptionDoc> options;  ///< positional ones first
  std::vector<ExampleDoc> examples;
};

/// All that help, the manual page and the completions contain: taken from the command line itself, so that
/// they cannot differ from it.
struct ProgramDoc {
  CommandDoc program;
  std::vector<CommandDoc> commands;
};

/// The word by which a user calls a command.
std::string typed_name(const CLI::App& command);
CommandDoc describe_command(const CLI::App& app);
ProgramDoc describe_program(const CLI::App& app);

/// An exit status and its meaning, for help and manual.
struct StatusDoc {
  int status = 0;
  std::string meaning;
};
std::vector<StatusDoc> status_docs();

/// `text` broken into lines of at most `columns`, at spaces.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

}  // namespace limen
