// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/kept_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <cmath>
#include <iterator>
#include <numbers>

#include "limen/base/parallel.h"
#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::size_t kPerPiece = 65536;
constexpr double kNearlyAll = 0.8;           // share kept above which nothing is gained
constexpr double kCubeM = 1e-3;              // points in one cube share their lot
constexpr std::size_t kDirectionCells = 32;  // along an edge of the cube of directions
constexpr unsigned kBinBits = 48;            // of a squared range, as it is stored, that are below its bin's
constexpr std::size_t kRangeBins = 1024;     // sixteen per doubling of the squared range
constexpr double kNearestM2 = 1e-4;
const std::uint64_t kFirstBin = std::bit_cast<std::uint64_t>(kNearestM2) >> kBinBits;

using Directions = std::bitset<6 * kDirectionCells * kDirectionCells>;
using RangeCounts = std::array<std::size_t, kRangeBins>;  // by the logarithm of the squared range

/// Which directions a scanner saw something in, and how far off its points are.
struct Ranges {
  Directions seen;
  RangeCounts counts{};
};

constexpr double kWayCellM = 1.0;
using WayCell = std::array<std::int32_t, 3>;

/// Where a scanner went, and how far off its points are.
struct WayRanges {
  std::vector<WayCell> cells;  ///< each once, sorted
  RangeCounts counts{};
};

/// With what probability a point at a squared range is kept; 1 where it is more.
struct KeepLaw {
  double rate = 0.0;  ///< in 1/m², along a way in 1/m
  bool along_way = false;

  double operator()(double squared_m2) const {
    return rate * (along_way ? std::sqrt(squared_m2) : squared_m2);
  }
};

std::size_t range_bin(double squared_m2) {
  const std::uint64_t bin = std::bit_cast<std::uint64_t>(std::max(squared_m2, kNearestM2)) >> kBinBits;
  return std::min<std::size_t>(kRangeBins - 1, bin - kFirstBin);
}

double squared_range_of(std::size_t bin) {
  const std::uint64_t middle = (2 * (kFirstBin + bin) + 1) << (kBinBits - 1);
  return std::bit_cast<double>(middle);
}

std::size_t along_edge(double tangent) {
  const auto cells = static_cast<double>(kDirectionCells);
  return static_cast<std::size_t>(std::clamp(0.5 * cells * (tangent + 1.0), 0.0, cells - 1.0));
}

/// The cell of the cube of directions that `ray`, not of no length, goes through.
std::size_t direction_cell(const Vector3d& ray) {
  Eigen::Index axis = 0;
  const double length = ray.cwiseAbs().maxCoeff(&axis);
  const std::size_t face = 2 * static_cast<std::size_t>(axis) + (ray[axis] < 0.0 ? 1 : 0);
  const std::size_t u = along_edge(ray[(axis + 1) % 3] / length);
  const std::size_t v = along_edge(ray[(axis + 2) % 3] / length);
  return (face * kDirectionCells + u) * kDirectionCells + v;
}

/// Solid angle of a direction's cell, about: a face is seen ever more askew towards its edge.
double solid_angle(std::size_t cell) {
  const auto middle = [](std::size_t k) {
    return 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(kDirectionCells) - 1.0;
  };
  const double u = middle(cell / kDirectionCells % kDirectionCells);
  const double v = middle(cell % kDirectionCells);
  const double edge = 2.0 / static_cast<double>(kDirectionCells);
  return edge * edge / std::pow(1.0 + u * u + v * v, 1.5);
}

double seen_solid_angle(const Directions& seen) {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < seen.size(); ++cell) sum += seen[cell] ? solid_angle(cell) : 0.0;
  return sum;
}

Ranges ranges_of(const Scan& scan, const Matrix3d& frame_from_scan, const Vector3d& centre) {
  return parallel_reduce(
      scan.size(), kPerPiece, Ranges{},
      [&](std::size_t begin, std::size_t end) {
        Ranges part;
        for (std::size_t i = begin; i < end; ++i) {
          const Vector3d ray = frame_from_scan * (scan.points[i] - centre);
          const double squared = ray.squaredNorm();
          ++part.counts[range_bin(squared)];
          if (squared > 0.0) part.seen.set(direction_cell(ray));
        }
        return part;
      },
      [](Ranges a, const Ranges& b) {
        a.seen |= b.seen;
        for (std::size_t k = 0; k < kRangeBins; ++k) a.counts[k] += b.counts[k];
        return a;
      });
}

double kept_of(const RangeCounts& counts, const KeepLaw& law) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kRangeBins; ++k)
    sum += static_cast<double>(counts[k]) * std::min(1.0, law(squared_range_of(k)));
  return sum;
}

/// The law, with a rate that keeps no more than `most` (0: any number).
KeepLaw bounded(KeepLaw law, const RangeCounts& counts, std::size_t most) {
  if (most == 0 || kept_of(counts, law) <= static_cast<double>(most)) return law;
  double low = 0.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + law.rate);
    (kept_of(counts, {middle, law.along_way}) <= static_cast<double>(most) ? low : law.rate) = middle;
  }
  return {low, law.along_way};
}

KeepLaw law_for(const Ranges& ranges, std::size_t size, const KeepOptions& options) {
  KeepLaw law{1.0 / kNearestM2, false};
  if (options.most_per_m2 > 0.0)
    law.rate = options.most_per_m2 * seen_solid_angle(ranges.seen) / static_cast<double>(size);
  return bounded(law, ranges.counts, options.most_points);
}

