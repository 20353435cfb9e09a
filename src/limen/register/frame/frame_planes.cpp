// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/frame_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "limen/base/parallel.h"
#include "limen/extract/cells/cell_grid.h"
#include "limen/geometry/linear.h"
#include "limen/register/frame/tukey_sums.h"

namespace limen {
namespace {

constexpr double kFinestM = 0.02;
constexpr double kCellM = 0.32;
constexpr double kLargestCellM = 1.3;
constexpr double kEnoughShare = 0.25;  // of the points that planar cubes should hold
constexpr double kThinM = 0.02;        // a cube's points lie in a plane: this thin,
constexpr double kFlat = 5.0;          // so many times wider than thick,
constexpr double kFilled = 0.15;       // and spread over so much of its edge
constexpr std::uint32_t kCellPoints = 10;
constexpr double kSeedRad = 0.07;  // directions nearer than this are one
constexpr double kLayerM = 0.06;   // cubes of one plane lie within this of it
constexpr std::size_t kSeeds = 120;
constexpr std::size_t kMostDirections = 12;
constexpr std::size_t kMostLayers = 6;  // planes of one direction
constexpr double kLeastShare = 0.01;    // of the planar cubes that a plane needs
constexpr double kGatherM = 0.12;
constexpr double kTukeyM = 0.03;
constexpr int kSettlings = 40;

struct PlanePiece {
  Vector3d mean;
  Vector3d normal;
};

/// The planar cubes of one size, and how many points they hold.
struct Pieces {
  std::vector<PlanePiece> list;
  std::size_t points = 0;
  double edge_m = kCellM;
};

Pieces pieces_of(const MortonOrder& sorted, const std::vector<std::uint32_t>& all, double cell_m) {
  const CellGrid grid(sorted, all, level_of(cell_m, kFinestM));
  Pieces pieces;
  pieces.edge_m = grid.edge_m();
  for (const Cell& cell : grid.cells()) {
    if (cell.count() < kCellPoints) continue;
    const CellShape& shape = grid.shape(cell);
    const bool planar = shape.thickness_m < kThinM && shape.spread_m > kFlat * shape.thickness_m &&
                        shape.spread_m > kFilled * grid.edge_m();
    if (!planar) continue;
    pieces.list.push_back({shape.mean + sorted.anchor, shape.normal});
    pieces.points += cell.count();
  }
  return pieces;
}

/// In cubes as large as the points are sparse.
Pieces planar_pieces(const std::vector<Vector3d>& points) {
  const MortonOrder sorted = morton_order(points, kFinestM);
  std::vector<std::uint32_t> all(points.size());
  for (std::uint32_t k = 0; k < all.size(); ++k) all[k] = k;
  Pieces best = pieces_of(sorted, all, kCellM);
  for (double cell_m = 2.0 * kCellM; cell_m <= kLargestCellM; cell_m *= 2.0) {
    if (static_cast<double>(best.points) > kEnoughShare * static_cast<double>(points.size())) break;
    Pieces coarser = pieces_of(sorted, all, cell_m);
    if (coarser.points > best.points) best = std::move(coarser);
  }
  return best;
}

/// The direction that most of the pieces left share; empty where too few do.
std::optional<Vector3d> next_direction(const std::vector<PlanePiece>& pieces, const std::vector<bool>& taken,
                                       std::size_t least) {
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (!taken[k]) left.push_back(k);
  }
  if (left.size() < least) return std::nullopt;
  const double cosine = std::cos(kSeedRad);
  const std::size_t stride = 1 + left.size() / kSeeds;
  std::size_t most = 0;
  Vector3d best = Vector3d::UnitZ();
  for (std::size_t s = 0; s < left.size(); s += stride) {
    const Vector3d& seed = pieces[left[s]].normal;
    const auto votes = static_cast<std::size_t>(std::count_if(left.begin(), left.end(), [&](std::size_t k) {
      return std::abs(pieces[k].normal.dot(seed)) > cosine;
    }));
    if (votes > most) {
      most = votes;
      best = seed;
    }
  }
  if (most < least) return std::nullopt;
  for (int round = 0; round < 3; ++round) {
    Matrix3d outer = Matrix3d::Zero();
    for (const std::size_t k : left) {
      if (std::abs(pieces[k].normal.dot(best)) > cosine)
        outer += pieces[k].normal * pieces[k].normal.transpose();
    }
    const Spectrum3 spectrum = spectrum_of(outer);
    best = spectrum.vectors.col(2);
  }
  return best;
}

/// First guesses of the planes of one direction: layers in which many of its pieces lie.
std::vector<FramePlane> layers_of(const std::vector<PlanePiece>& pieces, std::vector<std::size_t> members,
                                  const Vector3d& direction, std::size_t least, double edge_m) {
  std::vector<FramePlane> planes;
  std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
    return direction.dot(pieces[a].mean) < direction.dot(pieces[b].mean);
  });
  while (planes.size() < kMostLayers && members.size() >= least) {
    std::size_t most = 0;
    std::size_t from = 0;
    for (std::size_t begin = 0, end = 0; begin < members.size(); ++begin) {
      const double low = direction.dot(pieces[members[begin]].mean);
      while (end < members.size() && direction.dot(pieces[members[end]].mean) < low + kLayerM) ++end;
      if (end - begin > most) {
        most = end - begin;
        from = begin;
      }
    }
    if (most < least) break;
    PointMoments moments;
    for (std::size_t k = from; k < from + most; ++k) moments.add(pieces[members[k]].mean);
    Plane plane = fit_plane(moments).plane;
    if (std::abs(plane.normal.dot(direction)) < std::cos(kSeedRad))
      plane = {direction, direction.dot(moments.mean())};
    planes.push_back({plane, edge_m * edge_m * static_cast<double>(most), moments.mean()});
    std::erase_if(members,
                  [&](std::size_t k) { return std::abs(plane.signed_distance(pieces[k].mean)) < kLayerM; });
  }
  return planes;
}

