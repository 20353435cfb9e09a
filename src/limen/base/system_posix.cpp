// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <dlfcn.h>
#include <fcntl.h>
#include <math.h>  // lgamma_r
#include <poll.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "limen/base/system.h"

namespace limen {
namespace fs = std::filesystem;

int open_to_read(const fs::path& path) {
  return open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
}

int open_to_write(const fs::path& path) {
  // Without waiting for the reader of a named pipe: there is one, or it is an error.
  const int descriptor = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor >= 0) fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return descriptor;
}

int make_file(const fs::path& path) {
  return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

int make_nameless_file() {
  std::FILE* file = std::tmpfile();
  if (file == nullptr) return -1;
  const int descriptor = duplicate(fileno(file));
  std::fclose(file);
  return descriptor;
}

int open_nowhere() {
  return open("/dev/null", O_RDWR | O_CLOEXEC);
}

std::ptrdiff_t read_some(int descriptor, char* bytes, std::size_t size) {
  return ::read(descriptor, bytes, size);
}

std::ptrdiff_t write_some(int descriptor, std::string_view bytes) {
  return ::write(descriptor, bytes.data(), bytes.size());
}

std::ptrdiff_t write_at(int descriptor, std::string_view bytes, std::uint64_t offset) {
  return pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
}

bool flush_to_disk(int descriptor) {
  return fsync(descriptor) == 0;
}

void keep_bytes(int /*descriptor*/) {}

int duplicate(int descriptor) {
  return fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

bool keep_from_children(int descriptor) {
  return fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0;
}

bool hold(int descriptor) {
  struct stat status {};
  const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  return locked && fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

void remove_unless_held(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  const bool ours = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
                    status.st_uid == geteuid() && status.st_nlink == 1;
  if (ours && flock(descriptor, LOCK_EX | LOCK_NB) == 0) unlink(path.c_str());
  close(descriptor);
}

bool rename_over(const fs::path& from, const fs::path& to) {
  return std::rename(from.c_str(), to.c_str()) == 0;
}

fs::path make_scratch_folder(const fs::path& beginning) {
  std::string made = beginning.string() + "-XXXXXX";
  return mkdtemp(made.data()) == nullptr ? fs::path() : fs::path(made);
}

unsigned mode_of(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode : 0;
}

bool may_read(const fs::path& path) {
  return access(path.c_str(), R_OK) == 0;
}

bool may_run(const fs::path& path) {
  std::error_code ignored;
  return !path.empty() && access(path.c_str(), X_OK) == 0 && fs::is_regular_file(path, ignored);
}

fs::path own_program() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored);
}

fs::path own_library() {
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&own_library), &here) == 0 || here.dli_fname == nullptr) return {};
  std::error_code ignored;
  return fs::weakly_canonical(here.dli_fname, ignored);
}

std::vector<fs::path> program_folders() {
  const char* path = std::getenv("PATH");
  const std::string all = path == nullptr ? "/usr/bin:/bin" : path;
  std::vector<fs::path> folders;
  for (std::size_t at = 0; at <= all.size();) {
    const std::size_t end = std::min(all.find(':', at), all.size());
    folders.emplace_back(all.substr(at, end - at));
    at = end + 1;
  }
  return folders;
}

std::string_view program_ending() {
  return {};
}

bool end_with_parent(const std::string& number) {
  // Whoever died before we asked for its end is no parent any more.
  return prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || std::to_string(getppid()) == number;
}

bool is_administrator() {
  return geteuid() == 0;
}

void after_fork(void (*action)()) {
  pthread_atfork(nullptr, nullptr, action);
}

std::optional<PipeEnds> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  return PipeEnds{ends[0], ends[1]};
}

bool wait_to_read(int descriptor, int milliseconds) {
  pollfd wanted{descriptor, POLLIN, 0};
  return poll(&wanted, 1, milliseconds) > 0;
}

double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

void* load_library(const char* name) {
  return ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
}

void* function_in(void* library, const char* name) {
  return ::dlsym(library, name);
}

}  // namespace limen