std::vector<WayCell> united(const std::vector<WayCell>& a, const std::vector<WayCell>& b) {
  std::vector<WayCell> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

WayRanges way_of(const Scan& scan, const ScanFrame& frame) {
  return parallel_reduce(
      scan.size(), kPerPiece, WayRanges{},
      [&](std::size_t begin, std::size_t end) {
        WayRanges part;
        for (std::size_t i = begin; i < end; ++i) {
          ++part.counts[range_bin((scan.points[i] - scan.centres[i]).squaredNorm())];
          const Vector3d x = frame.frame_from_scan * (scan.centres[i] - frame.corner) / kWayCellM;
          const WayCell cell{static_cast<std::int32_t>(std::floor(x.x())),
                             static_cast<std::int32_t>(std::floor(x.y())),
                             static_cast<std::int32_t>(std::floor(x.z()))};
          if (part.cells.empty() || part.cells.back() != cell) part.cells.push_back(cell);
        }
        std::sort(part.cells.begin(), part.cells.end());
        part.cells.erase(std::unique(part.cells.begin(), part.cells.end()), part.cells.end());
        return part;
      },
      [](WayRanges a, const WayRanges& b) {
        a.cells = united(a.cells, b.cells);
        for (std::size_t k = 0; k < kRangeBins; ++k) a.counts[k] += b.counts[k];
        return a;
      });
}

/// Half of the surface that was seen lies within this range: along a way a point at range r represents a
/// surface that grows with r.
double middle_range_m(const RangeCounts& counts) {
  std::array<double, kRangeBins> up_to{};
  double sum = 0.0;
  for (std::size_t k = 0; k < kRangeBins; ++k) {
    sum += static_cast<double>(counts[k]) * std::sqrt(squared_range_of(k));
    up_to[k] = sum;
  }
  const auto middle = std::lower_bound(up_to.begin(), up_to.end(), 0.5 * sum);
  return std::sqrt(squared_range_of(static_cast<std::size_t>(middle - up_to.begin())));
}

/// Lines all round, of which about half meet something, evenly along a way of length L, lay
/// N / (pi L r) points on a square metre that faces them at range r.
KeepLaw law_along_way(const WayRanges& way, std::size_t size, const KeepOptions& options) {
  KeepLaw law{1.0 / std::sqrt(kNearestM2), true};
  if (options.most_per_m2_of_way > 0.0) {
    const double length_m = kWayCellM * static_cast<double>(way.cells.size());
    const double asked = options.most_per_m2_of_way * std::numbers::pi * length_m / static_cast<double>(size);
    law.rate = std::max(asked, 1.0 / middle_range_m(way.counts));
  }
  return bounded(law, way.counts, options.most_points);
}

/// A number in [0, 1) that the place in the frame decides.
double lot_of(const Vector3d& in_frame) {
  constexpr double kFarM = 1e9;  // farther than anything lies
  const auto cell = [](double x) { return static_cast<std::uint64_t>((x + kFarM) / kCubeM); };
  return unit_lot(mix64(cell(in_frame.x()) + mix64(cell(in_frame.y()) + mix64(cell(in_frame.z())))));
}

/// Those whose lot is below probability(index).
template <typename Probability>
std::vector<std::uint32_t> drawn(const Scan& scan, const ScanFrame& frame, const Probability& probability) {
  std::vector<std::vector<std::uint32_t>> pieces((scan.size() + kPerPiece - 1) / kPerPiece);
  parallel_for(scan.size(), kPerPiece, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& piece = pieces[begin / kPerPiece];
    for (std::size_t i = begin; i < end; ++i) {
      const double p = probability(i);
      if (p >= 1.0 || lot_of(frame.frame_from_scan * (scan.points[i] - frame.corner)) < p)
        piece.push_back(static_cast<std::uint32_t>(i));
    }
  });
  std::vector<std::uint32_t> kept;
  std::size_t total = 0;
  for (const auto& piece : pieces) total += piece.size();
  kept.reserve(total);
  for (const auto& piece : pieces) kept.insert(kept.end(), piece.begin(), piece.end());
  return kept;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> kept_points(const Scan& scan, const ScanFrame& frame,
                                                      const KeepOptions& options) {
  const auto size = static_cast<double>(scan.size());
  if (scan.size() == 0) return std::nullopt;
  if (scan.mobile()) {
    if (options.most_points == 0 && options.most_per_m2_of_way == 0.0) return std::nullopt;
    const WayRanges way = way_of(scan, frame);
    const KeepLaw law = law_along_way(way, scan.size(), options);
    if (kept_of(way.counts, law) > kNearlyAll * size) return std::nullopt;
    return drawn(scan, frame,
                 [&](std::size_t i) { return law((scan.points[i] - scan.centres[i]).squaredNorm()); });
  }
  if (frame.place.source == PlaceSource::unknown) {
    const double share = static_cast<double>(options.most_points) / size;
    if (options.most_points == 0 || share > kNearlyAll) return std::nullopt;
    return drawn(scan, frame, [&](std::size_t /*point*/) { return share; });
  }
  if (options.most_points == 0 && options.most_per_m2 == 0.0) return std::nullopt;
  const Vector3d& centre = frame.place.centre;
  const Ranges ranges = ranges_of(scan, frame.frame_from_scan, centre);
  const KeepLaw law = law_for(ranges, scan.size(), options);
  if (kept_of(ranges.counts, law) > kNearlyAll * size) return std::nullopt;
  return drawn(scan, frame, [&](std::size_t i) { return law((scan.points[i] - centre).squaredNorm()); });
}

}  // namespace limen
