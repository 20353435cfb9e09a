// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/scratch_folder.h"

#include <cerrno>
#include <system_error>

#include "limen/base/error.h"
#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent, const std::string& name) {
  path_ = make_scratch_folder(parent / name);
  if (path_.empty()) throw Error(reason_of(errno), parent.string(), "give a folder that can be written to");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace limen
