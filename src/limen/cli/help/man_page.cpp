// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/StringTools.hpp>
#include <fmt/format.h>

#include "limen/base/version.h"
#include "limen/cli/help/program_help.h"

namespace limen {
namespace {

/// Text as roff reads it: signs that mean something to it are named, no line begins with a request.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if (c == '\'') {
      safe += "\\(aq";
    } else if (c == '^') {
      safe += "\\(ha";
    } else if (c == '~') {
      safe += "\\(ti";
    } else {
      safe += c;
    }
  }
  return safe.empty() || safe.front() != '.' ? safe : "\\&" + safe;
}

/// One sentence or description, broken into lines that a reader of the source can read.
std::string paragraph(const std::string& text) {
  std::string lines;
  for (const std::string& line : wrapped(text, 78)) lines += roff(line) + "\n";
  return lines;
}

std::string option_item(const OptionDoc& option) {
  std::string head;
  for (const std::string& name : option.names) {
    head += head.empty() ? "" : ", ";
    head += option.positional ? fmt::format("\\fI{}\\fR", roff(name)) : fmt::format("\\fB{}\\fR", roff(name));
  }
  const bool listed = !option.choices.empty() && option.kind != ValueKind::file;
  if (!option.value.empty() && !option.positional)
    head += fmt::format(" \\fI{}\\fR", listed ? "NAME" : roff(option.value));
  std::string body = option.text();
  body += option.required && !option.positional ? " (required)." : ".";
  return ".TP\n" + head + "\n" + paragraph(body);
}

std::string examples(const CommandDoc& command) {
  std::string text;
  for (const ExampleDoc& example : command.examples) {
    text += ".PP\n" + paragraph(example.text + ":") + ".PP\n.nf\n.RS\n";
    for (const std::string& line : CLI::detail::split(example.command, '\n')) text += roff(line) + "\n";
    text += ".RE\n.fi\n";
  }
  return text;
}

std::string synopsis(const CommandDoc& command) {
  std::string text = fmt::format("\\fBlimen {}\\fR", roff(command.name));
  for (const OptionDoc& option : command.options) {
    if (option.positional) text += fmt::format(" \\fI{}\\fR", roff(option.names.front()));
  }
  return text + " [\\fIOPTIONS\\fR]\n";
}

std::string command_section(const CommandDoc& command) {
  std::string text = fmt::format(".SS limen {}\n", command.name) + paragraph(command.description + ".");
  for (const OptionDoc& option : command.options) {
    if (!option.common) text += option_item(option);
  }
  return text + examples(command);
}

}  // namespace

std::string man_page(const ProgramDoc& doc) {
  std::string text =
      ".\\\" SPDX-FileCopyrightText: The limen authors\n.\\\" SPDX-License-Identifier: Apache-2.0\n";
  text += fmt::format(".TH LIMEN 1 {} \"limen {}\" \"User Commands\"\n", kVersionDate, kVersion);
  text += ".SH NAME\nlimen \\- register laser scans of one building, and scans with building models\n";
  text += ".SH SYNOPSIS\n";
  for (const CommandDoc& command : doc.commands) text += synopsis(command) + ".br\n";
  text.erase(text.size() - 4);
  text += ".SH DESCRIPTION\n" + paragraph(doc.program.description);
  text += ".SH COMMANDS\n";
  for (const CommandDoc& command : doc.commands) text += command_section(command);
  text += ".SH COMMON OPTIONS\nThese apply to every command.\n";
  for (const OptionDoc& option : doc.program.options) text += option_item(option);
  text += ".SH EXIT STATUS\n";
  for (const StatusDoc& it : status_docs())
    text += fmt::format(".TP\n{}\n", it.status) + paragraph(it.meaning);
  text += ".SH ENVIRONMENT\n.TP\nLC_ALL, LC_CTYPE, LANG\n";
  text += paragraph("Whether the progress line may use characters beyond ASCII.");
  text += ".TP\nTERM\n" + paragraph("With the value dumb no progress line is shown.");
  text += ".TP\nLIMEN_CHROMIUM\n" + paragraph("The browser that prints --pdf.");
  text += ".TP\nLIMEN_IFC_HELPER\n" + paragraph("The helper program that reads IFC models.");
  text += ".SH EXAMPLES\n" + examples(doc.program).substr(4);
  return text;
}

}  // namespace limen
