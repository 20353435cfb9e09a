// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <deque>
#include <mutex>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"
#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

constexpr std::string_view kMark = ".limen-";
constexpr std::string_view kEnding = ".part";

/// Beside the destination, so that the rename stays within one file system; unique in this machine.
fs::path hidden_name_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  constexpr std::size_t kMostOfName = 200;  // bytes: file systems take 255
  const std::string name = fmt::format(".{}{}{}-{}{}", path.filename().string().substr(0, kMostOfName), kMark,
                                       getpid(), counter++, kEnding);
  return path.parent_path() / name;
}

/// Whether hidden_name_beside() makes such names: .NAME.limen-12-0.part
bool is_hidden_name(std::string_view name) {
  if (name.size() < kEnding.size() || name.front() != '.') return false;
  if (name.substr(name.size() - kEnding.size()) != kEnding) return false;
  name.remove_suffix(kEnding.size());
  const std::size_t mark = name.rfind(kMark);
  if (mark == std::string_view::npos || mark < 2) return false;
  const std::string_view numbers = name.substr(mark + kMark.size());
  const std::size_t dash = numbers.find('-');
  const auto count = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return dash != std::string_view::npos && count(numbers.substr(0, dash)) && count(numbers.substr(dash + 1));
}

/// Once for each folder: a process looks only for what others left behind.
void remove_left_behind(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  std::error_code stop;
  const std::string name = fs::weakly_canonical(folder.empty() ? "." : folder, stop).string();
  {
    const std::scoped_lock lock(mutex);
    if (stop || !seen.insert(name).second) return;
  }
  fs::directory_iterator entry(name, stop);
  for (; !stop && entry != fs::directory_iterator(); entry.increment(stop)) {
    if (is_hidden_name(entry->path().filename().string())) remove_unless_held(entry->path());
  }
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)) {
  if (path_.empty()) throw Error("the file to write has no name", "", "name a file to write to");
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
  if (replace) {
    remove_left_behind(path_.parent_path());
    open_beside();
  } else {
    descriptor_ = open_to_write(path_);
  }
  if (descriptor_ < 0) {
    beside_.clear();
    if (fs::is_fifo(status))
      throw Error("is a named pipe that no program reads", path_.string(), "begin to read it first");
    fail("cannot be written");
  }
}

/// The hidden file, locked. Between its making and its locking another process may take it for one that was
/// left behind: then the lock is not to be had, or the name is gone, and another file is made.
void AtomicFile::open_beside() {
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    beside_ = hidden_name_beside(path_);
    descriptor_ = make_file(beside_);
    if (descriptor_ < 0 || hold(descriptor_)) return;
    close_quietly();
    errno = EBUSY;
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
    const std::ptrdiff_t written = write_at(descriptor_, bytes, offset);
    if (written < 0 && errno != EINTR) fail("cannot be written");
    if (written <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void AtomicFile::settle() {
  flush();
  if (!beside_.empty() && !flush_to_disk(descriptor_)) fail("cannot be flushed to the disk");
}

void AtomicFile::commit() {
  settle();
  require_inputs_whole();
  // While it is held: nobody may take it for one that was left behind.
  if (kRenamesHeldFiles) take_final_name();
  if (close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written");
  take_final_name();
}

void AtomicFile::take_final_name() {
  if (beside_.empty()) return;
  if (!rename_over(beside_, path_)) fail("cannot be renamed to its final name");
  beside_.clear();
}

void AtomicFile::fail(const char* doing) const {
  throw Error(fmt::format("{}: {}", doing, reason_of(errno)), path_.string(),
              "give a path in an existing folder with free space and write permission");
}

void AtomicFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const std::ptrdiff_t written = write_some(descriptor_, rest);
    if (written < 0 && errno != EINTR) fail("cannot be written");
    if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void AtomicFile::close_quietly() noexcept {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  std::error_code ignored;
  if (!beside_.empty()) fs::remove(beside_, ignored);
}

void write_file(const fs::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void write_files(const std::vector<FileToWrite>& files) {
  std::deque<AtomicFile> open;
  for (const FileToWrite& file : files) {
    open.emplace_back(file.path).write(file.bytes);
    open.back().settle();
  }
  for (AtomicFile& file : open) file.commit();
}

OutputFolder::OutputFolder(fs::path path) : path_(std::move(path)) {
  if (path_.empty()) throw Error("the output folder has no name", "", "name a folder to write to");
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
    throw Error(
        fmt::format("the output folder cannot be created: {}", error ? error.message() : "not a folder"),
        path_.string(), "give a folder that exists or can be created");
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
  remove_left_behind(path_);
  const fs::path probe = hidden_name_beside(path_ / "probe");
  const int descriptor = make_file(probe);
  if (descriptor < 0) {
    throw Error(fmt::format("the output folder cannot be written to: {}", reason_of(errno)), path_.string(),
                "give a folder with write permission");
  }
  close(descriptor);
  std::error_code ignored;
  fs::remove(probe, ignored);
}

void OutputFolder::remove_empty() noexcept {
  if (first_made_.empty()) return;
  std::error_code stop;
  fs::path folder = fs::absolute(path_, stop).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  // What is not empty is left: results that were written stay.
  for (; fs::is_directory(folder, stop) || !fs::exists(folder, stop); folder = folder.parent_path()) {
    fs::remove(folder, stop);
    if (stop || folder == first_made_ || folder == folder.root_path()) break;
  }
}

}  // namespace limen
