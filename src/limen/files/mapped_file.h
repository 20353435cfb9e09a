// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace limen {

/// The bytes of a file, read-only, as long as the object lives: mapped where the file is a regular one, read
/// into memory where it is not (a pipe).
class MappedFile {
 public:
  /// Throws Error where the path is missing, a folder, unreadable or empty.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

  /// Gives the memory of what was read so far back to the system; bytes that are looked at again are read
  /// again. Call it now and then while passing through a large file.
  void forget() const;

 private:
  void read_stream(int descriptor, const std::string& name);

  const char* data_ = nullptr;
  std::size_t size_ = 0;
  bool mapped_ = false;
  std::string read_;  ///< holds the bytes where they are not mapped
};

}  // namespace limen
