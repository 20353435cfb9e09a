// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "run_program.h"
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace limen {

/// The program at work on a folder; ended with the object.
class RunningServer {
 public:
  RunningServer(const std::filesystem::path& work, const std::string& folder) : said_(work / "said") {
    const std::string program = LIMEN_PROGRAM;
    std::filesystem::remove(said_);  // an earlier server's words are not this one's
    id_ = fork();
    if (id_ == 0) {
      const int said = open(said_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      dup2(said, STDOUT_FILENO);
      dup2(said, STDERR_FILENO);
      if (chdir(work.c_str()) == 0)
        execl(program.c_str(), program.c_str(), "serve", folder.c_str(), "--most-upload", "1M", nullptr);
      _exit(127);
    }
    for (int k = 0; k < 500 && token_.empty(); ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const std::string text = read_whole(said_);
      const std::size_t at = text.find("http://127.0.0.1:");
      if (at == std::string::npos || text.find('\n', at) == std::string::npos) continue;
      std::istringstream words(text.substr(at + 17));
      char slash = 0;
      words >> port_ >> slash >> token_;
      token_.pop_back();
    }
  }
  ~RunningServer() {
    if (id_ > 0) kill(id_, SIGKILL);
    if (id_ > 0) waitpid(id_, nullptr, 0);
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  [[nodiscard]] int connected() const {
    const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    EXPECT_EQ(connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    return descriptor;
  }

  /// All that is answered to these bytes.
  [[nodiscard]] std::string say(const std::string& bytes) const {
    const int descriptor = connected();
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t sent = send(descriptor, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) break;
      at += static_cast<std::size_t>(sent);
    }
    const std::string answer = rest_of(descriptor);
    close(descriptor);
    return answer;
  }

  static std::string rest_of(int descriptor) {
    std::string answer;
    char piece[4096];
    for (pollfd wanted = {descriptor, POLLIN, 0}; poll(&wanted, 1, 20000) > 0;) {
      const ssize_t got = recv(descriptor, piece, sizeof piece, 0);
      if (got <= 0) break;
      answer.append(piece, static_cast<std::size_t>(got));
    }
    return answer;
  }

  [[nodiscard]] std::string host() const { return "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n"; }

  /// A request as our page makes it, below the token.
  [[nodiscard]] std::string ask(const std::string& method, const std::string& path,
                                const std::string& body = "", const std::string& more = "") const {
    return say(method + " /" + token_ + "/" + path + " HTTP/1.1\r\n" + host() +
               "Content-Length: " + std::to_string(body.size()) + "\r\n" + more + "\r\n" + body);
  }

  /// What `state` tells once `words` stand in it.
  std::string state_with(const std::string& words) const {
    std::string state;
    for (int k = 0; k < 600; ++k) {
      state = ask("GET", "state");
      if (state.find(words) != std::string::npos) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ADD_FAILURE() << words << " was not reported: " << state;
    return state;
  }

  int end(int signal) {
    kill(id_, signal);
    int status = 0;
    waitpid(id_, &status, 0);
    id_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::string said() const { return read_whole(said_); }

 private:
  std::filesystem::path said_;
  pid_t id_ = -1;
  int port_ = 0;
  std::string token_;
};

inline int status_in(const std::string& answer) {
  return answer.rfind("HTTP/1.1 ", 0) == 0 ? std::stoi(answer.substr(9)) : 0;
}

class ServeTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    server_ = std::make_unique<RunningServer>(work(), "site");
    ASSERT_EQ(server_->token().size(), 32U) << server_->said();
  }
  void TearDown() override {
    server_.reset();
    ProgramTest::TearDown();
  }
  [[nodiscard]] RunningServer& server() const { return *server_; }

 private:
  std::unique_ptr<RunningServer> server_;
};

}  // namespace limen
