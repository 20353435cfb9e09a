// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/open_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/drawn_steps.h"

namespace limen {
namespace {

constexpr std::size_t kLooks = 200'000;       // points that are looked at, about
constexpr double kNearM = 0.3;                // the scanner's own stand
constexpr double kPerTurn = 36.0;             // directions
constexpr double kWayM = 2.0;                 // of a path, in one piece
constexpr std::size_t kSeenInDirection = 20;  // points: with fewer a direction does not count
constexpr std::size_t kLeastDirections = 12;
constexpr double kTopShare = 0.95;  // of the directions reach no higher than the field of view
constexpr double kBelowDeg = 10.0;
// Open sky, between what was found of rooms and of streets: of static scanners, which may see less of a hall
// than they seem to, and of those on a path.
constexpr double kOutside = 0.32;
constexpr double kOutsideOnPath = 0.2;
constexpr double kSteepDeg = -45.0;  // scanners of tripods and vehicles see at least so far down ...
constexpr double kLowDeg = -35.0;
constexpr double kLeastGround = 0.95;  // ... on this share of all sides, or of the path
constexpr double kHighDeg = 60.0;
constexpr double kOpenZenith = 0.5;  // of the sky above, in pieces of equal area or along the path ...
constexpr double kCeiling = 0.9;     // ... and more of it under a ceiling
// Of static scans.
constexpr std::size_t kRings = 3;
constexpr double kOneHeightM = 0.1;
constexpr double kRisesM = 1.0;           // above the lowest ground
constexpr double kMostAtOneHeight = 0.5;  // of all sides

constexpr double kNothing = std::numeric_limits<double>::lowest();

/// What is seen in one direction from one piece of the way: sines of elevations, or heights.
struct Column {
  std::size_t points = 0;
  std::array<double, 3> highest = {kNothing, kNothing, kNothing};  // descending

  /// The third highest: a stray point or two do not count.
  [[nodiscard]] double top() const { return highest.back(); }
  void add(double height) {
    ++points;
    for (double& one : highest) {
      if (height > one) std::swap(height, one);
    }
  }
};

std::size_t side_of(const Vector3d& ray) {
  const double turn = std::atan2(ray.y(), ray.x()) / (2.0 * std::numbers::pi) + 0.5;
  return static_cast<std::size_t>(std::min(kPerTurn - 1.0, std::floor(kPerTurn * turn)));
}

std::uint64_t piece_of(const Vector3d& centre) {
  const auto piece = [](double along) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(along / kWayM))) & 0xffffff;
  };
  return piece(centre.x()) << 24 | piece(centre.y());
}

std::uint64_t direction_of(const Vector3d& centre, const Vector3d& ray) {
  return static_cast<std::uint64_t>(side_of(ray)) << 48 | piece_of(centre);
}

bool is_ground(double sine) {
  return sine > std::sin(radians(kSteepDeg)) && sine < std::sin(radians(kLowDeg));
}

bool is_overhead(double sine) {
  return sine > std::sin(radians(kHighDeg));
}

/// Calls `use` with the scanner position and the ray, not normalised, of a part of the points.
template <typename Use>
void look_round(const Scan& scan, const Use& use) {
  for_drawn_steps(scan.size(), kLooks, [&](std::size_t i) {
    const Vector3d ray = scan.points[i] - scan.centre(i);
    if (ray.norm() > kNearM) use(scan.centre(i), ray);
  });
}

/// What a static scanner sees on each side.
struct Dome {
  static constexpr auto kSides = static_cast<std::size_t>(kPerTurn);
  std::array<bool, kSides> ground{};
  std::array<bool, kSides * kRings> zenith{};
  std::array<Column, kSides> heights{};  // above the scanner, metres
  double lowest = 0.0;

