// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/readable.h"

#include <cerrno>

#include <fmt/format.h>
#include <sys/stat.h>

#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {

Error missing_file(const std::string& name) {
  if (name.empty()) return {"the name of a file is empty", "", "name a file"};
  if (name.find("://") != std::string::npos)
    return {"is a web address, but limen reads files only", name, "download it, and name the file"};
  return {"there is no such file", name, "check the path"};
}

std::string why_no_file(unsigned mode, const char* wanted) {
  if (S_ISREG(mode)) return {};
  return fmt::format("is a {}, not a {}", S_ISDIR(mode) ? "folder" : "pipe or a device", wanted);
}

std::string why_unreadable(const std::filesystem::path& path, const char* wanted) {
  const unsigned mode = mode_of(path);
  if (mode == 0)
    return errno == ENOENT || errno == ENOTDIR ? missing_file(path.string()).problem() : reason_of(errno);
  if (std::string other = why_no_file(mode, wanted); !other.empty()) return other;
  return may_read(path) ? "" : reason_of(errno);
}

void require_readable(const std::filesystem::path& path, const std::string& remedy, const char* wanted) {
  const std::string why = why_unreadable(path, wanted);
  if (!why.empty()) throw Error(why, path.string(), remedy);
}

}  // namespace limen
