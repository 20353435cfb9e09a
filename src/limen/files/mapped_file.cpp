// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/mapped_file.h"

#include <cerrno>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/readable.h"

namespace limen {
namespace {

class Descriptor {
 public:
  explicit Descriptor(const std::string& name) : value_(open(name.c_str(), O_RDONLY | O_CLOEXEC)) {
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
  const Descriptor file(name);
  struct stat status {};
  if (fstat(file.value(), &status) != 0) {
    throw Error("cannot be examined: " + reason_of(errno), name, "check the path and its permissions");
  }
  if (S_ISDIR(status.st_mode)) throw Error("is a folder, not a file", name, "name the file in it");
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    const int kept = fcntl(file.value(), F_DUPFD_CLOEXEC, 0);
    if (kept >= 0) mapping_ = std::make_unique<const GuardedMapping>(kept, size_, name);
    if (mapping_) data_ = mapping_->data();
  }
  if (data_ == nullptr) read_stream(file.value(), name);
  if (size_ == 0) throw Error("the file is empty", name, "check how it was written or copied");
}

void MappedFile::read_stream(int descriptor, const std::string& name) {
  constexpr std::size_t kStreamPiece = std::size_t{1} << 20U;
  for (;;) {
    const std::size_t before = read_.size();
    read_.resize(before + kStreamPiece);
    const ssize_t got = read(descriptor, read_.data() + before, kStreamPiece);
    if (got < 0 && errno != EINTR) {
      throw Error("cannot be read: " + reason_of(errno), name, "check the file and its disk");
    }
    read_.resize(before + (got > 0 ? static_cast<std::size_t>(got) : 0));
    if (got == 0) break;
  }
  data_ = read_.data();
  size_ = read_.size();
}

}  // namespace limen
