// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "limen/base/guarded_mapping.h"

namespace limen {

/// The bytes of a regular file, read-only, as long as the object lives: mapped, or read into memory where its
/// disk cannot map it. Where the file becomes shorter meanwhile, what is missing reads as
/// zeros, and require_inputs_whole() tells of it (base/guarded_mapping.h).
class MappedFile {
 public:
  /// Throws Error where the path is missing, no regular file, unreadable or empty.
  explicit MappedFile(const std::filesystem::path& path);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

  /// Gives the memory of what was read so far back to the system; bytes that are looked at again are read
  /// again. Call it now and then while passing through a large file.
  void forget() const {
    if (mapping_) mapping_->forget();
  }

 private:
  void read_whole(int descriptor, const std::string& name);

  const char* data_ = nullptr;
  std::size_t size_ = 0;
  std::unique_ptr<const GuardedMapping> mapping_;
  std::string read_;  ///< holds the bytes where they are not mapped
};

}  // namespace limen
