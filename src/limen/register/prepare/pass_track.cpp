// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/pass_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "limen/geometry/spline_motion.h"

namespace limen {
namespace {

constexpr double kKnotM = 2.5;   // between knots, about
constexpr int kMostSpans = 400;  // the whole of a pass is a mean over its knots: the square of their number
constexpr double kLeastWayM = 10.0;   // a shorter one hardly drifts
constexpr double kMomentS = 0.05;     // places of one moment are averaged
constexpr double kStepM = 0.25;       // what is less is no way but noise of the trajectory
constexpr double kMostMoments = 4e6;  // a gap of years is no reason to run out of memory
constexpr double kTrackTileM = 0.25;  // points of a tile count as one
constexpr double kStripM = 2.0;       // a strip lies in a cube of this size
constexpr double kStripsPerKnot = 1.0;
constexpr std::size_t kMostLooked = 4000000;
constexpr double kLeastTiles = 4.0;

/// Where the scanner was, moment by moment.
struct Moments {
  std::vector<double> times_s;
  std::vector<Vector3d> places;
};

Moments moments_of(const Scan& laid) {
  const auto [first, last] = std::minmax_element(laid.times_s.begin(), laid.times_s.end());
  const double width = std::max(kMomentS, (*last - *first) / kMostMoments);
  const auto count = static_cast<std::size_t>((*last - *first) / width) + 1;
  std::vector<Vector3d> sums(count, Vector3d::Zero());
  std::vector<double> times(count, 0.0);
  std::vector<double> points(count, 0.0);
  for (std::size_t i = 0; i < laid.size(); ++i) {
    const auto at = std::min(count - 1, static_cast<std::size_t>((laid.times_s[i] - *first) / width));
    sums[at] += laid.centres[i];
    times[at] += laid.times_s[i] - *first;
    points[at] += 1.0;
  }
  Moments moments;
  for (std::size_t k = 0; k < count; ++k) {
    if (points[k] == 0.0) continue;
    moments.times_s.push_back(*first + times[k] / points[k]);
    moments.places.emplace_back(sums[k] / points[k]);
  }
  return moments;
}

/// Knots at even distances along the way from moment to moment.
PassWay way_of(const Moments& moments) {
  std::vector<double> times{moments.times_s.front()};
  std::vector<double> distances{0.0};
  std::vector<Vector3d> places{moments.places.front()};
  for (std::size_t k = 1; k < moments.times_s.size(); ++k) {
    const double step = (moments.places[k] - places.back()).norm();
    if (step < kStepM) continue;
    times.push_back(moments.times_s[k]);
    distances.push_back(distances.back() + step);
    places.push_back(moments.places[k]);
  }
  PassWay way;
  if (distances.back() < kLeastWayM) return way;
  // What came after the last step is part of the way.
  times.back() = std::max(times.back(), moments.times_s.back());
  const auto spans = static_cast<int>(std::clamp(distances.back() / kKnotM + 0.5, 2.0, double{kMostSpans}));
  for (int k = 0; k <= spans; ++k) {
    const double at = place_among(distances, distances.back() * k / spans);
    const auto before = std::min(static_cast<std::size_t>(at), times.size() - 2);
    const double share = at - static_cast<double>(before);
    way.times_s.push_back((1.0 - share) * times[before] + share * times[before + 1]);
    way.distances_m.push_back((1.0 - share) * distances[before] + share * distances[before + 1]);
    way.places.emplace_back((1.0 - share) * places[before] + share * places[before + 1]);
  }
  return way;
}

using Cube = std::array<std::int32_t, 3>;
Cube cube_of(const Vector3d& x, double size_m) {
  Cube cube{};
  for (Eigen::Index k = 0; k < 3; ++k)
    cube[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::floor(x[k] / size_m));
  return cube;
}

/// A point of a plane: to which strip and tile it belongs.
struct Placed {
  std::int32_t plane = 0;
  std::int32_t part = 0;  ///< of the way
  Cube strip{};
  Cube tile{};
  std::uint32_t point = 0;

  [[nodiscard]] auto strip_key() const { return std::tie(plane, part, strip); }
  [[nodiscard]] bool operator<(const Placed& other) const {
    return std::tie(plane, part, strip, tile, point) <
           std::tie(other.plane, other.part, other.strip, other.tile, other.point);
  }
};

std::vector<Placed> placed_points(const Scan& laid, const ExtractedFeatures& extracted, const PassWay& way) {
  const std::size_t stride = 1 + laid.size() / kMostLooked;
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < laid.size(); i += stride) {
    if (extracted.labels[i] < 0) continue;
    const double at = place_among(way.times_s, laid.times_s[i]);
    placed.push_back({extracted.labels[i], static_cast<std::int32_t>(kStripsPerKnot * at),
                      cube_of(laid.points[i], kStripM), cube_of(laid.points[i], kTrackTileM),
                      static_cast<std::uint32_t>(i)});
  }
  std::sort(placed.begin(), placed.end());
  return placed;
}

/// The strip of the points [begin, end), tile by tile.
PassStrip strip_of(const std::vector<Placed>& placed, std::size_t begin, std::size_t end, const Scan& laid,
                   const PassWay& way) {
  PassStrip strip;
  strip.plane = placed[begin].plane;
  strip.anchor = laid.points[placed[begin].point];
  double places = 0.0;
  for (std::size_t from = begin; from < end;) {
    std::size_t to = from;
    Vector3d sum = Vector3d::Zero();
    double time = 0.0;
    for (; to < end && placed[to].tile == placed[from].tile; ++to) {
      sum += laid.points[placed[to].point] - strip.anchor;
      time += laid.times_s[placed[to].point] - way.times_s.front();
    }
    const auto count = static_cast<double>(to - from);
    strip.moments.add(sum / count);
    places += place_among(way.times_s, way.times_s.front() + time / count);
    from = to;
  }
  strip.place = places / strip.moments.count;
  return strip;
}

}  // namespace

PassTrack find_pass_track(const Scan& laid, const ExtractedFeatures& extracted) {
  PassTrack track;
  if (!laid.mobile() || laid.times_s.size() != laid.size() || laid.size() < 2) return track;
  const auto finite = [](double time_s) { return std::isfinite(time_s); };
  if (!std::all_of(laid.times_s.begin(), laid.times_s.end(), finite)) return track;
  track.way = way_of(moments_of(laid));
  if (!track.way.known()) return track;
  const std::vector<Placed> placed = placed_points(laid, extracted, track.way);
  for (std::size_t begin = 0; begin < placed.size();) {
    std::size_t end = begin;
    while (end < placed.size() && placed[end].strip_key() == placed[begin].strip_key()) ++end;
    PassStrip strip = strip_of(placed, begin, end, laid, track.way);
    if (strip.moments.count >= kLeastTiles) track.strips.push_back(strip);
    begin = end;
  }
  return track;
}

PassTrack find_static_track(const Features& features) {
  std::map<std::pair<std::int32_t, Cube>, PassStrip> strips;
  for (const SurfaceSample& sample : features.samples) {
    if (sample.plane < 0) continue;
    const auto [at, fresh] = strips.try_emplace({sample.plane, cube_of(sample.mean, kStripM)}, PassStrip{});
    PassStrip& strip = at->second;
    if (fresh) {
      strip.plane = sample.plane;
      strip.anchor = sample.mean;
    }
    strip.moments.add(sample.mean - strip.anchor);
  }
  PassTrack track;
  for (const auto& [key, strip] : strips) {
    if (strip.moments.count >= kLeastTiles) track.strips.push_back(strip);
  }
  return track;
}

}  // namespace limen
