// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "limen/base/child_process.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/project/engine/helper_process.h"

namespace limen {
namespace {

/// In the child; calls only what may be called after a fork of a process with threads.
[[noreturn]] void become_helper(char* const* words, int socket, int log) {
  // A process group of its own: the terminal's interrupt reaches limen, which then ends its stdin.
  setpgid(0, 0);
  if (dup2(socket, STDIN_FILENO) >= 0 && dup2(socket, STDOUT_FILENO) >= 0 && dup2(log, STDERR_FILENO) >= 0)
    execvp(words[0], words);
  constexpr int kNotStarted = 127;
  _exit(kNotStarted);
}

[[noreturn]] void helper_fails(const std::string& program) {
  throw Error("cannot be started: " + reason_of(errno), program, "free some memory, or end other programs");
}

}  // namespace

HelperProcess::HelperProcess(const std::vector<std::string>& command, const std::string& log) {
  std::vector<std::string> words = command;
  const std::vector<char*> pointers = exec_pointers(words);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) helper_fails(command.front());
  const int errors = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const int nowhere = errors >= 0 ? errors : open("/dev/null", O_WRONLY | O_CLOEXEC);
  id_ = fork();
  if (id_ == 0) become_helper(pointers.data(), ends[1], nowhere);
  close(ends[1]);
  close(nowhere);
  socket_ = ends[0];
  if (id_ < 0) {
    close(socket_);
    helper_fails(command.front());
  }
}

HelperProcess::~HelperProcess() {
  close(socket_);
  constexpr int kPatience = 100;
  for (int i = 0; i < kPatience; ++i) {
    if (waitpid(id_, nullptr, WNOHANG) == id_) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  kill(-id_, SIGKILL);
  kill(id_, SIGKILL);
  while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool HelperProcess::say(const std::string& line) {
  std::string text = line;
  text += '\n';
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t sent = send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR) return false;
    if (sent > 0) rest.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

std::optional<std::string> HelperProcess::hear(int milliseconds) {
  for (;;) {
    const std::size_t end = received_.find('\n');
    if (end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return line;
    }
    if (ended_) return {};
    pollfd wanted{socket_, POLLIN, 0};
    if (poll(&wanted, 1, milliseconds) <= 0) return {};
    std::array<char, 65536> piece{};
    const ssize_t got = recv(socket_, piece.data(), piece.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      ended_ = true;
      return {};
    }
    received_.append(piece.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace limen
