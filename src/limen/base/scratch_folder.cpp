// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "limen/base/error.h"

namespace limen {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent, const std::string& name) {
  std::string made = (parent / (name + "-XXXXXX")).string();
  if (mkdtemp(made.data()) == nullptr)
    throw Error(std::strerror(errno), parent.string(), "give a folder that can be written to");
  path_ = made;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace limen
