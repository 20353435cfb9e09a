// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
// limen serve as a program meets it that does not mean well: who is let in, what can be reached, what is too
// much, and how it ends. What a browser does with its page is in tests/browser/serve_test.mjs.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "run_program.h"
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "limen/base/random.h"

namespace limen {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

/// The program at work on a folder; ended with the object.
class RunningServer {
 public:
  RunningServer(const fs::path& work, const std::string& folder) : said_(work / "said") {
    const std::string program = LIMEN_PROGRAM;
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
    ADD_FAILURE() << words << " was not told: " << state;
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
  fs::path said_;
  pid_t id_ = -1;
  int port_ = 0;
  std::string token_;
};

int status_in(const std::string& answer) {
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

TEST_F(ServeTest, LetsInOnlyWhoKnowsTheAddress) {
  EXPECT_EQ(status_in(server().ask("GET", "")), 200);
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  EXPECT_EQ(status_in(server().say("GET / HTTP/1.1\r\n" + server().host() + "\r\n")), 404);
  EXPECT_EQ(status_in(server().say("GET /state HTTP/1.1\r\n" + server().host() + "\r\n")), 404);
  EXPECT_EQ(status_in(server().say("GET /" + std::string(32, '0') + "/state HTTP/1.1\r\n" + server().host() +
                                   "\r\n")),
            404);
  EXPECT_EQ(
      status_in(server().say("GET /" + server().token() + "/state HTTP/1.1\r\nHost: evil.example\r\n\r\n")),
      403);
  EXPECT_EQ(status_in(server().say("GET /" + server().token() + "/state HTTP/1.1\r\n\r\n")), 403);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", "{}", "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status_in(server().ask("PUT", "files/a", "x", "Sec-Fetch-Site: cross-site\r\n")), 403);
  EXPECT_FALSE(fs::exists(work() / "site" / "files" / "a"));
}

TEST_F(ServeTest, ListensOnThisMachineAlone) {
  // The kernel's own list: the address 127.0.0.1, as it writes it, and in no other line that port.
  char port[8];
  std::snprintf(port, sizeof port, ":%04X", server().port());
  std::istringstream table(read_whole("/proc/net/tcp"));
  int listening = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    words >> number >> local >> remote >> state;
    if (state != "0A" || local.size() < 5 || local.substr(local.size() - 5) != port) continue;
    ++listening;
    EXPECT_EQ(local, std::string("0100007F") + port);
  }
  EXPECT_EQ(listening, 1);
}

TEST_F(ServeTest, NothingButItsFilesCanBeReached) {
  write_whole(work() / "secret", "the secret");
  write_whole(work() / "site" / "files" / "a.ply", "of a file");
  fs::create_symlink(work() / "secret", work() / "site" / "files" / "link");
  fs::create_directories(work() / "site" / "results" / "1" / "store");
  write_whole(work() / "site" / "results" / "1" / "store" / "x", "the secret");
  fs::create_directory_symlink(work(), work() / "site" / "results" / "7");
  EXPECT_NE(server().ask("GET", "files/a.ply").find("of a file"), std::string::npos);
  for (const std::string path : {"files/../../secret",
                                 "files/..%2f..%2fsecret",
                                 "files/%2e%2e/%2e%2e/secret",
                                 "../secret",
                                 "files/link",
                                 "results/../secret",
                                 "results/1/../../../secret",
                                 "results/1/store",
                                 "results/1/store/x",
                                 "results/1/store%2fx",
                                 "results/7/secret",
                                 "results/-1/x",
                                 "results/1x/x",
                                 "files//a.ply",
                                 "files/",
                                 "files",
                                 "results",
                                 "secret",
                                 "files/.",
                                 "files/..",
                                 "files/%00",
                                 "files/a.ply%00.txt",
                                 "results/99999999999999999999/x"}) {
    const std::string answer = server().ask("GET", path);
    EXPECT_GE(status_in(answer), 400) << path;
    EXPECT_EQ(answer.find("the secret"), std::string::npos) << path;
  }
  EXPECT_GE(status_in(server().ask("DELETE", "files/..%2fresults")), 400);
  EXPECT_GE(status_in(server().ask("DELETE", "files/link")), 400);
  EXPECT_TRUE(fs::exists(work() / "secret"));
  EXPECT_EQ(status_in(server().ask("DELETE", "files/a.ply")), 200);
  EXPECT_FALSE(fs::exists(work() / "site" / "files" / "a.ply"));
}

TEST_F(ServeTest, UploadsHaveBoundsAndAppearWhole) {
  const std::string bytes(300000, 'a');
  EXPECT_EQ(status_in(server().ask("PUT", "files/a.bin", bytes)), 201);
  EXPECT_EQ(read_whole(work() / "site" / "files" / "a.bin"), bytes);
  EXPECT_EQ(status_in(server().ask("PUT", "files/a.bin", "other")), 409);
  EXPECT_EQ(status_in(server().ask("PUT", "files/large.bin", std::string(1000001, 'b'))), 413);
  EXPECT_EQ(status_in(server().ask("PUT", "files/b%20c.bin", "x")), 400);
  EXPECT_EQ(status_in(server().ask("PUT", "results/1/x", "x")), 405);
  EXPECT_EQ(status_in(server().say("PUT /" + server().token() + "/files/c.bin HTTP/1.1\r\n" +
                                   server().host() + "\r\n")),
            411);
  // Who goes in the middle leaves nothing.
  const int descriptor = server().connected();
  const std::string half = "PUT /" + server().token() + "/files/half.bin HTTP/1.1\r\n" + server().host() +
                           "Content-Length: 1000\r\n\r\nonly this";
  ASSERT_EQ(send(descriptor, half.data(), half.size(), MSG_NOSIGNAL), static_cast<ssize_t>(half.size()));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  close(descriptor);
  server().state_with("a.bin");
  for (int k = 0; k < 100 && std::distance(fs::directory_iterator(work() / "site" / "files"), {}) > 1; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(std::distance(fs::directory_iterator(work() / "site" / "files"), {}), 1);
  EXPECT_EQ(status_in(server().ask("POST", "jobs", std::string(70000, ' '))), 413);
}

TEST_F(ServeTest, WorkIsMadeOfItsOwnFilesAlone) {
  write_whole(work() / "site" / "files" / "a.xyz", "0 0 0\n");
  for (const std::string work_asked :
       {"", "x", "[]", "{}", R"({"kind": 1})", R"({"kind": "simulate"})", R"({"kind": "register"})",
        R"({"kind": "register", "source": "a.xyz", "target": "a.xyz"})",
        R"({"kind": "register", "source": "a.xyz", "target": "../a.xyz"})",
        R"({"kind": "register", "source": "a.xyz", "target": "--help"})",
        R"({"kind": "project", "files": []})", R"({"kind": "project", "files": ["missing"]})",
        R"({"kind": "project", "files": "a.xyz"})", R"({"kind": "view", "files": [7]})",
        R"({"kind": "view", "of": 5})", R"({"kind": "again", "of": "x"})", R"({"kind": "place", "of": -1})",
        R"({"kind": "decide", "of": 1e99})"}) {
    const int status = status_in(server().ask("POST", "jobs", work_asked));
    EXPECT_TRUE(status >= 400 && status < 500) << work_asked << " " << status;
  }
  EXPECT_EQ(status_in(server().ask("POST", "jobs/1/stop")), 404);
  EXPECT_NE(server().ask("GET", "state").find("\"jobs\": []"), std::string::npos);
}

TEST_F(ServeTest, WorkIsDoneAndFoundAgainByTheNext) {
  ASSERT_EQ(run({"simulate", "room", "-o", "room", "--points-indoor", "2000"}).status, 0);
  for (const std::string name : {"indoor_00.ply", "indoor_01.ply"})
    EXPECT_EQ(status_in(server().ask("PUT", "files/" + name, read_whole(work() / "room" / name))), 201);
  const std::string asked = R"({"kind": "register", "source": "indoor_00.ply", "target": "indoor_01.ply"})";
  EXPECT_EQ(status_in(server().ask("POST", "jobs", asked)), 202);
  EXPECT_NE(server().state_with("\"state\": \"done\"").find("result.json"), std::string::npos);
  EXPECT_EQ(server().ask("GET", "results/1/result.json").substr(0, 12), "HTTP/1.1 200");
  const std::string report = server().ask("GET", "results/1/report.html");
  EXPECT_NE(report.find("Content-Security-Policy: sandbox"), std::string::npos);
  EXPECT_EQ(server().end(SIGINT), 0);
  EXPECT_NE(server().said().find("ended"), std::string::npos);
  const RunningServer next(work(), "site");
  EXPECT_NE(next.ask("GET", "state").find("indoor_00.ply into indoor_01.ply"), std::string::npos);
  EXPECT_NE(next.token(), server().token());
}

TEST_F(ServeTest, WhatRunsEndsWithIt) {
  // Work that by itself would not end within the test.
  write_whole(work() / "endless",
              "#!/bin/sh\necho $$ > \"" + (work() / "job").string() + "\"\nexec sleep 600\n");
  fs::permissions(work() / "endless", fs::perms::owner_all);
  setenv("LIMEN_PROGRAM_FILE", (work() / "endless").c_str(), 1);
  RunningServer endless(work(), "other");
  unsetenv("LIMEN_PROGRAM_FILE");
  ASSERT_EQ(endless.token().size(), 32U) << endless.said();
  for (const std::string name : {"a.xyz", "b.xyz"}) write_whole(work() / "other" / "files" / name, "0 0 0\n");
  const std::string asked = R"({"kind": "register", "source": "a.xyz", "target": "b.xyz"})";
  EXPECT_EQ(status_in(endless.ask("POST", "jobs", asked)), 202);
  EXPECT_EQ(status_in(endless.ask("POST", "jobs", asked)), 202);
  endless.state_with("\"state\": \"running\"");
  EXPECT_EQ(status_in(endless.ask("DELETE", "files/b.xyz")), 409);
  for (int k = 0; k < 600 && read_whole(work() / "job").find('\n') == std::string::npos; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const pid_t job = std::stoi(read_whole(work() / "job"));
  EXPECT_EQ(kill(job, 0), 0);
  EXPECT_EQ(endless.end(SIGTERM), 0);
  EXPECT_EQ(kill(job, 0), -1);
  EXPECT_NE(read_whole(work() / "other" / "results" / "1.json").find("\"stopped\""), std::string::npos);
  EXPECT_NE(read_whole(work() / "other" / "results" / "2.json").find("\"stopped\""), std::string::npos);
}

TEST_F(ServeTest, OneServerAFolder) {
  const ProgramRun second = run({"serve", "site"});
  EXPECT_EQ(second.status, 2);
  EXPECT_NE(second.err.find("is served already"), std::string::npos) << second.err;
}

TEST_F(ServeTest, NoBytesBringItDown) {
  RandomStream random(3, 0);
  const std::string good = "POST /" + server().token() + "/jobs HTTP/1.1\r\n" + server().host() +
                           "Content-Length: 16\r\n\r\n{\"kind\": \"view\"}";
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = good;
    for (int k = 0; k <= trial % 8; ++k) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
      if (random.below(2) == 0)
        bytes[at] = static_cast<char>(random.below(256));
      else
        bytes.erase(at, 1);
    }
    const int descriptor = server().connected();
    if (send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0) ADD_FAILURE();
    shutdown(descriptor, SHUT_WR);
    const int status = status_in(RunningServer::rest_of(descriptor));
    EXPECT_TRUE(status == 0 || (status >= 200 && status < 600 && status != 500)) << status;
    close(descriptor);
  }
  // As many as there are places, and more, that say nothing: who comes after them is served all the same.
  std::vector<int> silent;
  for (int k = 0; k < 30; ++k) silent.push_back(server().connected());
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
  for (const int descriptor : silent) close(descriptor);
  EXPECT_EQ(status_in(server().say("GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n")), 431);
  EXPECT_EQ(status_in(server().ask("GET", "state")), 200);
}

}  // namespace
}  // namespace limen