  void add(const Vector3d& ray) {
    const std::size_t side = side_of(ray);
    const double sine = ray.z() / ray.norm();
    if (is_ground(sine)) ground[side] = true;
    if (is_overhead(sine)) {
      const double high = std::sin(radians(kHighDeg));
      const auto ring = static_cast<std::size_t>((sine - high) / (1.0 - high) * static_cast<double>(kRings));
      zenith[kRings * side + std::min(ring, kRings - 1)] = true;
    }
    heights[side].add(ray.z());
    lowest = std::min(lowest, ray.z());
  }
};

template <typename Cells>
double share_of(const Cells& cells) {
  return static_cast<double>(std::count(cells.begin(), cells.end(), true)) /
         static_cast<double>(cells.size());
}

/// The largest share of sides on which what rises above the ground ends at one height.
double share_at_one_height(const Dome& dome) {
  std::vector<double> tops;
  for (const Column& side : dome.heights) {
    if (side.top() > dome.lowest + kRisesM) tops.push_back(side.top());
  }
  std::sort(tops.begin(), tops.end());
  std::ptrdiff_t most = 0;
  for (auto low = tops.begin(); low != tops.end(); ++low)
    most = std::max(most, std::upper_bound(low, tops.end(), *low + kOneHeightM) - low);
  return static_cast<double>(most) / kPerTurn;
}

Surroundings of_static(const Scan& scan) {
  Dome dome;
  look_round(scan, [&](const Vector3d&, const Vector3d& ray) { dome.add(ray); });
  if (share_of(dome.ground) < kLeastGround) return Surroundings::unknown;
  const double above = share_of(dome.zenith);
  if (above > kCeiling) return Surroundings::inside;
  const bool open =
      above < kOpenZenith && open_sky_share(scan) > kOutside && share_at_one_height(dome) <= kMostAtOneHeight;
  return open ? Surroundings::outside : Surroundings::unknown;
}

Surroundings of_path(const Scan& scan) {
  if (open_sky_share(scan) <= kOutsideOnPath) return Surroundings::inside;
  struct Seen {
    bool ground = false;
    bool overhead = false;
  };
  std::unordered_map<std::uint64_t, Seen> path;
  look_round(scan, [&](const Vector3d& centre, const Vector3d& ray) {
    Seen& seen = path[piece_of(centre)];
    const double sine = ray.z() / ray.norm();
    seen.ground = seen.ground || is_ground(sine);
    seen.overhead = seen.overhead || is_overhead(sine);
  });
  const auto share = [&](bool Seen::*what) {
    const auto count =
        std::count_if(path.begin(), path.end(), [&](const auto& piece) { return piece.second.*what; });
    return static_cast<double>(count) / static_cast<double>(path.size());
  };
  const bool open = share(&Seen::ground) >= kLeastGround && share(&Seen::overhead) < kOpenZenith;
  return open ? Surroundings::outside : Surroundings::unknown;
}

}  // namespace

double open_sky_share(const Scan& scan) {
  std::unordered_map<std::uint64_t, Column> columns;
  look_round(scan, [&](const Vector3d& centre, const Vector3d& ray) {
    columns[direction_of(centre, ray)].add(ray.z() / ray.norm());
  });
  std::vector<double> heights;  // degrees
  for (const auto& [direction, column] : columns) {
    if (column.points >= kSeenInDirection) heights.push_back(degrees(std::asin(column.top())));
  }
  if (heights.size() < kLeastDirections) return 0.0;
  std::sort(heights.begin(), heights.end());
  const double top = heights[static_cast<std::size_t>(kTopShare * static_cast<double>(heights.size() - 1))];
  const auto open = std::lower_bound(heights.begin(), heights.end(), top - kBelowDeg) - heights.begin();
  return static_cast<double>(open) / static_cast<double>(heights.size());
}

Surroundings surroundings_of(const Scan& scan) {
  if (!scan.level || !scan.centre_known()) return Surroundings::unknown;
  return scan.mobile() ? of_path(scan) : of_static(scan);
}

Surroundings common(Surroundings a, Surroundings b) {
  return a == b ? a : Surroundings::unknown;
}

}  // namespace limen
