// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/folder_lock.h"
#include "limen/base/text.h"

namespace limen {
namespace {

/// Whether the file of this name is still the one that is open: who had the lock before removes it.
bool is_still_there(int descriptor, const std::filesystem::path& file) {
  struct stat open_one {};
  struct stat named {};
  return fstat(descriptor, &open_one) == 0 && lstat(file.c_str(), &named) == 0 &&
         open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

/// A file and not the folder: locks of NFS are only for what is open for writing.
int opened(const std::filesystem::path& file) {
  constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  int descriptor = open(file.c_str(), O_RDWR | O_CREAT | kFlags, 0666);
  // One that a killed process of somebody else left.
  if (descriptor < 0 && errno == EACCES) descriptor = open(file.c_str(), O_RDONLY | kFlags);
  if (descriptor < 0)
    throw Error("cannot be written: " + reason_of(errno), file.string(),
                "give a folder with write permission");
  return descriptor;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& taken,
                       const std::string& remedy, const char* file)
    : file_(folder / file) {
  for (;;) {
    descriptor_ = opened(file_);
    const bool locked = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    const int reason = locked ? 0 : errno;
    if (locked && is_still_there(descriptor_, file_)) return;
    if (!locked && reason != EWOULDBLOCK && reason != EINTR) return;  // no locks there
    close(descriptor_);
    if (reason == EWOULDBLOCK) throw Error(taken, folder.string(), remedy);
  }
}

FolderLock::~FolderLock() {
  // While it is held: whoever waits for this file sees that it is gone, and makes another.
  unlink(file_.c_str());
  close(descriptor_);
}

}  // namespace limen
