// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "limen/cli/serve/http_request.h"
#include "limen/cli/serve/site.h"

namespace limen {

/// One connection with one request on it: its head, its body, the answer, and the end. It never waits: it is
/// moved on when there is something to read or room to write, and given up when too long nothing comes.
class Connection {
 public:
  using Clock = std::chrono::steady_clock;

  /// Takes over the socket, which does not wait.
  Connection(int socket, ServeSite& site, Clock::time_point now);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] int socket() const { return socket_; }
  [[nodiscard]] bool wants_to_write() const { return !out_.empty() || file_left_ > 0; }
  [[nodiscard]] bool wants_to_read() const { return !wants_to_write() && state_ != State::done; }
  [[nodiscard]] bool done() const { return state_ == State::done; }

  /// Of many it is the first to go where there is no room for one more: who has not sent the token goes
  /// before who has, and who is silent longer before who is not.
  [[nodiscard]] bool goes_before(const Connection& other) const;

  void read_more(Clock::time_point now);
  void write_more(Clock::time_point now);
  /// Ends it where it took too long.
  void look_at_clock(Clock::time_point now);

 private:
  enum class State { head, body, reply, draining, done };

  void take(const std::string& bytes, Clock::time_point now);
  void take_head();
  void take_body(const std::string& bytes);
  void begin_reply(const HttpReply& reply);
  void fail(const HttpFault& fault);
  void sent(Clock::time_point now);

  int socket_;
  ServeSite& site_;
  State state_ = State::head;
  Clock::time_point deadline_;
  Clock::time_point last_moved_;  ///< when bytes last went either way
  bool let_in_ = false;
  std::string in_;
  HttpRequest request_;
  std::uint64_t body_left_ = 0;
  std::unique_ptr<HttpUpload> upload_;
  std::string body_;
  std::string out_;
  int file_ = -1;
  std::uint64_t file_left_ = 0;
};

/// A socket that listens on 127.0.0.1 only.
class LoopbackSocket {
 public:
  /// `port` 0: any that is free. Throws Error where it is taken.
  explicit LoopbackSocket(int port);
  ~LoopbackSocket();
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
  int port_ = 0;
};

/// For one more the one that has been silent longest is left: what says nothing keeps nobody out.
inline constexpr std::size_t kMostConnections = 32;

/// Serves until `ended` says so, in this thread alone: connections, and the work that they asked for.
void serve_site(const LoopbackSocket& socket, ServeSite& site, const std::function<bool()>& ended);

}  // namespace limen
