// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "limen/cli/terminal/command.h"

namespace limen {

/// Serves a folder at 127.0.0.1 until the user ends it; port 0: any that is free. Throws Error where the
/// folder is served already, the port is taken, or the system is one without servers (yet).
void serve(const std::string& folder_name, int port, std::uint64_t most_upload, const Session& session);

}  // namespace limen
