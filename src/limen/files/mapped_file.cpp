// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/mapped_file.h"

#include <cerrno>

#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/system.h"
#include "limen/base/text.h"
#include "limen/files/readable.h"
#include "limen/files/vendor_format.h"

namespace limen {
namespace {

class Descriptor {
 public:
  /// Does not wait for who writes to a pipe.
  explicit Descriptor(const std::string& name) : value_(open_to_read(name)) {
    if (value_ >= 0) return;
    const int reason = errno;
    if (reason == ENOENT || reason == ENOTDIR) throw missing_file(name);
    throw Error("cannot be opened: " + reason_of(reason), name, "check the path and its permissions");
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(path, ignored);
  if (folder) refuse_vendor_format({}, path);
  if (folder) throw Error(why_no_file(S_IFDIR), name, "name the file in it");
  const Descriptor file(name);
  struct stat status {};
  if (fstat(file.value(), &status) != 0) {
    throw Error("cannot be examined: " + reason_of(errno), name, "check the path and its permissions");
  }
  if (const std::string other = why_no_file(status.st_mode); !other.empty())
    throw Error(other, name, "write it to a file, and name that");
  if (status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    const int kept = duplicate(file.value());
    if (kept >= 0) mapping_ = std::make_unique<const GuardedMapping>(kept, size_, name);
    if (mapping_) data_ = mapping_->data();
  }
  if (data_ == nullptr) read_whole(file.value(), name);
  if (size_ == 0) throw Error("the file is empty", name, "check how it was written or copied");
}

void MappedFile::read_whole(int descriptor, const std::string& name) {
  read_.resize(size_);
  std::size_t there = 0;
  while (there < size_) {
    const std::ptrdiff_t got = read_some(descriptor, read_.data() + there, size_ - there);
    if (got < 0 && errno != EINTR)
      throw Error("cannot be read: " + reason_of(errno), name, "check the file and its disk");
    if (got == 0) break;
    there += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  read_.resize(there);
  data_ = read_.data();
  size_ = read_.size();
}

}  // namespace limen
