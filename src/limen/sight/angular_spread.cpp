// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/sight/angular_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "limen/base/parallel.h"

namespace limen {
namespace {

// Rough cells show the field of view, fine ones how evenly it is filled.
constexpr std::size_t kLeastRough = 8;    // rough cells along a face's side: 11 degrees each
constexpr std::size_t kMostRough = 64;    // 1.4 degrees each
constexpr std::size_t kFine = 2;          // fine cells along the side of a rough one
constexpr double kPointsPerRough = 13.0;  // some three points in each fine cell of the field of view
constexpr double kFilledShare = 1e-4;  // of the points: a rough cell with fewer is not in the field of view
constexpr float kNearestRangeM = 0.05F;
constexpr float kBehindM = 0.3F;         // points so much further than the nearest in their cell are hidden,
constexpr float kBehindShare = 0.05F;    // and this share of its range
constexpr double kHiddenWeight = 0.5;    // nats per point: weight of what is hidden beside the divergence
constexpr double kClearlyHidden = 0.03;  // share of the points
constexpr double kNearestStepM = 1.0;    // other places lie so far, and twice, four and eight times as far

/// Where a direction meets the face of a cube, as a share of its side: 2 / pi times the angle plus a half,
/// within 0.003, so that cells are of like size.
double along_face(double tangent) {
  return 0.5 + 0.5 * tangent * (1.3476 - 0.3476 * std::abs(tangent));
}

struct Cell {
  std::size_t fine;
  std::size_t rough;
};

Cell cell_of(const Vector3d& ray, std::size_t rough) {
  Eigen::Index axis = 0;
  const double length = ray.cwiseAbs().maxCoeff(&axis);
  const std::size_t cells = kFine * rough;
  const auto place = [&](Eigen::Index k) {
    const double share = along_face(ray[k % 3] / length);
    return std::min(cells - 1, static_cast<std::size_t>(share * static_cast<double>(cells)));
  };
  const std::size_t face = 2 * static_cast<std::size_t>(axis) + (ray[axis] < 0.0 ? 1 : 0);
  const std::size_t u = place(axis + 1);
  const std::size_t v = place(axis + 2);
  return {(face * cells + u) * cells + v, (face * rough + u / kFine) * rough + v / kFine};
}

double misfit(const AngularSpread& spread) {
  return spread.divergence + kHiddenWeight * spread.hidden;
}

std::vector<Vector3d> places_around(const Vector3d& claim) {
  std::vector<Vector3d> places;
  for (double step = kNearestStepM; step <= 8.0 * kNearestStepM; step *= 2.0) {
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-1.0, 0.0, 1.0}) {
        for (const double z : {-1.0, 0.0, 1.0}) {
          const Vector3d way(x, y, z);
          if (!way.isZero()) places.emplace_back(claim + step * way.normalized());
        }
      }
    }
  }
  return places;
}

/// A scanner that turns about an axis measures 1 / cos(elevation) times as densely as one that looks alike in
/// all directions. So a point counts as the cosine of its elevation about each axis of the frame, and as one.
using PointWeights = std::array<double, 4>;

void add_weights(const Vector3d& ray, PointWeights& weights) {
  constexpr double kLeastWeight = 0.02;
  const Vector3d way = ray.normalized();
  for (std::size_t k = 0; k < 3; ++k) {
    const double sine = way[static_cast<Eigen::Index>(k)];
    weights[k] += std::max(kLeastWeight, std::sqrt(std::max(0.0, 1.0 - sine * sine)));
  }
  weights[3] += 1.0;
}

/// The entropy over the cells, by the weights that make it greatest, nats.
double most_entropy(const std::vector<PointWeights>& weights) {
  double most = 0.0;
  for (std::size_t k = 0; k < PointWeights{}.size(); ++k) {
    double all = 0.0;
    double sum = 0.0;
    for (const PointWeights& weight : weights) {
      all += weight[k];
      if (weight[k] > 0.0) sum += weight[k] * std::log(weight[k]);
    }
    most = std::max(most, std::log(all) - sum / all);
  }
  return most;
}

}  // namespace

std::size_t direction_cells(const std::vector<Vector3d>& points, const Vector3d& place) {
  std::vector<bool> seen(6 * kLeastRough * kLeastRough, false);
  for (const Vector3d& point : points) {
    if (point != place) seen[cell_of(point - place, kLeastRough).rough] = true;
  }
  const auto view =
      static_cast<double>(std::count(seen.begin(), seen.end(), true)) / static_cast<double>(seen.size());
  const double cells = static_cast<double>(points.size()) / (kPointsPerRough * std::max(view, 1e-3));
  return std::clamp(static_cast<std::size_t>(std::lround(std::sqrt(cells / 6.0))), kLeastRough, kMostRough);
}

AngularSpread angular_spread(const std::vector<Vector3d>& points, const Vector3d& place,
                             std::size_t cells_along) {
  const std::size_t fine_cells = 6 * kFine * kFine * cells_along * cells_along;
  std::vector<PointWeights> weights(fine_cells, PointWeights{});
  std::vector<std::uint32_t> rough(6 * cells_along * cells_along, 0);
  std::vector<float> nearest(fine_cells, std::numeric_limits<float>::max());
  std::vector<std::uint32_t> cells;
  std::vector<float> ranges;
  cells.reserve(points.size());
  ranges.reserve(points.size());
  for (const Vector3d& point : points) {
    const Vector3d ray = point - place;
    const auto range = static_cast<float>(ray.norm());
    if (range < kNearestRangeM) continue;
    const Cell cell = cell_of(ray, cells_along);
    add_weights(ray, weights[cell.fine]);
    ++rough[cell.rough];
    nearest[cell.fine] = std::min(nearest[cell.fine], range);
    cells.push_back(static_cast<std::uint32_t>(cell.fine));
    ranges.push_back(range);
  }
  if (cells.empty()) return {};
  const auto total = static_cast<double>(cells.size());
  const auto filled = static_cast<std::uint32_t>(std::max(1.0, kFilledShare * total));
  const auto view = std::count_if(rough.begin(), rough.end(), [&](std::uint32_t n) { return n >= filled; });
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    hidden += ranges[i] > (1.0F + kBehindShare) * nearest[cells[i]] + kBehindM ? 1 : 0;
  return {std::log(static_cast<double>(view) * static_cast<double>(kFine * kFine)) - most_entropy(weights),
          static_cast<double>(hidden) / total};
}

double better_place_nearby(const std::vector<Vector3d>& points, const Vector3d& claim) {
  const std::size_t cells = direction_cells(points, claim);
  const AngularSpread claimed = angular_spread(points, claim, cells);
  const std::vector<Vector3d> places = places_around(claim);
  return parallel_reduce(
      places.size(), 4, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double best = 0.0;
        for (std::size_t i = begin; i < end; ++i) {
          const AngularSpread other = angular_spread(points, places[i], cells);
          if (other.hidden <= claimed.hidden + kClearlyHidden)
            best = std::max(best, misfit(claimed) - misfit(other));
        }
        return best;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace limen
