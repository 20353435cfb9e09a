// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/frame/scan_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/base/parallel.h"
#include "limen/register/frame/frame_planes.h"
#include "limen/register/frame/scan_up.h"
#include "limen/register/frame/scanner_place.h"
#include "limen/register/frame/steady_sample.h"

namespace limen {
namespace {

constexpr std::size_t kFramePoints = 120000;  // points
constexpr std::size_t kLeastPoints = 1000;
constexpr double kLevelPathDeg = 3.0;  // z of a moving scanner's frame, nearer to up than this, is up
constexpr double kWallDeg = 5.0;
constexpr double kHeadingDeg = 0.5;    // walls off by more count less and less
constexpr double kCornerShare = 0.01;  // of the points that lie beyond the corner along each axis
/// Of the corner beyond that: the floor and the walls that make it must not lie on the border of cells.
constexpr double kMarginM = 0.11;

/// Turns about the vertical only: x along `heading` as it is seen from above.
Matrix3d frame_of(const Vector3d& up, const Vector3d& heading) {
  const Vector3d x = (heading - up * up.dot(heading)).normalized();
  Matrix3d rows;
  rows.row(0) = x.transpose();
  rows.row(1) = up.cross(x).transpose();
  rows.row(2) = up.transpose();
  return rows;
}

/// A horizontal axis to count angles from: the normal of the largest wall, or anything.
Vector3d first_heading(const Vector3d& up, const std::vector<FramePlane>& planes) {
  for (const FramePlane& plane : planes) {
    if (std::abs(plane.plane.normal.dot(up)) < std::sin(radians(kWallDeg))) return plane.plane.normal;
  }
  return up.unitOrthogonal();
}

/// The direction, modulo a quarter turn, along which or across which the most walls stand.
double main_angle(const Matrix3d& frame, const std::vector<FramePlane>& planes) {
  struct Wall {
    double angle;
    double area_m2;
  };
  std::vector<Wall> walls;
  double largest = 0.0;
  for (const FramePlane& plane : planes) {
    const Vector3d n = frame * plane.plane.normal;
    if (std::abs(n.z()) > std::sin(radians(kWallDeg))) continue;
    walls.push_back({std::atan2(n.y(), n.x()), plane.area_m2});
    largest = std::max(largest, plane.area_m2);
  }
  const auto mean_about = [&](double start) {
    double angle = start;
    double total = 0.0;
    for (int round = 0; round < 30; ++round) {
      std::complex<double> sum = 0.0;
      for (const Wall& wall : walls) {
        const double off = std::remainder(wall.angle - angle, 0.5 * std::numbers::pi) / radians(kHeadingDeg);
        const double weight =
            std::max(0.0, wall.area_m2 / largest - 0.1) / ((1.0 + off * off) * (1.0 + off * off));
        sum += weight * std::polar(1.0, 4.0 * (wall.angle - angle));
      }
      total = std::abs(sum);
      const double step = std::arg(sum) / 4.0;
      angle += step;
      if (std::abs(step) < 1e-13) break;
    }
    return std::pair(angle, total);
  };
  std::pair<double, double> best{0.0, -1.0};
  for (std::size_t k = 0; k < std::min<std::size_t>(6, walls.size()); ++k) {
    const std::pair<double, double> found = mean_about(walls[k].angle);
    if (found.second > 1.0001 * best.second) best = found;
  }
  return best.first;
}

/// Which of the four quarter turns: x along the longer side, and towards the side where the points reach
/// further from their middle.
int quarter_of(const Matrix3d& frame, const Scan& sample) {
  std::array<std::vector<double>, 2> along;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Vector3d x = frame * sample.points[i];
    along[0].push_back(x.x());
    along[1].push_back(x.y());
  }
  std::array<double, 2> length{};
  std::array<double, 2> lean{};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t cut = along[k].size() / 50;
    const auto at = [&](std::size_t place) {
      const auto it = along[k].begin() + static_cast<std::ptrdiff_t>(place);
      std::nth_element(along[k].begin(), it, along[k].end());
      return *it;
    };
    const double low = at(cut);
    const double high = at(along[k].size() - 1 - cut);
    length[k] = high - low;
    lean[k] = 0.5 * (low + high) - at(along[k].size() / 2);
  }
  const bool swap = length[1] > length[0];
  const bool positive = lean[swap ? 1 : 0] >= 0.0;
  return (swap ? 1 : 0) + (positive ? 0 : 2);
}

Matrix3d turned_about_z(const Matrix3d& frame, double angle) {
  return Eigen::AngleAxisd(-angle, Vector3d::UnitZ()).toRotationMatrix() * frame;
}

