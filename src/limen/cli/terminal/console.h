// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace limen {

/// What the program sets for itself before all else: a file that may not grow is an error like others, and
/// text is UTF-8, with no byte changed.
void prepare_program();

/// Whether stderr is a terminal that can move its cursor.
bool draws_on_stderr();
bool console_is_utf8();
int console_columns();
/// A process that was sent to the background does not write over what the user does meanwhile.
bool in_foreground();

}  // namespace limen
