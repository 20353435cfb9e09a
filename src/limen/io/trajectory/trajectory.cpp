// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kSamePlaceM = 0.01;
constexpr double kWeekS = 604800.0;
/// "Adjusted standard" GPS time is GPS time less this.
constexpr double kAdjustmentS = 1e9;
constexpr std::size_t kTimesPerPiece = 16384;

struct TimeRange {
  double first = 0.0;
  double last = 0.0;
};

bool overlap(const TimeRange& a, const TimeRange& b) {
  return a.first <= b.last && b.first <= a.last;
}

/// What to add to the times of a trajectory in seconds of the GPS week, so that they meet those of a scan in
/// adjusted or whole GPS time, or the other way round; empty where nothing of the kind helps.
std::optional<double> helpful_offset(const TimeRange& scan, const TimeRange& trajectory) {
  for (const double base : {0.0, -kAdjustmentS, kAdjustmentS}) {
    const double middle = 0.5 * (scan.first + scan.last - trajectory.first - trajectory.last);
    const double weeks = std::round((middle - base) / kWeekS);
    const double offset = base + weeks * kWeekS;
    if (overlap(scan, {trajectory.first + offset, trajectory.last + offset})) return offset;
  }
  return {};
}

[[noreturn]] void no_overlap(const Scan& scan, const TimeRange& range, const Trajectory& trajectory) {
  const TimeRange there{trajectory.first_s(), trajectory.last_s()};
  std::string remedy = fmt::format(
      "times may be seconds of the GPS week in one and adjusted standard GPS time (GPS seconds less 1e9) in "
      "the other: give what to add to those of the trajectory with --{}trajectory-time-offset-s",
      trajectory.option_side());
  if (const auto offset = helpful_offset(range, there))
    remedy += fmt::format("; changed by {:+.0f} s they would overlap", *offset);
  throw Error(fmt::format("the times of the points, {:.3f} to {:.3f} s, and of the trajectory {}, {:.3f} to "
                          "{:.3f} s, do not overlap",
                          range.first, range.last, trajectory.name(), there.first, there.last),
              scan.name, remedy);
}

/// Throws Error where the median distance of points to their scanner positions is too large: the trajectory
/// and the points are then in different frames.
void require_near(const Scan& scan, const Trajectory& trajectory) {
  const double range_m = median_range(scan);
  if (range_m <= kFarthestRangeM) return;
  throw Error(
      fmt::format("the trajectory {} is {:.0f} km away from the points", trajectory.name(), range_m / 1e3),
      scan.name,
      fmt::format("bring both into one frame, or give the UTM zone of the points with --{}utm-zone",
                  trajectory.option_side()));
}

}  // namespace

Trajectory::Trajectory(const std::vector<double>& times_s, const std::vector<Vector3d>& positions,
                       std::string name, double max_gap_s, std::string option_side)
    : name_(std::move(name)), max_gap_s_(max_gap_s), option_side_(std::move(option_side)) {
  std::vector<std::size_t> order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const std::size_t i : order) {
    if (std::isfinite(times_s[i]) && positions[i].allFinite()) continue;
    throw Error(fmt::format("entry {} of the trajectory is not a finite time and position", i + 1), name_,
                "remove it");
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return times_s[a] < times_s[b]; });
  for (const std::size_t i : order) {
    if (!times_s_.empty() && times_s_.back() == times_s[i]) {
      if ((positions_.back() - positions[i]).norm() <= kSamePlaceM) continue;
      throw Error(fmt::format("the trajectory has two positions at the time {:.6f} s", times_s[i]), name_,
                  "export the trajectory of one sensor, with all digits of its times");
    }
    times_s_.push_back(times_s[i]);
    positions_.push_back(positions[i]);
  }
  if (times_s_.size() < 2)
    throw Error("a trajectory needs positions at two times or more", name_, "check how it was exported");
}

std::optional<Vector3d> Trajectory::position(double time_s) const {
  if (!(time_s >= times_s_.front() && time_s <= times_s_.back())) return {};
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  if (after == times_s_.end()) return positions_.back();
  const auto k = static_cast<std::size_t>(after - times_s_.begin());
  const double gap = times_s_[k] - times_s_[k - 1];
  if (time_s == times_s_[k - 1]) return positions_[k - 1];
  if (gap > max_gap_s_) return {};
  const double share = (time_s - times_s_[k - 1]) / gap;
  return positions_[k - 1] + share * (positions_[k] - positions_[k - 1]);
}

const Trajectory* covering_trajectory(const Scan& scan,
                                      const std::vector<std::shared_ptr<const Trajectory>>& trajectories) {
  constexpr std::size_t kAsked = 1000;
  constexpr double kOtherWayM = 2.0;  // farther from its own scanner positions it is that of another drive
  const std::size_t step = std::max<std::size_t>(1, scan.times_s.size() / kAsked);
  const Trajectory* best = nullptr;
  std::size_t most = 0;
  for (const auto& trajectory : trajectories) {
    std::size_t asked = 0;
    std::vector<double> distances;
    for (std::size_t i = 0; i < scan.times_s.size(); i += step) {
      ++asked;
      if (const std::optional<Vector3d> place = trajectory->position(scan.times_s[i]))
        distances.push_back(
            (scan.local_origin + (scan.mobile() ? scan.centres[i] : scan.points[i]) - *place).norm());
    }
    if (distances.empty() || 2 * distances.size() < asked || distances.size() <= most) continue;
    if (median(distances) > (scan.mobile() ? kOtherWayM : kFarthestRangeM)) continue;
    best = trajectory.get();
    most = distances.size();
  }
  return best;
}

FollowedScan with_trajectory(const Scan& scan, const Trajectory& trajectory) {
  if (scan.times_s.empty()) {
    throw Error("the points have no times, so a trajectory cannot be used", scan.name,
                "export the scan with its GPS times, or leave the trajectory out");
  }
  FollowedScan followed{scan, 0};
  std::vector<char> known(scan.size(), 0);
  followed.scan.centres.assign(scan.size(), Vector3d::Zero());
  parallel_for(scan.size(), kTimesPerPiece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<Vector3d> centre = trajectory.position(scan.times_s[i]);
      if (!centre) continue;
      followed.scan.centres[i] = *centre - scan.local_origin;
      known[i] = 1;
    }
  });
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] != 0) kept.push_back(static_cast<std::uint32_t>(i));
  }
  if (kept.empty()) {
    const auto [first, last] = std::minmax_element(scan.times_s.begin(), scan.times_s.end());
    no_overlap(scan, {*first, *last}, trajectory);
  }
  followed.left_out = scan.size() - kept.size();
  if (followed.left_out > 0) followed.scan = subset(followed.scan, kept);
  require_near(followed.scan, trajectory);
  return followed;
}

}  // namespace limen
