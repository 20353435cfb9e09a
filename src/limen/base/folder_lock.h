// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace limen {

/// A folder that one process at a time works in: while this lives no other can take it. The system releases
/// it when the process ends, however it ends. Where the file system knows no locks, two runs are not kept
/// from one folder.
class FolderLock {
 public:
  /// The file in it that is locked; gone with the lock.
  static constexpr const char* kFile = ".limen-lock";

  /// `taken`, `remedy`: the words of the error where another process has it. Throws Error, of the folder.
  /// `file`: of another lock of the folder.
  FolderLock(const std::filesystem::path& folder, const std::string& taken, const std::string& remedy,
             const char* file = kFile);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace limen
