// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/targets/find_targets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/extract/cells/cell_runs.h"
#include "limen/extract/targets/fit_targets.h"
#include "limen/geometry/cell_key.h"
#include "limen/geometry/points_apart.h"

namespace limen {
namespace {

/// Where a target may be; the largest worth of those near one another is looked at.
struct TargetCandidate {
  Vector3d centre = Vector3d::Zero();  ///< about the scanner
  double worth = 0.0;
};

/// About one point in each square of `width_m`, as the scanner sees it: of directions, not of space, where
/// noise would fill several layers and make the few far ones count as much as the many. The last squares are
/// remembered, and scans come in lines.
std::vector<std::uint32_t> thinned_by_direction(const Scan& scan, double width_m) {
  constexpr std::size_t kRemembered = std::size_t{1} << 21U;
  std::vector<std::int64_t> known(kRemembered, -1);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d point = scan.points[i] - scan.centre(0);
    const double range = point.norm();
    if (!(range > 0.0 && range < 1e4)) continue;
    const std::int64_t key = cell_key(cell_of(std::scalbn(1.0, std::ilogb(range)) / range * point, width_m));
    std::int64_t& slot = known[mix64(static_cast<std::uint64_t>(key)) & (kRemembered - 1)];
    if (slot == key) continue;
    slot = key;
    kept.push_back(static_cast<std::uint32_t>(i));
  }
  return kept;
}

/// Looks for one kind of target: thinned points propose candidates, all points in the cones of the best
/// decide.
class TargetSearch {
 public:
  TargetSearch(const Scan& scan, double size_m) : scan_(scan), eye_(scan.centre(0)), size_m_(size_m) {}
  virtual ~TargetSearch() = default;
  TargetSearch(const TargetSearch&) = delete;
  TargetSearch& operator=(const TargetSearch&) = delete;

