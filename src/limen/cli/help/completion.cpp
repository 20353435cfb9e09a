// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/help/completion.h"

#include <algorithm>

#include <fmt/format.h>

namespace limen {
namespace {

constexpr const char* kHead =
    "# SPDX-FileCopyrightText: The limen authors\n# SPDX-License-Identifier: Apache-2.0\n";

/// What an option's value, or a positional argument, may be: bash.
std::string bash_values(const OptionDoc& option) {
  std::string text;
  if (!option.choices.empty()) text = fmt::format("_limen_words '{}'", fmt::join(option.choices, " "));
  if (option.kind == ValueKind::file) text += (text.empty() ? "" : "; ") + std::string("_limen_files -f");
  if (option.kind == ValueKind::folder) text = "_limen_files -d";
  return text.empty() ? ":" : text;
}

std::vector<std::string> option_names(const CommandDoc& command) {
  std::vector<std::string> names;
  for (const OptionDoc& option : command.options) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::string bash_command(const CommandDoc& command) {
  std::string text = fmt::format("    {})\n      case $previous in\n", command.name);
  for (const OptionDoc& option : command.options) {
    if (option.positional || option.kind == ValueKind::none) continue;
    text += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), bash_values(option));
  }
  text += "      esac\n";
  text += fmt::format("      if [[ $current == -* ]]; then _limen_words '{}'; return; fi\n",
                      fmt::join(option_names(command), " "));
  // Of a command with choices the first argument is one; every other argument is a file.
  const auto first = std::find_if(command.options.begin(), command.options.end(),
                                  [](const OptionDoc& option) { return option.positional; });
  text += fmt::format("      {} ;;\n", first == command.options.end() ? ":" : bash_values(*first));
  return text;
}

std::vector<std::string> command_names(const ProgramDoc& doc) {
  std::vector<std::string> names;
  for (const CommandDoc& command : doc.commands) names.push_back(command.name);
  return names;
}

/// Text between single quotes of zsh and fish.
std::string quoted(const std::string& text, const char* quote) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += quote;
    } else {
      safe += c;
    }
  }
  return safe;
}

/// A description within _arguments: there brackets and colons mean something.
std::string zsh_text(const std::string& text) {
  std::string safe;
  for (const char c : quoted(text, "'\\''")) {
    if (c == '[' || c == ']' || c == ':') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string zsh_action(const OptionDoc& option) {
  if (option.kind == ValueKind::folder) return "_files -/";
  const std::string words = fmt::format("{}", fmt::join(option.choices, " "));
  if (option.kind == ValueKind::file)
    return words.empty() ? "_files" : "_alternative \"names::(" + words + ")\" \"files:file:_files\"";
  return words.empty() ? " " : "(" + words + ")";
}

std::string zsh_option(const OptionDoc& option) {
  if (option.positional) return fmt::format("      '*:{}:{}' \\\n", option.names.front(), zsh_action(option));
  std::string text;
  for (const std::string& name : option.names) {
    text += fmt::format("      '{}[{}]", name, zsh_text(option.description));
    if (option.kind != ValueKind::none)
      text += fmt::format(":{}:{}", zsh_text(option.value), zsh_action(option));
    text += "' \\\n";
  }
  return text;
}

std::string zsh_command(const CommandDoc& command) {
  std::string text = fmt::format("    {})\n      _arguments -s \\\n", command.name);
  bool positional = false;
  for (const OptionDoc& option : command.options) {
    if (option.positional && positional) continue;
    positional = positional || option.positional;
    text += zsh_option(option);
  }
  text.erase(text.size() - 3);
  return text + "\n      ;;\n";
}

std::string fish_option(const OptionDoc& option, const std::string& condition) {
  std::string text = fmt::format("complete -c limen -n '{}'", condition);
  if (!option.positional) {
    for (const std::string& name : option.names)
      text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
    text += fmt::format(" -d '{}'", quoted(option.description, "\\'"));
  }
  const std::string words = fmt::format("{}", fmt::join(option.choices, " "));
  if (option.kind == ValueKind::folder) return text + " -xa '(__fish_complete_directories)'\n";
  if (option.kind == ValueKind::file) return text + (words.empty() ? " -rF\n" : " -rF -a '" + words + "'\n");
  if (option.kind == ValueKind::text) return text + (words.empty() ? " -x\n" : " -xa '" + words + "'\n");
  return text + "\n";
}

}  // namespace

std::string bash_completion(const ProgramDoc& doc) {
  std::string text = kHead;
  text += R"(
_limen_words() {
  local found
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -W "$1" -- "$current")
}

_limen_files() {
  local found
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen "$1" -- "$current")
  compopt -o filenames 2> /dev/null
}

_limen() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command='' word
  COMPREPLY=()
  # --method=auto comes as three words.
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $previous == '=' ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
)";
  const std::string names = fmt::format("{}", fmt::join(command_names(doc), "|"));
  text +=
      fmt::format("    case $word in {}) command=$word; break ;; esac\n  done\n  case $command in\n", names);
  for (const CommandDoc& command : doc.commands) text += bash_command(command);
  text += fmt::format("    *)\n      if [[ $current == -* ]]; then _limen_words '{}'; return; fi\n",
                      fmt::join(option_names(doc.program), " "));
  text += fmt::format("      _limen_words '{}' ;;\n  esac\n}}\n\ncomplete -F _limen limen\n",
                      fmt::join(command_names(doc), " "));
  return text;
}

std::string zsh_completion(const ProgramDoc& doc) {
  std::string text = "#compdef limen\n";
  text += kHead;
  text += "\n_limen() {\n  local -a commands\n  commands=(\n";
  for (const CommandDoc& command : doc.commands)
    text += fmt::format("    '{}:{}'\n", command.name, quoted(command.description, "'\\''"));
  text +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe -t commands 'limen command' commands\n    return\n  "
      "fi\n";
  text += "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n";
  for (const CommandDoc& command : doc.commands) text += zsh_command(command);
  // Loaded from a folder of functions the file is the function; sourced it registers it.
  text +=
      "  esac\n}\n\nif [[ $funcstack[1] == _limen ]]; then\n  _limen \"$@\"\nelse\n  compdef _limen "
      "limen\nfi\n";
  return text;
}

std::string fish_completion(const ProgramDoc& doc) {
  std::string text = kHead;
  text += "\ncomplete -c limen -f\n";
  for (const CommandDoc& command : doc.commands) {
    text += fmt::format("complete -c limen -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                        quoted(command.description, "\\'"));
  }
  for (const OptionDoc& option : doc.program.options) text += fish_option(option, "__fish_use_subcommand");
  for (const CommandDoc& command : doc.commands) {
    bool positional = false;
    for (const OptionDoc& option : command.options) {
      if (option.positional && positional) continue;
      positional = positional || option.positional;
      text += fish_option(option, "__fish_seen_subcommand_from " + command.name);
    }
  }
  return text;
}

}  // namespace limen
