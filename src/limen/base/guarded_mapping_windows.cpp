// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <io.h>
#include <windows.h>

#include "limen/base/guarded_mapping.h"

namespace limen {

// The system refuses to make a mapped file shorter, so that no guard is needed.

GuardedMapping::GuardedMapping(int descriptor, std::size_t size, std::string name)
    : descriptor_(descriptor), size_(size), name_(std::move(name)), slot_(0) {
  const auto file = reinterpret_cast<HANDLE>(_get_osfhandle(descriptor_));
  HANDLE mapping = CreateFileMappingW(file, nullptr, PAGE_READONLY, 0, 0, nullptr);
  if (mapping == nullptr) return;
  data_ = static_cast<char*>(MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, size_));
  CloseHandle(mapping);  // the view keeps it
}

GuardedMapping::~GuardedMapping() {
  if (data_ != nullptr) UnmapViewOfFile(data_);
  _close(descriptor_);
}

void GuardedMapping::forget() const {
  // Pages that are not locked leave the working set.
  if (data_ != nullptr) VirtualUnlock(data_, size_);
}

bool GuardedMapping::whole() const {
  return true;
}

void require_inputs_whole() {}

}  // namespace limen
