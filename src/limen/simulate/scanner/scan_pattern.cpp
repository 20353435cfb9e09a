// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "limen/base/angles.h"
#include "limen/simulate/scanner/scanner.h"

namespace limen {

ScanPattern station_pattern(const Rigid3& scene_from_scanner, std::size_t pulses, const FieldOfView& view) {
  const double low = view.low_deg;
  const double high = view.high_deg;
  const double span = view.span_deg;
  const double step = std::sqrt(span * (high - low) / static_cast<double>(std::max<std::size_t>(pulses, 1)));
  ScanPattern pattern;
  pattern.lines = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(span / step)));
  pattern.pulses_per_line =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround((high - low) / step)));
  const auto lines = static_cast<double>(pattern.lines);
  const auto rows = static_cast<double>(pattern.pulses_per_line);
  pattern.pulse = [=](std::size_t line, std::size_t index) {
    const double azimuth = radians(span * static_cast<double>(line) / lines);
    const double elevation = radians(low + (high - low) * (static_cast<double>(index) + 0.5) / rows);
    const Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));
    return Pulse{scene_from_scanner.translation, scene_from_scanner.rotation * direction, 0.0};
  };
  return pattern;
}

double VehiclePath::length() const {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

Vector3d VehiclePath::at(double distance_m) const {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double piece = (points[i] - points[i - 1]).norm();
    if (distance_m <= piece) return points[i - 1] + (points[i] - points[i - 1]) * (distance_m / piece);
    distance_m -= piece;
  }
  return points.back();
}

Vector3d VehiclePath::heading(double distance_m) const {
  // Over a wheelbase, so that a bend of the path does not turn the vehicle at once.
  const double half = 1.4;
  const double whole = length();
  Vector3d along = at(std::min(distance_m + half, whole)) - at(std::max(distance_m - half, 0.0));
  along.z() = 0.0;
  return along.normalized();
}

ScanPattern profiler_pattern(const VehiclePath& trajectory, const std::vector<double>& head_turns_rad,
                             std::size_t pulses) {
  constexpr double kSpeed = 5.0;          // m/s
  constexpr double kStart = 381000.0;     // seconds of the GPS week
  constexpr double kTypicalRange = 10.0;  // m
  constexpr double kCircle = 2.0 * std::numbers::pi;
  const double length = trajectory.length();
  // As many profiles as make the spacing along the path that of the pulses at a typical range.
  const auto heads = static_cast<double>(head_turns_rad.size());
  const double wanted = static_cast<double>(std::max<std::size_t>(pulses, 128)) / heads;
  const double per_line = std::max(64.0, std::sqrt(wanted * kCircle * kTypicalRange / length));
  const auto head_lines = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(wanted / per_line)));
  ScanPattern pattern;
  pattern.pulses_per_line = static_cast<std::size_t>(std::lround(per_line));
  pattern.lines = head_lines * head_turns_rad.size();
  struct Pose {
    Vector3d origin;
    Vector3d across;
  };
  const auto poses = std::make_shared<std::vector<Pose>>();
  for (const double turn : head_turns_rad) {
    for (std::size_t line = 0; line < head_lines; ++line) {
      const double distance = length * static_cast<double>(line) / static_cast<double>(head_lines - 1);
      const Vector3d heading = trajectory.heading(distance);
      const Vector3d across(heading.y(), -heading.x(), 0.0);
      poses->push_back({trajectory.at(distance), std::cos(turn) * across + std::sin(turn) * heading});
    }
  }
  const auto rows = static_cast<double>(pattern.pulses_per_line);
  const double line_time = length / kSpeed / static_cast<double>(head_lines - 1);
  pattern.pulse = [poses, rows, line_time, head_lines](std::size_t line, std::size_t index) {
    // A profile begins below the vehicle, rises on its right, and comes back down on its left.
    const double share = (static_cast<double>(index) + 0.5) / rows;
    const Pose& pose = (*poses)[line];
    const Vector3d direction =
        std::sin(kCircle * share) * pose.across - std::cos(kCircle * share) * Vector3d::UnitZ();
    return Pulse{pose.origin, direction,
                 kStart + line_time * (static_cast<double>(line % head_lines) + share)};
  };
  return pattern;
}

}  // namespace limen