  std::vector<FoundTarget> run(double thin_m, double seeds_m, double reach_m) {
    const std::vector<TargetCandidate> candidates = best_of(propose(thin_m, seeds_m, reach_m));
    const std::vector<std::vector<std::uint32_t>> cones = cones_of(candidates);
    std::vector<std::optional<FoundTarget>> decided(candidates.size());
    parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) decided[k] = decide(candidates[k].centre, cones[k]);
    });
    std::vector<FoundTarget> found;
    for (const std::optional<FoundTarget>& target : decided) {
      if (target) found.push_back(*target);
    }
    return without_overlaps(std::move(found));
  }

 protected:
  using Indices = std::vector<std::uint32_t>;
  /// Candidates at some of the points `seeds`, by the points about.
  [[nodiscard]] virtual std::vector<TargetCandidate> candidates_at(const Indices& seeds,
                                                                   const Indices& about) const = 0;
  [[nodiscard]] virtual std::optional<FoundTarget> decide(const Vector3d& centre,
                                                          const Indices& cone) const = 0;
  /// Of targets nearer to one another than this only one can be there.
  [[nodiscard]] double size_m() const { return size_m_; }
  [[nodiscard]] const Scan& scan() const { return scan_; }
  [[nodiscard]] Vector3d point(std::uint32_t i) const { return scan_.points[i] - eye_; }
  template <typename Made>
  [[nodiscard]] static auto made_of(const Indices& indices, const Made& made) {
    std::vector<decltype(made(0U))> all;
    all.reserve(indices.size());
    for (const std::uint32_t i : indices) all.push_back(made(i));
    return all;
  }

 private:
  static constexpr double kCone = 1.5;         ///< of the size: half the width of a candidate's cone
  static constexpr double kDirections = 0.04;  ///< edge of the cubes that directions are sorted into
  static constexpr double kLeastRangeM = 0.4;

  [[nodiscard]] std::vector<TargetCandidate> propose(double thin_m, double seeds_m, double reach_m) const {
    const std::vector<std::uint32_t> thin = thinned_by_direction(scan_, thin_m);
    std::vector<Vector3d> places;
    places.reserve(thin.size());
    for (const std::uint32_t i : thin) places.push_back(scan_.points[i]);
    const MortonOrder sorted = morton_order(places, reach_m);
    const CellRuns cubes(sorted, 0);
    constexpr std::size_t kGrain = 256;
    std::vector<std::vector<TargetCandidate>> parts((cubes.size() + kGrain - 1) / kGrain);
    parallel_for(cubes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t cube = begin; cube < end; ++cube) {
        std::vector<std::uint32_t> own;
        for (std::uint32_t k = cubes.begin(cube); k < cubes.end(cube); ++k)
          own.push_back(thin[sorted.index(k)]);
        std::vector<std::uint32_t> about = own;
        for (const std::int32_t other : cubes.neighbours(cube)) {
          const auto next = static_cast<std::size_t>(other);
          for (std::uint32_t k = cubes.begin(next); k < cubes.end(next); ++k)
            about.push_back(thin[sorted.index(k)]);
        }
        const std::vector<TargetCandidate> more = candidates_at(seeds_of(own, seeds_m), about);
        parts[begin / kGrain].insert(parts[begin / kGrain].end(), more.begin(), more.end());
      }
    });
    std::vector<TargetCandidate> candidates;
    for (const std::vector<TargetCandidate>& part : parts)
      candidates.insert(candidates.end(), part.begin(), part.end());
    return candidates;
  }

  /// The first of the points in each small cube.
  [[nodiscard]] std::vector<std::uint32_t> seeds_of(const std::vector<std::uint32_t>& own,
                                                    double seeds_m) const {
    std::vector<std::pair<std::int64_t, std::uint32_t>> keys;
    for (const std::uint32_t i : own) keys.emplace_back(cell_key(cell_of(scan_.points[i], seeds_m)), i);
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> seeds;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const std::uint32_t i = keys[k].second;
      if ((k == 0 || keys[k].first != keys[k - 1].first) && point(i).norm() > kLeastRangeM)
        seeds.push_back(i);
    }
    return seeds;
  }

  /// Those that are worth most among their neighbours.
  [[nodiscard]] std::vector<TargetCandidate> best_of(std::vector<TargetCandidate> all) const {
    std::sort(all.begin(), all.end(), [](const TargetCandidate& a, const TargetCandidate& b) {
      return std::tuple(-a.worth, a.centre.x(), a.centre.y(), a.centre.z()) <
             std::tuple(-b.worth, b.centre.x(), b.centre.y(), b.centre.z());
    });
    PointsApart taken(0.4 * size_m_);
    std::vector<TargetCandidate> best;
    for (const TargetCandidate& candidate : all) {
      if (taken.add(candidate.centre)) best.push_back(candidate);
    }
    return best;
  }

  /// What a candidate takes up of the unit sphere.
  struct Cone {
    Vector3d direction;
    double half = 0.0;
  };

  /// All points in the cone of each candidate.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> cones_of(
      const std::vector<TargetCandidate>& candidates) const {
    std::vector<Cone> asked;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> by_direction;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const Vector3d& centre = candidates[k].centre;
      asked.push_back({centre.normalized(), kCone * size_m_ / centre.norm()});
      const auto& [direction, half] = asked.back();
      const Vector3d low = cell_of(direction - Vector3d::Constant(half), kDirections);
      const Vector3d high = cell_of(direction + Vector3d::Constant(half), kDirections);
      for (double x = low.x(); x <= high.x(); ++x) {
        for (double y = low.y(); y <= high.y(); ++y) {
          for (double z = low.z(); z <= high.z(); ++z)
            by_direction[cell_key({x, y, z})].push_back(static_cast<std::uint32_t>(k));
        }
      }
    }
    std::vector<std::vector<std::uint32_t>> cones(candidates.size());
    if (candidates.empty()) return cones;
    using Found = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    constexpr std::size_t kGrain = 65536;
    std::vector<Found> parts((scan_.size() + kGrain - 1) / kGrain);
    parallel_for(scan_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vector3d direction = point(static_cast<std::uint32_t>(i)).normalized();
        const auto near = by_direction.find(cell_key(cell_of(direction, kDirections)));
        if (near == by_direction.end()) continue;
        for (const std::uint32_t k : near->second) {
          if ((direction - asked[k].direction).norm() < asked[k].half)
            parts[begin / kGrain].emplace_back(k, static_cast<std::uint32_t>(i));
        }
      }
    });
    for (const Found& part : parts) {
      for (const auto& [k, i] : part) cones[k].push_back(i);
    }
    return cones;
  }

  /// Two candidates may have led to one target; targets that overlap are none. By place.
  [[nodiscard]] std::vector<FoundTarget> without_overlaps(std::vector<FoundTarget> found) const {
    std::sort(found.begin(), found.end(), [](const FoundTarget& a, const FoundTarget& b) {
      return std::tuple(a.centre.x(), a.centre.y(), a.centre.z()) <
             std::tuple(b.centre.x(), b.centre.y(), b.centre.z());
    });
    std::vector<FoundTarget> kept;
    for (std::size_t a = 0; a < found.size(); ++a) {
      bool alone = true;
      for (std::size_t b = 0; b < found.size(); ++b) {
        const double distance_m = (found[a].centre - found[b].centre).norm();
        const bool same = distance_m < 0.1 * size_m_;
        if (a != b && distance_m < 1.8 * size_m_ && !(same && a < b)) alone = false;
      }
      if (!alone) continue;
      kept.push_back(found[a]);
      kept.back().centre += eye_;
    }
    return kept;
  }

  const Scan& scan_;
  Vector3d eye_;
  double size_m_;
};

