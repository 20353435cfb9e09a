// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/error.h"
#include "limen/project/engine/helper_process.h"

namespace limen {

HelperProcess::HelperProcess(const std::vector<std::string>& /*command*/, const std::string& /*log*/) {
  throw Error("--engine dask is not available on Windows yet", "", "leave --engine out");
}

HelperProcess::~HelperProcess() = default;

bool HelperProcess::say(const std::string& /*line*/) {
  return false;
}

std::optional<std::string> HelperProcess::hear(int /*milliseconds*/) {
  ended_ = true;
  return {};
}

}  // namespace limen
