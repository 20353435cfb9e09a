// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "limen/extract/openings/opening_shape.h"

namespace limen {
namespace {

constexpr double kLines_m = 0.04;  // between scan lines
constexpr std::size_t kRight = static_cast<std::size_t>(Side::right);
constexpr std::size_t kLeft = static_cast<std::size_t>(Side::left);

/// What lines say of an edge at `at`: it lies somewhere between two of them.
SideSeparator between_lines(double at) {
  return {(std::floor(at / kLines_m) + 0.5) * kLines_m, kLines_m / std::sqrt(12.0), true};
}

double true_low(std::size_t i) {
  return 2.7371 * static_cast<double>(i);
}
double true_high(std::size_t i) {
  return true_low(i) + 1.2 + 0.0137 * static_cast<double>(i * i);
}

/// Windows in a row whose bars are as wide as `width` says of each.
std::vector<FramedRectangle> row_of(const std::function<double(std::size_t)>& width) {
  std::vector<FramedRectangle> windows(8);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const SideSeparator right = between_lines(true_high(i));
    const SideSeparator left = between_lines(-true_low(i));
    windows[i].front_m = 0.1;
    windows[i].rectangle.box.add({-left.place, 0.0});
    windows[i].rectangle.box.add({right.place, 1.5});
    windows[i].rectangle.sigma_m = {0.005, right.sigma_m, 0.005, left.sigma_m};
    windows[i].inner = {between_lines(true_high(i) - width(i)), between_lines(-true_low(i) - width(i))};
  }
  return windows;
}

double mean_error(const std::vector<FramedRectangle>& windows) {
  double sum = 0.0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    sum += std::abs(windows[i].rectangle.box.high.x() - true_high(i)) +
           std::abs(windows[i].rectangle.box.low.x() - true_low(i));
  }
  return sum / (2.0 * static_cast<double>(windows.size()));
}

TEST(OpeningFrames, EqualBarsTellWhereTheSidesAre) {
  std::vector<FramedRectangle> windows = row_of([](std::size_t) { return 0.062; });
  const double before_m = mean_error(windows);
  share_frame_widths(windows);
  EXPECT_LT(mean_error(windows), 0.7 * before_m);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const OpeningRectangle& it = windows[i].rectangle;
    EXPECT_LT(std::abs(it.box.high.x() - true_high(i)), 2.5 * it.sigma_m[kRight]);
    EXPECT_LT(std::abs(it.box.low.x() - true_low(i)), 2.5 * it.sigma_m[kLeft]);
  }
}

TEST(OpeningFrames, UnequalBarsLeaveTheSidesWhereTheyAre) {
  const auto width = [](std::size_t i) { return 0.01 + 0.018 * static_cast<double>((5 * i) % 8); };
  std::vector<FramedRectangle> windows = row_of(width);
  const std::vector<FramedRectangle> before = windows;
  share_frame_widths(windows);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    EXPECT_EQ(windows[i].rectangle.box.high.x(), before[i].rectangle.box.high.x());
    EXPECT_EQ(windows[i].rectangle.sigma_m, before[i].rectangle.sigma_m);
  }
}

TEST(OpeningFrames, WindowsThatTheSameLinesMetCountOnce) {
  std::vector<FramedRectangle> windows = row_of([](std::size_t) { return 0.062; });
  windows.assign(8, windows[3]);  // one above the other
  share_frame_widths(windows);
  for (const FramedRectangle& it : windows)
    EXPECT_EQ(it.rectangle.sigma_m[kRight], kLines_m / std::sqrt(12.0));
}

TEST(OpeningFrames, FramesAtOtherDepthsAreOthers) {
  std::vector<FramedRectangle> windows = row_of([](std::size_t) { return 0.062; });
  for (std::size_t i = 0; i < windows.size(); ++i) windows[i].front_m = 0.05 + 0.04 * static_cast<double>(i);
  share_frame_widths(windows);
  for (const FramedRectangle& it : windows)
    EXPECT_EQ(it.rectangle.sigma_m[kRight], kLines_m / std::sqrt(12.0));
}

}  // namespace
}  // namespace limen