class SphereSearch : public TargetSearch {
 public:
  SphereSearch(const Scan& scan, double radius_m) : TargetSearch(scan, radius_m) {}

 protected:
  [[nodiscard]] std::vector<TargetCandidate> candidates_at(const Indices& seeds,
                                                           const Indices& about) const override {
    const std::vector<Vector3d> points = points_of(about);
    std::vector<TargetCandidate> candidates;
    for (const std::uint32_t seed : seeds) {
      if (const std::optional<SphereGuess> guess = guess_sphere(point(seed), points, size_m()))
        candidates.push_back({guess->centre, static_cast<double>(guess->points)});
    }
    return candidates;
  }

  [[nodiscard]] std::optional<FoundTarget> decide(const Vector3d& centre,
                                                  const Indices& cone) const override {
    return fit_sphere(centre, points_of(cone), size_m());
  }

 private:
  [[nodiscard]] std::vector<Vector3d> points_of(const Indices& indices) const {
    return made_of(indices, [this](std::uint32_t i) { return point(i); });
  }
};

class BoardSearch : public TargetSearch {
 public:
  BoardSearch(const Scan& scan, double side_m) : TargetSearch(scan, side_m) {}

 protected:
  [[nodiscard]] std::vector<TargetCandidate> candidates_at(const Indices& seeds,
                                                           const Indices& about) const override {
    const std::vector<LitPoint> points = points_of(about);
    std::vector<TargetCandidate> candidates;
    for (const std::uint32_t seed : seeds) {
      const double likeness = board_likeness(point(seed), points, size_m());
      if (likeness > 0.0) candidates.push_back({point(seed), likeness});
    }
    return candidates;
  }

  [[nodiscard]] std::optional<FoundTarget> decide(const Vector3d& centre,
                                                  const Indices& cone) const override {
    return fit_board(centre, points_of(cone), size_m());
  }

 private:
  [[nodiscard]] std::vector<LitPoint> points_of(const Indices& indices) const {
    return made_of(indices, [this](std::uint32_t i) { return LitPoint{point(i), light(i)}; });
  }

  [[nodiscard]] double light(std::uint32_t i) const {
    if (!scan().intensities.empty()) return static_cast<double>(scan().intensities[i]);
    const std::uint8_t* colour = &scan().colours[std::size_t{3} * i];
    return 0.299 * colour[0] + 0.587 * colour[1] + 0.114 * colour[2];
  }
};

}  // namespace

void TargetOptions::check() const {
  constexpr double kLeast = 0.02;
  constexpr double kMost = 1.0;
  const auto possible = [](double size) { return size == 0.0 || (size >= kLeast && size <= kMost); };
  if (!possible(sphere_radius_m)) throw_bad_option("sphere_radius_m", sphere_radius_m, "between 0.02 and 1");
  if (!possible(board_side_m)) throw_bad_option("board_side_m", board_side_m, "between 0.02 and 1");
}

std::vector<FoundTarget> find_targets(const Scan& scan, const TargetOptions& options) {
  options.check();
  std::vector<FoundTarget> found;
  if (scan.centres.size() != 1) return found;
  if (const double radius = options.sphere_radius_m; radius > 0.0)
    found = SphereSearch(scan, radius).run(radius / 6.0, 0.5 * radius, radius);
  const bool lit = !scan.intensities.empty() || !scan.colours.empty();
  if (const double side = options.board_side_m; lit && side > 0.0) {
    const std::vector<FoundTarget> boards = BoardSearch(scan, side).run(side / 20.0, side / 6.0, 0.5 * side);
    found.insert(found.end(), boards.begin(), boards.end());
  }
  return found;
}

}  // namespace limen
