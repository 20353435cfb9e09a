// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/child_process.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/cli/terminal/progress_pipe.h"
#include "limen/files/text_numbers.h"

extern char** environ;

namespace limen {
namespace {

constexpr std::size_t kMostSaid = 8000;
constexpr std::size_t kLongestLine = 4096;
constexpr int kNotStarted = 127;
/// Numbers of descriptors from here on clash with none that the child gets.
constexpr int kAboveOurs = 10;

[[noreturn]] void cannot_run(const char* what) {
  throw Error(fmt::format("{}: {}", what, reason_of(errno)), "limen serve", "check the machine's limits",
              Fault::internal);
}

/// The reading and the writing end, which no other child inherits; neither waits.
struct Pipe {
  int read = -1;
  int write = -1;

  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) cannot_run("no pipe can be created");
    read = ends[0];
    write = fcntl(ends[1], F_DUPFD_CLOEXEC, kAboveOurs);
    close(ends[1]);
    if (write < 0) cannot_run("no pipe can be created");
  }
};

std::vector<std::string> environment_with_progress() {
  std::vector<std::string> all;
  const std::string own = std::string(kProgressVariable) + "=";
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (std::string_view(*entry).substr(0, own.size()) != own) all.emplace_back(*entry);
  }
  all.push_back(fmt::format("{}{}", own, STDERR_FILENO + 1));
  return all;
}

/// In the child. Calls only what may be called after a fork of a process with threads.
[[noreturn]] void become_limen(const char* program, char* const* words, char* const* environment,
                               const char* folder, int output, int progress, pid_t parent) {
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDONLY);
  struct sigaction usual = {};
  usual.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaction(signal, &usual, nullptr);
  // What is said may wait for a reader; progress may not.
  fcntl(output, F_SETFL, fcntl(output, F_GETFL) & ~O_NONBLOCK);
  const bool ready = prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && dup2(nothing, STDIN_FILENO) >= 0 &&
                     dup2(output, STDOUT_FILENO) >= 0 && dup2(output, STDERR_FILENO) >= 0 &&
                     dup2(progress, STDERR_FILENO + 1) >= 0 && chdir(folder) == 0;
  // Whoever dies before we asked for its end is no parent any more.
  if (ready && getppid() == parent) execve(program, words, environment);
  _exit(kNotStarted);
}

void close_end(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// Appends what there is; false once the other end is closed.
bool read_waiting(int descriptor, std::string& text) {
  std::array<char, 4096> piece{};
  for (;;) {
    const ssize_t got = read(descriptor, piece.data(), piece.size());
    if (got > 0) text.append(piece.data(), static_cast<std::size_t>(got));
    if (got == 0) return false;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno == EAGAIN;
  }
}

}  // namespace

Child::Child(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  std::vector<std::string> words = {"limen"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = environment_with_progress();
  const std::vector<char*> word_pointers = exec_pointers(words);
  const std::vector<char*> environment_pointers = exec_pointers(environment);
  const char* starter = program_starter();
  const char* program = starter != nullptr ? starter : "/proc/self/exe";
  Pipe output;
  Pipe progress;
  output_ = output.read;
  progress_ = progress.read;
  const pid_t parent = getpid();
  id_ = fork();
  if (id_ == 0)
    become_limen(program, word_pointers.data(), environment_pointers.data(), folder.c_str(), output.write,
                 progress.write, parent);
  close_end(output.write);
  close_end(progress.write);
  if (id_ < 0) {
    close_end(output_);
    close_end(progress_);
    cannot_run("no process can be created");
  }
  setpgid(id_, id_);
}

Child::~Child() {
  if (!ended()) {
    kill(-id_, SIGKILL);
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  close_end(output_);
  close_end(progress_);
}

void Child::listen() {
  if (output_ >= 0 && !read_waiting(output_, said_)) close_end(output_);
  if (said_.size() > kMostSaid) said_.erase(0, said_.size() - kMostSaid);
  hear_progress();
}

void Child::hear_progress() {
  if (progress_ < 0) return;
  const bool open = read_waiting(progress_, unread_);
  for (std::size_t end = unread_.find('\n'); end != std::string::npos; end = unread_.find('\n')) {
    const std::string_view line = std::string_view(unread_).substr(0, end);
    const std::size_t tab = line.find('\t');
    stage_ = line.substr(0, tab);
    const std::optional<double> share =
        tab == std::string_view::npos ? std::nullopt : parse_number(line.substr(tab + 1));
    share_ = share ? std::clamp(*share, 0.0, 1.0) : -1.0;
    unread_.erase(0, end + 1);
  }
  if (unread_.size() > kLongestLine) unread_.clear();
  if (!open) close_end(progress_);
}

void Child::stop() {
  if (!ended()) kill(asked_ ? -id_ : id_, asked_ ? SIGKILL : SIGTERM);
  asked_ = true;
}

std::optional<int> Child::ended() {
  if (status_ || id_ < 0) return status_;
  int status = 0;
  if (waitpid(id_, &status, WNOHANG) != id_) return std::nullopt;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  listen();
  return status_;
}

std::vector<int> Child::ears() const {
  std::vector<int> open;
  for (const int ear : {output_, progress_}) {
    if (ear >= 0) open.push_back(ear);
  }
  return open;
}

}  // namespace limen
