// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>

namespace limen {

/// Calls a function again and again from a thread of its own, until it is destroyed: for what has to go on
/// while work that tells nothing is going on. `tick` must not throw.
class Ticker {
 public:
  Ticker(std::chrono::milliseconds period, std::function<void()> tick);
  /// Returns when the last call has ended.
  ~Ticker();
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limen
