// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/progress_pipe.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "limen/base/system.h"
#include "limen/base/text.h"

namespace limen {
namespace {

constexpr std::chrono::milliseconds kBetweenLines{100};

void tell(int descriptor, const std::string& line) {
  // What does not fit is lost: the next line says more.
  if (write_some(descriptor, line) < 0) return;
}

}  // namespace

PipeMonitor::PipeMonitor(int descriptor) : descriptor_(descriptor) {
  keep_from_children(descriptor_);
}

void PipeMonitor::begin_stage(std::string_view name) {
  const std::scoped_lock lock(mutex_);
  stage_ = one_line(std::string(name));
  stated_ = {};
  tell(descriptor_, stage_ + "\n");
}

void PipeMonitor::advance(double done, double total) {
  const std::scoped_lock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (total <= 0.0 || now - stated_ < kBetweenLines) return;
  stated_ = now;
  tell(descriptor_, fmt::format("{}\t{:.4f}\n", stage_, std::clamp(done / total, 0.0, 1.0)));
}

void PipeMonitor::note(std::string_view text) {
  tell(STDERR_FILENO, fmt::format("limen: {}\n", text));
}

std::unique_ptr<Monitor> pipe_monitor() {
  const char* stated = std::getenv(kProgressVariable);
  const std::string_view text = stated == nullptr ? std::string_view() : std::string_view(stated);
  int descriptor = -1;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), descriptor);
  const bool good =
      read.ec == std::errc() && read.ptr == text.data() + text.size() && descriptor > STDERR_FILENO;
  if (!good || !keep_from_children(descriptor)) return nullptr;
  return std::make_unique<PipeMonitor>(descriptor);
}

}  // namespace limen
