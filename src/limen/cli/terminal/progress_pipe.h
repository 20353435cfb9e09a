// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "limen/base/progress.h"

namespace limen {

/// The variable that names a descriptor to which progress is written, for a program that shows it elsewhere.
inline constexpr const char* kProgressVariable = "LIMEN_PROGRESS_FD";

/// Tells the stage and the share of it that is done as lines "STAGE", "STAGE<tab>0.25", about ten a second.
/// A reader that is slow or gone misses some, and stops nothing.
class PipeMonitor : public Monitor {
 public:
  /// `descriptor` stays open, and is not inherited by what this process starts.
  explicit PipeMonitor(int descriptor);
  void begin_stage(std::string_view name) override;
  void advance(double done, double total) override;
  void note(std::string_view text) override;

 private:
  std::mutex mutex_;
  int descriptor_;
  std::string stage_;
  std::chrono::steady_clock::time_point stated_{};
};

/// One for the descriptor that the variable names; none where it names none that is open.
std::unique_ptr<Monitor> pipe_monitor();

}  // namespace limen
