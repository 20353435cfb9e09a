// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limen {

/// A file that appears whole or not at all: the bytes go to a hidden file beside it, which commit() renames.
/// Where the destination is not a regular file (/dev/stdout, a pipe) they go straight there.
///
/// The hidden file is called .NAME.limen-PROCESS-NUMBER.part and locked while it is written. One that nobody
/// holds any more was left behind by a process that was killed: the next that writes into the folder removes
/// it.
class AtomicFile {
 public:
  /// Throws Error where no file can be made there (missing folder, no permission, a folder of that name).
  explicit AtomicFile(std::filesystem::path path);
  /// Removes the hidden file unless commit() was called.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends; throws Error where the disk is full.
  void write(std::string_view bytes);
  /// Replaces bytes that were written before, at `offset` from the beginning: a header whose counts are known
  /// only in the end. Throws Error where the destination is a pipe.
  void overwrite(std::uint64_t offset, std::string_view bytes);
  /// Brings the bytes to the disk, not yet to their name: of files that belong together none appears before
  /// all have room. Throws Error as commit() does.
  void settle();
  /// Brings the bytes to the disk and the file to its name. Call it once, last. Throws Error where the disk
  /// is full, and where an input of this process became shorter while it was read.
  void commit();

 private:
  [[noreturn]] void fail(const char* doing) const;
  void open_beside();
  void flush();
  void take_final_name();
  void close_quietly() noexcept;

  std::filesystem::path path_;
  std::filesystem::path beside_;  ///< empty where it writes straight to path_
  int descriptor_ = -1;
  std::string buffer_;
};

/// Writes all of `bytes` to `path`, or throws Error and leaves what was there.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// A file to be, by its place and its bytes.
struct FileToWrite {
  std::filesystem::path path;
  std::string_view bytes;
};

/// Writes all of the files, which then appear in their order, or none: throws Error where one has no room.
void write_files(const std::vector<FileToWrite>& files);

/// A folder for results: made with its parents where it is missing, and proved writable before the work
/// starts. What it made and nobody filled is removed again in the end, so a failure leaves nothing behind.
class OutputFolder {
 public:
  /// Throws Error where the folder cannot be made or written to.
  explicit OutputFolder(std::filesystem::path path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void prove_writable() const;
  void remove_empty() noexcept;

  std::filesystem::path path_;
  std::filesystem::path first_made_;  ///< the topmost folder that was missing; empty where none was
};

}  // namespace limen
