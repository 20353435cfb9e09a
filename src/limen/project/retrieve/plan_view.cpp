// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/retrieve/plan_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace limen {
namespace {

constexpr double kPixelM = 0.25;
constexpr double kFullHeightM = 2.0;
constexpr double kLeastHeightM = 1.0;  // lower ones are furniture
constexpr double kNotClearM = 0.5;     // from its ends a line of sight is not sure to be clear
constexpr float kBeside = 0.4F;        // what a pixel beside a wall's counts
constexpr float kPixelAgainst = 3.0F;  // what a pixel of wall that was looked through counts against
constexpr float kLeastPixels = 5.0F;
constexpr std::size_t kMostPixels = 1'000'000;        // of a plan
constexpr std::size_t kMostShifts = 4 * kMostPixels;  // of two that are no larger
constexpr double kQuarter = 0.5 * std::numbers::pi;

template <class Put>
void draw(const Vector2d& from, const Vector2d& to, const Put& put) {
  const Vector2d way = to - from;
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * way.norm() / kPixelM)));
  for (int k = 0; k <= steps; ++k) {
    const Vector2d pixel = ((from + way * k / steps) / kPixelM).array().floor();
    put(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  }
}

std::size_t pixels_in(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

PlanView::PlanView(const std::vector<PlacedPlane>& planes) {
  for (const PlacedPlane& plane : planes) {
    const Vector2d middle = plane.middle.head<2>();
    const Vector2d half = plane.along.head<2>();
    if (plane.scanner) {
      const Vector2d scanner = plane.scanner->head<2>();
      for (const double k : {-0.6, 0.0, 0.6}) {
        const Vector2d way = middle + k * half - scanner;
        const double length = way.norm();
        if (length <= 2.0 * kNotClearM) continue;
        sights_.push_back({scanner + kNotClearM / length * way, scanner + (1.0 - kNotClearM / length) * way});
      }
    }
    if (is_wall(plane.normal)) add_wall(plane);
  }
  find_main_directions(planes);
}

void PlanView::add_wall(const PlacedPlane& plane) {
  const double height = 2.0 * std::max(std::abs(plane.across.z()), std::abs(plane.along.z()));
  if (height < kLeastHeightM) return;
  const Vector2d middle = plane.middle.head<2>();
  const Vector2d half = plane.along.head<2>();
  const auto weight = static_cast<float>(std::min(1.0, height / kFullHeightM));
  const double angle = std::atan2(plane.normal.y(), plane.normal.x());
  walls_.push_back({middle - half, middle + half, angle, weight});
  if (!plane.oriented) walls_.push_back({middle - half, middle + half, angle + std::numbers::pi, weight});
}

void PlanView::find_main_directions(const std::vector<PlacedPlane>& planes) {
  constexpr int kBins = 900;  // of 0.1 degrees
  constexpr int kPeak = 10;   // bins to either side that one direction has
  constexpr int kMean = 20;
  constexpr int kApart = 50;
  constexpr double kLeastShare = 0.2;  // of the first direction's wall
  constexpr double kMostWallM2 = 20.0;
  std::array<double, kBins> wall{};
  std::array<bool, kBins> taken{};
  const auto around = [](int bin) { return static_cast<std::size_t>((bin + kBins) % kBins); };
  for (const PlacedPlane& plane : planes) {
    if (!is_wall(plane.normal)) continue;
    const double quarters = std::atan2(plane.normal.y(), plane.normal.x()) / kQuarter;
    wall[around(static_cast<int>((quarters - std::floor(quarters)) * kBins))] +=
        std::min(kMostWallM2, plane.area_m2);
  }
  double first = 0.0;
  for (int n = 0; n < 2; ++n) {
    int best = 0;
    double most = 0.0;
    for (int k = 0; k < kBins; ++k) {
      double sum = 0.0;
      for (int o = -kPeak; o <= kPeak; ++o) sum += taken[around(k + o)] ? 0.0 : wall[around(k + o)];
      if (sum <= most) continue;
      most = sum;
      best = k;
    }
    if (most <= kLeastShare * first) return;
    first = std::max(first, most);
    double sum = 0.0;
    double moment = 0.0;
    for (int o = -kMean; o <= kMean; ++o) {
      sum += wall[around(best + o)];
      moment += o * wall[around(best + o)];
    }
    for (int o = -kApart; o <= kApart; ++o) taken[around(best + o)] = true;
    main_directions_.push_back((best + 0.5 + moment / sum) / kBins * kQuarter);
  }
}

int PlanImage::way_of(double angle) {
  const int way = static_cast<int>(std::lround(angle / (2.0 * std::numbers::pi) * kWays)) % kWays;
  return way < 0 ? way + kWays : way;
}

PlanImage::PlanImage(const PlanView& plan) {
  if (plan.walls_.empty()) return;
  std::pair x(std::numeric_limits<int>::max(), std::numeric_limits<int>::min());
  std::pair y = x;
  for (const PlanView::Wall& wall : plan.walls_) {
    draw(wall.from, wall.to, [&](int column, int row) {
      x = {std::min(x.first, column - 1), std::max(x.second, column + 2)};
      y = {std::min(y.first, row - 1), std::max(y.second, row + 2)};
    });
  }
  const std::size_t size = pixels_in(x.second - x.first, y.second - y.first);
  if (size > kMostPixels) return;
  x_ = x.first;
  y_ = y.first;
  width_ = x.second - x.first;
  height_ = y.second - y.first;
  for (std::vector<float>& way : ways_) way.assign(size, 0.0F);
  std::vector<bool> wall_here(size, false);
  for (const PlanView::Wall& wall : plan.walls_) {
    draw(wall.from, wall.to, [&](int column, int row) {
      for (int k = 0; k < 9; ++k) {
        const std::size_t pixel = index(column + k % 3 - 1, row + k / 3 - 1);
        wall_here[pixel] = true;
        const float weight = wall.weight * (k == 4 ? 1.0F : kBeside);
        float& value = ways_[static_cast<std::size_t>(way_of(wall.angle))][pixel];
        value = std::max(value, weight);
      }
    });
  }
  for (const PlanView::Sight& sight : plan.sights_) {
    draw(sight.from, sight.to, [&](int column, int row) {
      if (column < x.first || column >= x.second || row < y.first || row >= y.second) return;
      const std::size_t pixel = index(column, row);
      if (wall_here[pixel]) return;
      for (std::vector<float>& way : ways_) way[pixel] = -kPixelAgainst;
    });
  }
}

std::vector<PlanImage::Pixel> PlanImage::pixels_of(const std::vector<PlanView::Wall>& walls, double turn) {
  const Eigen::Rotation2Dd turned(turn);
  std::map<std::tuple<int, int, int>, float> weights;
  for (const PlanView::Wall& wall : walls) {
    draw(turned * wall.from, turned * wall.to, [&](int column, int row) {
      float& weight = weights[{row, column, way_of(wall.angle + turn)}];
      weight = std::max(weight, wall.weight);
    });
  }
  std::vector<Pixel> pixels;
  pixels.reserve(weights.size());
  for (const auto& [where, weight] : weights)
    pixels.push_back({std::get<1>(where), std::get<0>(where), std::get<2>(where), weight});
  return pixels;
}

void PlanImage::add_best_shifts(const PlanView& other, double angle, std::size_t most,
                                std::vector<PlanPose>& poses) const {
  const std::vector<Pixel> pixels = pixels_of(other.walls_, angle);
  if (pixels.empty() || width_ == 0) return;
  const auto by_x = [](const Pixel& a, const Pixel& b) { return a.x < b.x; };
  const auto [left, right] = std::minmax_element(pixels.begin(), pixels.end(), by_x);
  const int top = pixels.back().y;  // sorted by row
  const int columns = width_ + right->x - left->x;
  const int rows = height_ + top - pixels.front().y;
  const auto width = static_cast<std::size_t>(columns);
  if (pixels_in(columns, rows) > kMostShifts) return;
  std::vector<float> sums(pixels_in(columns, rows), 0.0F);
  for (const Pixel& pixel : pixels) {
    const std::vector<float>& image = ways_[static_cast<std::size_t>(pixel.way)];
    for (int row = 0; row < height_; ++row) {
      float* to = sums.data() + static_cast<std::size_t>(row + top - pixel.y) * width +
                  static_cast<std::size_t>(right->x - pixel.x);
      const float* from = image.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
      Eigen::Map<Eigen::ArrayXf>(to, width_) +=
          pixel.weight * Eigen::Map<const Eigen::ArrayXf>(from, width_);  // many at once
    }
  }
  std::vector<std::pair<float, std::size_t>> peaks;
  for (std::size_t row = 1; row + 1 < static_cast<std::size_t>(rows); ++row) {
    for (std::size_t k = row * width + 1; k + 1 < (row + 1) * width; ++k) {
      const float sum = sums[k];
      if (sum > kLeastPixels && sum >= sums[k - 1] && sum >= sums[k + 1] && sum >= sums[k - width] &&
          sum >= sums[k + width])
        peaks.emplace_back(-sum, k);
    }
  }
  const std::size_t kept = std::min(most, peaks.size());
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(kept), peaks.end());
  for (std::size_t k = 0; k < kept; ++k) {
    const int column = static_cast<int>(peaks[k].second % width);
    const int row = static_cast<int>(peaks[k].second / width);
    poses.push_back({angle, kPixelM * Vector2d(column + x_ - right->x, row + y_ - top), -peaks[k].first});
  }
}

}  // namespace limen
