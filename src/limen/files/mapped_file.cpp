// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/files/mapped_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/error.h"

namespace limen {
namespace {

std::string reason_of(int error_number) {
  return std::generic_category().message(error_number);
}

class Descriptor {
 public:
  explicit Descriptor(const std::string& name) : value_(open(name.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (value_ >= 0) return;
    const int reason = errno;
    if (reason == ENOENT || reason == ENOTDIR) throw Error("there is no such file", name, "check the path");
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
  if (S_ISREG(status.st_mode)) {
    size_ = static_cast<std::size_t>(status.st_size);
    if (size_ > 0) {
      void* address = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.value(), 0);
      mapped_ = address != MAP_FAILED;
      if (mapped_) {
        data_ = static_cast<const char*>(address);
        madvise(address, size_, MADV_SEQUENTIAL);  // advice only: no harm where it is not taken
      }
    }
  }
  if (!mapped_) read_stream(file.value(), name);
  if (size_ == 0) throw Error("the file is empty", name, "check how it was written or copied");
}

MappedFile::~MappedFile() {
  if (mapped_) munmap(const_cast<char*>(data_), size_);
}

void MappedFile::forget() const {
  if (mapped_) madvise(const_cast<char*>(data_), size_, MADV_DONTNEED);
}

void MappedFile::read_stream(int descriptor, const std::string& name) {
  constexpr std::size_t kPiece = std::size_t{1} << 20U;
  for (;;) {
    const std::size_t before = read_.size();
    read_.resize(before + kPiece);
    const ssize_t got = read(descriptor, read_.data() + before, kPiece);
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
