// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "limen/base/progress.h"
#include "limen/model/result.h"

namespace limen {

/// Names and times the stages of one registration.
class StageClock {
 public:
  StageClock(std::vector<StageTime>& stages, Monitor& monitor) : stages_(stages), monitor_(monitor) {}

  void begin(const char* name) {
    monitor_.throw_if_cancelled();
    monitor_.begin_stage(name);
    name_ = name;
    start_ = std::chrono::steady_clock::now();
  }
  void end() {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start_;
    stages_.push_back({name_, seconds.count()});
  }

 private:
  std::vector<StageTime>& stages_;
  Monitor& monitor_;
  const char* name_ = "";
  std::chrono::steady_clock::time_point start_;
};

}  // namespace limen