/// Of value(0) to value(size - 1) the one below which `rank` others lie. Those near the lowest are singled
/// out first, by what a part of them says, so that few have to be kept and sorted; the answer is that of
/// sorting all.
template <typename ValueOf>
double ranked(std::size_t size, std::size_t rank, const ValueOf& value) {
  constexpr std::size_t kPart = 64;
  const auto at = [](std::vector<double>& of, std::size_t place) {
    const auto it = of.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(of.begin(), it, of.end());
    return *it;
  };
  const auto up_to = [&](double bound, std::size_t step) {
    std::vector<double> values;
    for (std::size_t i = 0; i < size; i += step) {
      const double x = value(i);
      if (x <= bound) values.push_back(x);
    }
    return values;
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  std::vector<double> low;
  if (size >= kPart * kPart * kPart) {
    std::vector<double> part = up_to(kAny, kPart);
    low = up_to(at(part, std::min(part.size() - 1, 2 * rank / kPart + 100)), 1);
  }
  if (low.size() <= rank) low = up_to(kAny, 1);
  return at(low, rank);
}

/// A corner of the extent, a few stray points left out. Of all points: which were looked at must not show.
Vector3d corner_of(const Matrix3d& frame, const std::vector<Vector3d>& points) {
  Vector3d corner;
  const auto rank = static_cast<std::size_t>(kCornerShare * static_cast<double>(points.size()));
  parallel_for(3, 1, [&](std::size_t first, std::size_t last) {
    for (auto k = static_cast<Eigen::Index>(first); k < static_cast<Eigen::Index>(last); ++k)
      corner[k] =
          ranked(points.size(), rank, [&](std::size_t i) { return frame.row(k).dot(points[i]); }) - kMarginM;
  });
  return frame.transpose() * corner;
}

/// A moving scanner's z is that of a national grid or of its own instruments: better than sloping roads.
bool keeps_z(const Scan& scan, const Vector3d& up, Gravity gravity) {
  return scan.mobile() && gravity != Gravity::unknown && up.z() > std::cos(radians(kLevelPathDeg));
}

/// Enough to know about how the scan lies.
Scan every_third(const Scan& sample) {
  std::vector<std::uint32_t> third;
  for (std::uint32_t i = 0; i < sample.size(); i += 3) third.push_back(i);
  return subset(sample, third);
}

Vector3d main_normal(const std::vector<FramePlane>& planes) {
  return planes.empty() ? Vector3d(Vector3d::UnitZ()) : planes.front().plane.normal;
}

Scan seen_from(Scan sample, const ScannerPlace& place) {
  if (sample.mobile()) return sample;
  sample.centres.clear();
  if (place.source != PlaceSource::unknown) sample.centres = {place.centre};
  return sample;
}

/// The rotation that a scan's planes give where `up` is about up.
Matrix3d frame_by(const std::vector<FramePlane>& planes, const Vector3d& up, const Scan& sample,
                  Gravity gravity) {
  const Vector3d z =
      keeps_z(sample, up, gravity) ? Vector3d(Vector3d::UnitZ()) : settled_up(up, planes, sample.mobile());
  Matrix3d frame = frame_of(z, first_heading(z, planes));
  frame = turned_about_z(frame, main_angle(frame, planes));
  return turned_about_z(frame, 0.5 * std::numbers::pi * quarter_of(frame, sample));
}

/// The planes of `sample` found in a frame about right: where its cubes lie no longer depends on how the scan
/// lies in its file.
std::vector<FramePlane> planes_in(const Matrix3d& frame, const Vector3d& corner, const Scan& sample) {
  std::vector<Vector3d> points(sample.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = frame * (sample.points[i] - corner);
  std::vector<FramePlane> planes = frame_planes(points);
  const Rigid3 back{frame.transpose(), corner};
  for (FramePlane& plane : planes) {
    plane.plane = transformed(back, plane.plane);
    plane.middle = back * plane.middle;
  }
  return planes;
}

}  // namespace

ScanFrame find_scan_frame(const Scan& scan, Gravity gravity, Monitor& monitor) {
  ScanFrame found;
  found.upright = found.surely_upright = gravity == Gravity::up;
  if (scan.centres.size() == 1) {
    found.place.source = scan.centre_source;
    found.place.centre = scan.centres.front();
  }
  if (scan.mobile()) found.place.source = PlaceSource::per_point;
  if (scan.size() < kLeastPoints) return found;
  Scan sample = subset(scan, steady_sample(scan, kFramePoints));
  // Points that lie about as far from their middle are in the sample all together, or not at all.
  if (sample.size() < kLeastPoints) return found;
  const Scan few = every_third(sample);
  const std::vector<FramePlane> first = frame_planes(few.points);
  monitor.throw_if_cancelled();
  const Matrix3d axes = frame_by(first, main_normal(first), few, Gravity::unknown);
  std::optional<Scan> enough = sample_for_place(scan);
  found.place = find_scanner_place(enough ? *enough : scan, first, axes);
  sample = seen_from(std::move(sample), found.place);
  const ScanUp up = find_up(sample, first, gravity, found.place);
  found.upright = up.clear;
  found.surely_upright = up.sure;
  const Matrix3d about = frame_by(first, up.up, few, gravity);
  monitor.throw_if_cancelled();
  const std::vector<FramePlane> planes = planes_in(about, corner_of(about, sample.points), sample);
  found.place = refined_place(found.place, enough ? *enough : scan, planes, about);
  enough.reset();
  found.frame_from_scan = frame_by(planes, about.row(2).transpose(), sample, gravity);
  found.corner = corner_of(found.frame_from_scan, scan.points);
  return found;
}

}  // namespace limen
