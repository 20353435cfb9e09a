// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/server.h"

#include <algorithm>
#include <cerrno>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::chrono::seconds kLongestHead{10};
constexpr std::chrono::seconds kLongestSilence{30};
constexpr std::chrono::seconds kLongestDraining{2};
/// Read or written in one go, so that no connection keeps the others waiting.
constexpr std::size_t kServePiece = std::size_t{256} * 1024;
constexpr std::string_view kHeadEnd = "\r\n\r\n";

const char* words_of(int status) {
  static constexpr Named<int> words[] = {{200, "OK"},
                                         {201, "Created"},
                                         {202, "Accepted"},
                                         {403, "Forbidden"},
                                         {404, "Not Found"},
                                         {405, "Method Not Allowed"},
                                         {409, "Conflict"},
                                         {411, "Length Required"},
                                         {413, "Content Too Large"},
                                         {414, "URI Too Long"},
                                         {415, "Unsupported Media Type"},
                                         {431, "Request Header Fields Too Large"},
                                         {501, "Not Implemented"},
                                         {507, "Insufficient Storage"}};
  const char* const known = name_of(words, status);
  if (*known != '\0') return known;
  return status < 500 ? "Bad Request" : "Server Error";
}

std::string head_of(const HttpReply& reply, std::uint64_t bytes) {
  std::string head = fmt::format("HTTP/1.1 {} {}\r\n", reply.status, words_of(reply.status));
  head += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", reply.type, bytes);
  for (const auto& [name, value] : reply.fields) head += fmt::format("{}: {}\r\n", name, value);
  return head +
         "Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
         "Referrer-Policy: no-referrer\r\nCross-Origin-Opener-Policy: same-origin\r\n"
         "Cross-Origin-Resource-Policy: same-origin\r\nX-Frame-Options: DENY\r\n\r\n";
}

}  // namespace

Connection::Connection(int socket, ServeSite& site, Clock::time_point now)
    : socket_(socket), site_(site), deadline_(now + kLongestHead), last_moved_(now) {}

Connection::~Connection() {
  if (file_ >= 0) close(file_);
  close(socket_);
}

void Connection::read_more(Clock::time_point now) {
  static std::string piece(kServePiece, '\0');  // one thread serves all
  const ssize_t got = recv(socket_, piece.data(), piece.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    // Who goes before all was said is answered nothing; an upload that is not whole leaves nothing.
    state_ = State::done;
    return;
  }
  if (state_ == State::draining) return;
  last_moved_ = now;
  try {
    take(piece.substr(0, static_cast<std::size_t>(got)), now);
  } catch (const HttpFault& fault) {
    fail(fault);
  } catch (const Error& error) {
    fail(HttpFault(507, error.what()));
  } catch (const std::exception&) {
    fail(HttpFault(500, "this is an internal error of limen: please report it"));
  }
}

void Connection::take(const std::string& bytes, Clock::time_point now) {
  if (state_ == State::body) {
    deadline_ = now + kLongestSilence;
    take_body(bytes);
    return;
  }
  const std::size_t searched = in_.size() < kHeadEnd.size() ? 0 : in_.size() - kHeadEnd.size() + 1;
  in_ += bytes;
  const std::size_t end = in_.find(kHeadEnd, searched);
  if (std::min(end, in_.size()) > kMostHeadBytes) throw HttpFault(431, "the head is too long");
  if (end == std::string::npos) return;
  const std::string rest = in_.substr(end + kHeadEnd.size());
  in_.resize(end + kHeadEnd.size());
  deadline_ = now + kLongestSilence;
  take_head();
  take_body(rest);
}

void Connection::take_head() {
  request_ = parse_http_head(in_);
  in_.clear();
  upload_ = site_.begin(request_);
  let_in_ = true;
  body_left_ = request_.content_bytes;
  state_ = State::body;
  if (request_.expects_continue && body_left_ > 0) out_ = "HTTP/1.1 100 Continue\r\n\r\n";
}

void Connection::take_body(const std::string& bytes) {
  // One request a connection: what follows its body is not read.
  const std::string mine = bytes.substr(0, std::min<std::uint64_t>(bytes.size(), body_left_));
  body_left_ -= mine.size();
  if (upload_)
    upload_->write(mine);
  else
    body_ += mine;
  if (body_left_ > 0) return;
  out_.clear();
  begin_reply(upload_ ? upload_->finish() : site_.answer(request_, body_));
  upload_.reset();
}

void Connection::begin_reply(const HttpReply& reply) {
  const bool head_only = request_.method == "HEAD";
  const std::uint64_t bytes = reply.file >= 0 ? reply.file_bytes : reply.body.size();
  out_ = head_of(reply, bytes) + (head_only ? std::string() : reply.body);
  file_ = reply.file;
  file_left_ = head_only || reply.file < 0 ? 0 : reply.file_bytes;
  state_ = State::reply;
}

