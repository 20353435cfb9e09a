// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "limen/base/ranked.h"
#include "limen/extract/openings/opening_shape.h"
#include "limen/geometry/linear.h"

namespace limen {
namespace {

constexpr double kCurtainNeck_m = 0.08;
constexpr double kOverhang_m = 0.15;   // of a curtain beyond its opening
constexpr double kSigma_m = 0.1;       // of that
constexpr double kMinGap_m = 0.03;     // between wall and curtain
constexpr double kMaxSpread_m = 0.08;  // of the gap over one curtain
constexpr double kMinFold_m = 0.006;   // root mean square depth of folds: what is flat is no curtain
constexpr double kMinCurtain_m = 0.5;  // breadth and height of the curtain itself
constexpr std::size_t kMinCurtainPoints = 60;
constexpr double kMinFill = 0.6;

double quantile(std::vector<double> values, double share) {
  return ranked(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// What hangs in a region before the wall: place of its points on the wall (seen straight on), and their
/// distance from it.
struct Hanging {
  std::vector<double> u, v, gap_m;

  [[nodiscard]] Box2 box() const {
    Box2 box;
    box.add({quantile(u, 0.01), quantile(v, 0.01)});
    box.add({quantile(u, 0.99), quantile(v, 0.99)});
    return box;
  }
};

Hanging hanging_in(const Scan& scan, const WallEvidence& evidence, const OpeningGrid& grid,
                   const Box2& region) {
  Hanging hanging;
  for (const std::uint32_t i : grid.samples_in(region)) {
    const WallSample& sample = evidence.samples[i];
    if (sample.kind != SampleKind::cover || -sample.depth_m < kMinGap_m) continue;
    const Vector2d at = evidence.wall.frame.to_plane(scan.points[sample.point]);
    hanging.u.push_back(at.x());
    hanging.v.push_back(at.y());
    hanging.gap_m.push_back(-static_cast<double>(sample.depth_m));
  }
  return hanging;
}

/// Root mean square distance of the points to their least-squares plane over (u, v).
double fold_depth(const Hanging& hanging) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (std::size_t i = 0; i < hanging.u.size(); ++i) {
    const Vector3d row(1.0, hanging.u[i], hanging.v[i]);
    normal += row * row.transpose();
    right += row * hanging.gap_m[i];
  }
  const Vector3d plane = solve_symmetric(normal, right);
  double sum = 0.0;
  for (std::size_t i = 0; i < hanging.u.size(); ++i) {
    const double rest = hanging.gap_m[i] - plane.dot(Vector3d(1.0, hanging.u[i], hanging.v[i]));
    sum += rest * rest;
  }
  return std::sqrt(sum / static_cast<double>(hanging.u.size()));
}

bool is_curtain(const Hanging& hanging, double noise_m) {
  if (hanging.u.size() < kMinCurtainPoints) return false;
  const Box2 box = hanging.box();
  if ((box.high - box.low).minCoeff() < kMinCurtain_m) return false;
  if (quantile(hanging.gap_m, 0.9) - quantile(hanging.gap_m, 0.1) > kMaxSpread_m) return false;
  return fold_depth(hanging) > std::max(kMinFold_m, 2.0 * noise_m);
}

/// Part of the region's cells that are covered, among those where anything was seen.
double covered_share(const OpeningGrid& grid, const Box2& box) {
  double covered = 0.0;
  double seen = 0.0;
  for (int r = grid.row(box.low.y()); r <= grid.row(box.high.y()); ++r) {
    for (int c = grid.column(box.low.x()); c <= grid.column(box.high.x()); ++c) {
      const OpeningGrid::Cell cell = grid.at(c, r);
      seen += cell != OpeningGrid::Cell::unknown ? 1.0 : 0.0;
      covered += cell == OpeningGrid::Cell::cover ? 1.0 : 0.0;
    }
  }
  return covered / std::max(1.0, seen);
}

}  // namespace

std::vector<OpeningRectangle> curtained_rectangles(const Scan& scan, const WallEvidence& evidence,
                                                   const OpeningGrid& grid, double noise_m,
                                                   const OpeningOptions& options) {
  std::vector<OpeningRectangle> rectangles;
  for (const Box2& region : grid.regions(OpeningGrid::Cell::cover, kCurtainNeck_m)) {
    const Vector2d size = region.high - region.low;
    if (size.x() > options.max_width_m + 1.0 || size.y() > options.max_height_m + 1.0) continue;
    if (size.minCoeff() < kMinCurtain_m || covered_share(grid, region) < kMinFill) continue;
    const Hanging hanging = hanging_in(scan, evidence, grid, region);
    if (!is_curtain(hanging, noise_m)) continue;
    OpeningRectangle rectangle = measured({.box = region}, evidence, grid, options);
    const auto round = std::count_if(rectangle.bounded.begin(), rectangle.bounded.end(),
                                     [&](double share) { return share >= kMinBounded; });
    if (round < 3 || rectangle.bounded[static_cast<std::size_t>(Side::bottom)] < kMinBounded) continue;
    rectangle.box = hanging.box();
    rectangle.box.low.array() += kOverhang_m;
    rectangle.box.high.array() -= kOverhang_m;
    const Vector2d opening = rectangle.box.high - rectangle.box.low;
    if (opening.x() < std::max(kMinCurtain_m, options.min_width_m)) continue;
    if (opening.y() < std::max(kMinCurtain_m, options.min_height_m)) continue;
    rectangle.sigma_m.fill(kSigma_m);
    rectangle.curtain = true;
    rectangles.push_back(rectangle);
  }
  return rectangles;
}

}  // namespace limen
