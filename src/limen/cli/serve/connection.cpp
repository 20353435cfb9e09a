// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/connection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <unistd.h>

#include "limen/base/error.h"

namespace limen {
namespace {

constexpr std::chrono::seconds kLongestHead{10};
constexpr std::chrono::seconds kLongestSilence{30};
constexpr std::chrono::seconds kLongestDraining{2};
/// Read or written in one go, so that no connection keeps the others waiting.
constexpr std::size_t kServePiece = std::size_t{256} * 1024;
constexpr std::string_view kHeadEnd = "\r\n\r\n";

const char* words_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 202:
      return "Accepted";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 409:
      return "Conflict";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 507:
      return "Insufficient Storage";
    default:
      return status < 500 ? "Bad Request" : "Server Error";
  }
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

}  // namespace limen