void Connection::fail(const HttpFault& fault) {
  upload_.reset();
  if (file_ >= 0) close(std::exchange(file_, -1));
  begin_reply(reply_to(fault));
}

void Connection::write_more(Clock::time_point now) {
  ssize_t written = 0;
  if (!out_.empty()) {
    written = send(socket_, out_.data(), out_.size(), MSG_NOSIGNAL);
    if (written > 0) out_.erase(0, static_cast<std::size_t>(written));
  } else {
    written = sendfile(socket_, file_, nullptr, std::min<std::uint64_t>(file_left_, kServePiece));
    if (written > 0) file_left_ -= static_cast<std::uint64_t>(written);
    if (written == 0)
      state_ = State::done;  // the file became shorter: the reader sees that bytes are missing
  }
  if (written < 0 && errno != EAGAIN && errno != EINTR) state_ = State::done;
  if (written > 0) sent(now);
}

void Connection::sent(Clock::time_point now) {
  last_moved_ = now;
  deadline_ = now + kLongestSilence;
  if (wants_to_write() || state_ != State::reply) return;
  // Closing at once would take the answer away from who still sends.
  shutdown(socket_, SHUT_WR);
  state_ = State::draining;
  deadline_ = now + kLongestDraining;
}

bool Connection::goes_before(const Connection& other) const {
  return let_in_ != other.let_in_ ? other.let_in_ : last_moved_ < other.last_moved_;
}

void Connection::look_at_clock(Clock::time_point now) {
  if (now > deadline_) state_ = State::done;
}

namespace {

constexpr int kServeTick_ms = 200;
constexpr int kWaitingConnections = 16;

[[noreturn]] void cannot_listen(int port) {
  throw Error(fmt::format("cannot listen: {}", reason_of(errno)), fmt::format("127.0.0.1:{}", port),
              "choose another --port, or leave it out");
}

/// What is waited for: the listening socket, then connections and ears in their order.
std::vector<pollfd> all_of(const LoopbackSocket& socket,
                           const std::deque<std::unique_ptr<Connection>>& connections,
                           const std::vector<int>& ears) {
  std::vector<pollfd> all;
  all.push_back({socket.descriptor(), POLLIN, 0});
  for (const auto& connection : connections) {
    const int events =
        (connection->wants_to_read() ? POLLIN : 0) | (connection->wants_to_write() ? POLLOUT : 0);
    all.push_back({connection->socket(), static_cast<short>(events), 0});
  }
  for (const int ear : ears) all.push_back({ear, POLLIN, 0});
  return all;
}

void make_room(std::deque<std::unique_ptr<Connection>>& connections) {
  if (connections.size() < kMostConnections) return;
  connections.erase(std::min_element(connections.begin(), connections.end(),
                                     [](const auto& a, const auto& b) { return a->goes_before(*b); }));
}

void move_on(Connection& connection, int events, Connection::Clock::time_point now) {
  if ((events & POLLOUT) != 0)
    connection.write_more(now);
  else if ((events & (POLLIN | POLLHUP | POLLERR)) != 0)
    connection.read_more(now);
  connection.look_at_clock(now);
}

}  // namespace

LoopbackSocket::LoopbackSocket(int port)
    : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (descriptor_ < 0) cannot_listen(port);
  const int yes = 1;
  setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t length = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (bind(descriptor_, any, length) != 0 || listen(descriptor_, kWaitingConnections) != 0 ||
      getsockname(descriptor_, any, &length) != 0) {
    close(descriptor_);
    cannot_listen(port);
  }
  port_ = ntohs(address.sin_port);
}

LoopbackSocket::~LoopbackSocket() {
  close(descriptor_);
}

void serve_site(const LoopbackSocket& socket, ServeSite& site, const std::function<bool()>& ended) {
  std::deque<std::unique_ptr<Connection>> connections;
  while (!ended()) {
    std::vector<pollfd> all = all_of(socket, connections, site.jobs().ears());
    if (poll(all.data(), all.size(), kServeTick_ms) < 0 && errno != EINTR)
      throw Error("cannot wait for connections: " + reason_of(errno), "limen serve",
                  "check the machine's limits", Fault::internal);
    const auto now = Connection::Clock::now();
    for (std::size_t k = 0; k < connections.size(); ++k) move_on(*connections[k], all[k + 1].revents, now);
    std::erase_if(connections, [](const auto& connection) { return connection->done(); });
    if ((all.front().revents & POLLIN) != 0) {
      const int accepted = accept4(socket.descriptor(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
      if (accepted >= 0) {
        make_room(connections);
        connections.push_back(std::make_unique<Connection>(accepted, site, now));
      }
    }
    site.jobs().tick();
  }
  connections.clear();
  site.jobs().finish();
}

}  // namespace limen
