// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "limen/cli/help/program_doc.h"

namespace CLI {
class FormatterBase;
}

namespace limen {

/// The text of --help: usage, arguments, options, exit statuses, examples; 80 columns.
std::string help_text(const CommandDoc& command, const std::vector<CommandDoc>& subcommands);

/// What makes CLI11 print help_text().
std::shared_ptr<CLI::FormatterBase> make_help_formatter();

/// The manual page limen(1), in the man macros of roff.
std::string man_page(const ProgramDoc& doc);

}  // namespace limen
