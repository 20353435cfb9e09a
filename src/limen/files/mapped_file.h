// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"

namespace limen {

/// Throws Error for a file in the format of one maker's programs, which limen does not read: it names the
/// maker, and how those programs export what limen reads. By the bytes where they tell, else by the ending of
/// `path`: formats that limen reads are to be recognised before.
void refuse_vendor_format(std::string_view bytes, const std::filesystem::path& path);

/// Whether a file of this name is in such a format, if its bytes do not tell otherwise.
bool has_vendor_ending(const std::filesystem::path& path);

/// That there is no file of this name, and what to do.
Error missing_file(const std::string& name);

/// What something is that is no regular file, by its st_mode: "is a folder, not a {wanted}", or a pipe or a
/// device, which may have no end. Empty where it is one.
std::string why_no_file(unsigned mode, const char* wanted = "file");

/// Why a file cannot be read: that there is none, why_no_file(), or what the system says. Empty where it can
/// be read.
std::string why_unreadable(const std::filesystem::path& path, const char* wanted = "file");

/// Throws Error with that, where there is such a reason.
void require_readable(const std::filesystem::path& path, const std::string& remedy,
                      const char* wanted = "file");

/// The bytes of a regular file, read-only, as long as the object lives: mapped, or read into memory where its
/// disk cannot map it. Where the file becomes shorter meanwhile, what is missing reads as
/// zeros, and require_inputs_whole() reports it (base/guarded_mapping.h).
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
