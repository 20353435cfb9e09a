// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "limen/cli/serve/connection.h"

namespace limen {

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
