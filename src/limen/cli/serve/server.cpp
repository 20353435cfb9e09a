// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/serve/server.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "limen/base/error.h"
#include "limen/base/text.h"

namespace limen {
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
