// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include "limen/base/error.h"
#include "limen/base/folder_lock.h"

namespace limen {

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& taken,
                       const std::string& remedy, const char* file)
    : file_(folder / file) {
  // Open for nobody else, and gone with its handle.
  HANDLE handle = CreateFileW(file_.c_str(), GENERIC_WRITE | DELETE, 0, nullptr, OPEN_ALWAYS,
                              FILE_ATTRIBUTE_HIDDEN | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
  const DWORD reason = GetLastError();
  if (handle == INVALID_HANDLE_VALUE && reason == ERROR_SHARING_VIOLATION)
    throw Error(taken, folder.string(), remedy);
  if (handle == INVALID_HANDLE_VALUE)
    throw Error("cannot be written: " + std::system_category().message(static_cast<int>(reason)),
                file_.string(), "give a folder with write permission");
  descriptor_ = _open_osfhandle(reinterpret_cast<std::intptr_t>(handle), _O_BINARY);
}

FolderLock::~FolderLock() {
  _close(descriptor_);
}

}  // namespace limen
