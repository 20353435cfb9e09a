// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

/// Beside the destination, so that the rename stays within one file system; unique in this machine.
fs::path hidden_name_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string name = fmt::format(".{}.{}-{}.part", path.filename().string(), getpid(), counter++);
  return path.parent_path() / name;
}

std::string reason_of(int error_number) {
  return std::generic_category().message(error_number);
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored)) {
    const fs::path behind = fs::canonical(path_, ignored);
    if (!behind.empty()) path_ = behind;  // the link stays, what it points to is replaced
  }
  const fs::file_status status = fs::status(path_, ignored);
  if (fs::is_directory(status)) {
    throw Error("is a folder, not a file", path_.string(), "name a file to write to");
  }
  const bool replace = !fs::exists(status) || fs::is_regular_file(status);
  if (replace) beside_ = hidden_name_beside(path_);
  const char* name = replace ? beside_.c_str() : path_.c_str();
  descriptor_ = open(name, replace ? O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC : O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    beside_.clear();
    fail("cannot be written");
  }
}

AtomicFile::~AtomicFile() {
  close_quietly();
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferBytes) flush();
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno != EINTR) fail("cannot be written");
    if (written <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void AtomicFile::commit() {
  flush();
  if (!beside_.empty() && fsync(descriptor_) != 0) fail("cannot be brought to the disk");
  if (close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written");
  if (beside_.empty()) return;
  if (std::rename(beside_.c_str(), path_.c_str()) != 0) fail("cannot be put in place");
  beside_.clear();
}

void AtomicFile::fail(const char* doing) const {
  throw Error(fmt::format("{}: {}", doing, reason_of(errno)), path_.string(),
              "name a place that exists, has room and may be written to");
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) fail("cannot be written");
    if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::close_quietly() noexcept {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  if (!beside_.empty()) unlink(beside_.c_str());
}

void write_file(const fs::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  fs::path missing = fs::absolute(path_, error).lexically_normal();
  if (!missing.has_filename()) missing = missing.parent_path();
  while (!missing.empty() && !fs::exists(missing, error) && missing != missing.root_path()) {
    first_made_ = missing;
    missing = missing.parent_path();
  }
  error.clear();
  fs::create_directories(path_, error);
  // create_directories also fails, harmlessly, on a link to a folder.
  std::error_code ignored;
  if (!fs::is_directory(path_, ignored)) {
    remove_empty();
    throw Error(fmt::format("the output folder cannot be made: {}", error ? error.message() : "not a folder"),
                path_.string(), "name a folder that exists or can be made");
  }
  try {
    prove_writable();
  } catch (...) {
    remove_empty();
    throw;
  }
}

OutputFolder::~OutputFolder() {
  remove_empty();
}

void OutputFolder::prove_writable() const {
  const fs::path probe = hidden_name_beside(path_ / "probe");
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    throw Error(fmt::format("the output folder cannot be written to: {}", reason_of(errno)), path_.string(),
                "name a folder you may write to");
  }
  close(descriptor);
  unlink(probe.c_str());
}

void OutputFolder::remove_empty() noexcept {
  if (first_made_.empty()) return;
  std::error_code stop;
  fs::path folder = fs::absolute(path_, stop).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  // rmdir leaves what is not empty: results that were written stay.
  for (; rmdir(folder.c_str()) == 0 || errno == ENOENT; folder = folder.parent_path()) {
    if (folder == first_made_ || folder == folder.root_path()) break;
  }
}

}  // namespace limen
