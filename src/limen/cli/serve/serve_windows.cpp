// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/error.h"
#include "limen/cli/serve/serve.h"

namespace limen {

void serve(const std::string& /*folder_name*/, int /*port*/, std::uint64_t /*most_upload*/,
           const Session& /*session*/) {
  throw Error("serve is not available on Windows yet", "", "use the other commands, or limen on Linux");
}

}  // namespace limen
