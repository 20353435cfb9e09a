// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "limen/base/progress.h"

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

/// What a progress line tells.
struct ProgressState {
  std::string stage;
  WorkUnit unit = WorkUnit::steps;
  double done = 0.0;
  double total = 0.0;                 ///< 0: not known how much there is to do
  double elapsed_s = 0.0;             ///< since the stage began
  std::optional<double> remaining_s;  ///< empty: not known yet
};

/// What the terminal can show.
struct LineStyle {
  int columns = 80;
  bool utf8 = true;  ///< else the bar is made of ASCII signs
};

/// One line without its end, no wider than the terminal: stage, bar, percentage, rate, remaining time; of a
/// stage whose total is unknown: a turning mark and the seconds that have passed. What does not fit is left
/// out, the least important first.
std::string progress_line(const ProgressState& state, const LineStyle& style);

/// Remaining seconds of a stage that do not jump: the estimate of the moment at which it will end moves only
/// slowly towards what the last values say.
class RemainingTime {
 public:
  /// Of a stage that is `done` of `total` after `elapsed_s`. Empty in the first second and the first
  /// hundredth.
  std::optional<double> update(double elapsed_s, double done, double total);

 private:
  std::optional<double> end_s_;  ///< since the stage began
  double last_s_ = 0.0;
};

}  // namespace limen
