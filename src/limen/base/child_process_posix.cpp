// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/child_process.h"
#include "limen/base/text.h"

namespace limen {
namespace {

/// What the child may take, worked out beforehand: between fork and exec hardly anything may be called.
struct Bounds {
  rlimit memory{};
  rlimit cpu{};
};

/// A bound of the system's; nobody may ask for more than was given to us.
rlimit within_own(int resource, double wanted) {
  rlimit own{RLIM_INFINITY, RLIM_INFINITY};
  getrlimit(static_cast<__rlimit_resource_t>(resource), &own);
  if (wanted <= 0.0) return own;
  const rlim_t most = std::min(static_cast<rlim_t>(std::ceil(wanted)), own.rlim_max);
  return {most, most};
}

/// In the child, before the program runs: its ends, its bounds, and that it dies with us. Calls only what may
/// be called after a fork of a process with threads.
[[noreturn]] void become(char* const* words, const ChildOptions& options, const Bounds& bounds,
                         pid_t parent) {
  // A process group of its own: the terminal's interrupt reaches limen, which then stops the child.
  setpgid(0, 0);
  const rlimit none{0, 0};
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  const int input = options.input < 0 ? nowhere : options.input;
  const int output = options.output < 0 ? nowhere : options.output;
  const bool ready = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && setrlimit(RLIMIT_CPU, &bounds.cpu) == 0 &&
                     setrlimit(RLIMIT_CORE, &none) == 0 && dup2(input, STDIN_FILENO) >= 0 &&
                     dup2(output, STDOUT_FILENO) >= 0 && dup2(nowhere, STDERR_FILENO) >= 0 &&
                     setrlimit(RLIMIT_AS, &bounds.memory) == 0;
  // Whoever dies before we asked for its end is no parent any more.
  if (ready && getppid() == parent) execve(words[0], words, environ);
  _exit(ChildProcess::kNotStarted);
}

}  // namespace

struct ChildProcess::Handles {
  pid_t id = -1;
  int status = 0;
  bool ended = false;
};

ChildProcess::ChildProcess(const std::vector<std::string>& words, const ChildOptions& options)
    : handles_(new Handles) {
  std::vector<std::string> own_words = words;
  const std::vector<char*> pointers = exec_pointers(own_words);
  const Bounds bounds{within_own(RLIMIT_AS, options.memory_bytes), within_own(RLIMIT_CPU, options.cpu_s)};
  const pid_t parent = getpid();
  handles_->id = fork();
  if (handles_->id == 0) become(pointers.data(), options, bounds, parent);
  if (handles_->id < 0) problem_ = reason_of(errno);
}

ChildProcess::~ChildProcess() {
  if (problem_.empty()) {
    kill();
    wait();
  }
  delete handles_;
}

void ChildProcess::kill() {
  ::kill(-handles_->id, SIGKILL);
  if (!handles_->ended) ::kill(handles_->id, SIGKILL);
}

bool ChildProcess::ended() {
  handles_->ended = handles_->ended || waitpid(handles_->id, &handles_->status, WNOHANG) == handles_->id;
  return handles_->ended;
}

ChildEnd ChildProcess::wait() {
  while (!handles_->ended && waitpid(handles_->id, &handles_->status, 0) < 0 && errno == EINTR) {
  }
  handles_->ended = true;
  const int status = handles_->status;
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return {false, 0, fmt::format("was ended by signal {} ({})", signal, strsignal(signal))};
  }
  return {true, WEXITSTATUS(status), fmt::format("ended with status {}", WEXITSTATUS(status))};
}

}  // namespace limen
