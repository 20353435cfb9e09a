// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/readable.h"

#include <cerrno>

#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/text.h"

namespace limen {
namespace {

std::string why_missing(const std::string& name) {
  if (name.empty()) return "the name of a file is empty";
  if (name.find("://") != std::string::npos) return "is an address, and limen reads files only";
  return "there is no such file";
}

}  // namespace

std::string why_unreadable(const std::filesystem::path& path, const char* wanted) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0)
    return errno == ENOENT || errno == ENOTDIR ? why_missing(path.string()) : reason_of(errno);
  if (S_ISDIR(status.st_mode)) return std::string("is a folder, not a ") + wanted;
  return access(path.c_str(), R_OK) == 0 ? "" : reason_of(errno);
}

void require_readable(const std::filesystem::path& path, const std::string& remedy, const char* wanted) {
  const std::string why = why_unreadable(path, wanted);
  if (!why.empty()) throw Error(why, path.string(), remedy);
}

}  // namespace limen