/// Tukey's fit from `start`, to rest: what it rests at does not depend on where near it it started.
std::optional<FramePlane> settled(const PointColumns& points, const FramePlane& guess) {
  PointColumns near = near_plane(points, guess.plane, kGatherM);
  if (near.size() < 50) return std::nullopt;
  // About their middle, for the digits of the products.
  const auto centred = [&](std::vector<double>& values) {
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
    return mean;
  };
  const Vector3d anchor(centred(near.x), centred(near.y), centred(near.z));
  FramePlane found = guess;
  for (int round = 0; round < kSettlings; ++round) {
    const double width_m = round < 2 ? 2.0 * kTukeyM : kTukeyM;
    const Plane about{found.plane.normal, -found.plane.signed_distance(anchor)};
    const std::array<double, 10> sums = tukey_sums(near, about, width_m);
    if (sums[0] < 30.0) return std::nullopt;
    const Vector3d mean = Vector3d(sums[1], sums[2], sums[3]) / sums[0];
    Matrix3d outer;
    outer << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
    const Spectrum3 spectrum = spectrum_of(Matrix3d(outer / sums[0] - mean * mean.transpose()));
    Vector3d normal = spectrum.vectors.col(0);
    if (normal.dot(found.plane.normal) < 0) normal = -normal;
    const Vector3d middle = mean + anchor;
    const double turn = (normal - found.plane.normal).norm();
    const double shift = found.plane.signed_distance(middle);
    found.plane = {normal, normal.dot(middle)};
    found.middle = middle;
    if (round > 2 && turn < 1e-9 && std::abs(shift) < 1e-9) break;
  }
  if (found.plane.normal.dot(guess.plane.normal) < std::cos(kSeedRad)) return std::nullopt;
  return found;
}

bool same(const FramePlane& a, const FramePlane& b) {
  return std::abs(a.plane.normal.dot(b.plane.normal)) > std::cos(0.5 * kSeedRad) &&
         std::abs(a.plane.signed_distance(b.middle)) < kTukeyM;
}

}  // namespace

std::vector<FramePlane> frame_planes(const std::vector<Vector3d>& points) {
  const Pieces found = planar_pieces(points);
  const std::vector<PlanePiece>& pieces = found.list;
  const std::size_t least =
      std::max<std::size_t>(6, static_cast<std::size_t>(kLeastShare * static_cast<double>(pieces.size())));
  std::vector<bool> taken(pieces.size(), false);
  std::vector<FramePlane> starts;
  for (std::size_t round = 0; round < kMostDirections; ++round) {
    const std::optional<Vector3d> direction = next_direction(pieces, taken, least);
    if (!direction) break;
    std::vector<std::size_t> members;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (taken[k] || std::abs(pieces[k].normal.dot(*direction)) < std::cos(1.5 * kSeedRad)) continue;
      taken[k] = true;
      members.push_back(k);
    }
    const std::vector<FramePlane> layers = layers_of(pieces, members, *direction, least, found.edge_m);
    starts.insert(starts.end(), layers.begin(), layers.end());
  }
  PointColumns columns;
  for (const Vector3d& x : points) columns.add(x.x(), x.y(), x.z());
  std::vector<std::optional<FramePlane>> fits(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) fits[k] = settled(columns, starts[k]);
  });
  std::vector<FramePlane> planes;
  for (const std::optional<FramePlane>& fit : fits) {
    if (!fit) continue;
    const bool known =
        std::any_of(planes.begin(), planes.end(), [&](const FramePlane& other) { return same(other, *fit); });
    if (!known) planes.push_back(*fit);
  }
  std::stable_sort(planes.begin(), planes.end(),
                   [](const FramePlane& a, const FramePlane& b) { return a.area_m2 > b.area_m2; });
  return planes;
}

}  // namespace limen
