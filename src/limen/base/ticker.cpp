// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/base/ticker.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace limen {

struct Ticker::State {
  State(std::chrono::milliseconds every, std::function<void()> call) : period(every), tick(std::move(call)) {}

  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, stop, period, [&stop] { return stop.stop_requested(); })) tick();
  }

  std::chrono::milliseconds period;
  std::function<void()> tick;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::jthread thread;  // last: it ends before the rest goes
};

Ticker::Ticker(std::chrono::milliseconds period, std::function<void()> tick)
    : state_(std::make_unique<State>(period, std::move(tick))) {
  State& state = *state_;
  state.thread = std::jthread([&state](const std::stop_token& stop) { state.run(stop); });
}

Ticker::~Ticker() = default;

}  // namespace limen
