// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/terminal/progress_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

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

namespace {

constexpr int kStageColumns = 12;
constexpr int kWidestBar = 30;
constexpr int kNarrowestBar = 8;
constexpr double kFirstEstimate_s = 1.0;
constexpr double kFirstEstimateShare = 0.01;
constexpr double kSettling_s = 4.0;  ///< in which an estimate moves by two thirds to a new one

/// Eighths of a block, so that a short bar still moves visibly.
std::string utf8_bar(double share, int columns) {
  static constexpr std::array<std::string_view, 8> kPieces = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const auto eighths = static_cast<std::size_t>(share * 8.0 * columns);
  const auto wide = static_cast<std::size_t>(columns);
  std::string bar;
  for (std::size_t k = 0; k < wide; ++k)
    bar += k < eighths / 8 ? "█" : k == eighths / 8 ? kPieces[eighths % 8] : " ";
  return fmt::format("▕{}▏", bar);
}

std::string ascii_bar(double share, int columns) {
  const auto full = static_cast<std::size_t>(share * columns);
  return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", static_cast<std::size_t>(columns) - full);
}

std::string turning_mark(double elapsed_s, bool utf8) {
  static constexpr std::array<std::string_view, 8> kDots = {"⠋", "⠙", "⠸", "⢰", "⣠", "⣄", "⡆", "⠇"};
  static constexpr std::string_view kStrokes = "|/-\\";
  const auto step = static_cast<std::size_t>(elapsed_s * 8.0);
  return utf8 ? std::string(kDots[step % kDots.size()]) : std::string(1, kStrokes[step % kStrokes.size()]);
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

/// Empty where the units have no meaning to a user.
std::string rate_text(const ProgressState& state) {
  if (state.unit == WorkUnit::steps || state.elapsed_s <= 0.25) return {};
  const double rate = state.done / state.elapsed_s;
  if (state.unit == WorkUnit::bytes) return fmt::format("{:.0f} MB/s", rate * 1e-6);
  return rate >= 1e6 ? fmt::format("{:.1f} M points/s", rate * 1e-6)
                     : fmt::format("{:.0f} k points/s", rate * 1e-3);
}

std::string cut(const std::string& text, int columns) {
  return text.substr(0, static_cast<std::size_t>(std::max(0, columns)));
}

}  // namespace

std::string progress_line(const ProgressState& state, const LineStyle& style) {
  // The last column stays free: some terminals break the line once it is full.
  const int columns = style.columns - 1;
  if (!(state.total > 0.0)) {
    const std::string text =
        cut(fmt::format(" {:<{}} {}", state.stage, kStageColumns, duration_text(std::floor(state.elapsed_s))),
            columns - 1);
    return turning_mark(state.elapsed_s, style.utf8) + text;
  }
  const double share = std::clamp(state.done / state.total, 0.0, 1.0);
  const std::string head = fmt::format("{:<{}} ", state.stage, kStageColumns);
  std::string tail = fmt::format(" {:3} %", static_cast<int>(100.0 * share));
  int left = columns - static_cast<int>(head.size() + tail.size()) - 2;
  const auto add = [&](const std::string& text) {
    if (text.empty() || left - static_cast<int>(text.size()) - 2 < kNarrowestBar) return;
    tail += fmt::format("  {}", text);
    left -= static_cast<int>(text.size()) + 2;
  };
  if (state.remaining_s) add(duration_text(*state.remaining_s) + " left");
  add(rate_text(state));
  if (left < kNarrowestBar) return cut(head + tail, columns);
  const int bar = std::min(left, kWidestBar);
  return head + (style.utf8 ? utf8_bar(share, bar) : ascii_bar(share, bar)) + tail;
}

std::optional<double> RemainingTime::update(double elapsed_s, double done, double total) {
  if (!(total > 0.0) || elapsed_s < kFirstEstimate_s || done < kFirstEstimateShare * total) return {};
  const double end_s = elapsed_s * total / done;
  if (!end_s_) end_s_ = end_s;
  const double weight = 1.0 - std::exp(-std::max(0.0, elapsed_s - last_s_) / kSettling_s);
  last_s_ = elapsed_s;
  *end_s_ += weight * (end_s - *end_s_);
  return std::max(0.0, *end_s_ - elapsed_s);
}

}  // namespace limen
