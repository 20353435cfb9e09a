// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/model/scan.h"

#include "limen/base/drawn_steps.h"
#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"

namespace limen {
namespace {

constexpr double kFarM = 1000.0;
constexpr double kNearZeroM = 1e4;
constexpr double kRoundM = 100.0;

void require(bool holds, const char* what, const std::string& where) {
  if (!holds)
    throw Error(what, where, "this is an internal error of limen: please report it", Fault::internal);
}

template <typename Value>
std::vector<Value> pick(const std::vector<Value>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<Value> picked;
  if (values.empty()) return picked;
  picked.reserve(indices.size());
  for (const std::uint32_t i : indices) picked.push_back(values[i]);
  return picked;
}

}  // namespace

void Scan::check() const {
  const std::size_t n = points.size();
  require(centres.size() <= 1 || centres.size() == n, "as many scanner positions as points are needed", name);
  require(topology.line.size() == topology.index.size(), "scan lines and indices differ in number", name);
  require(topology.line.empty() || topology.line.size() == n, "the topology does not cover the points", name);
  require(times_s.empty() || times_s.size() == n, "the times do not cover the points", name);
  require(intensities.empty() || intensities.size() == n, "the intensities do not cover the points", name);
  require(colours.empty() || colours.size() == 3 * n, "the colours do not cover the points", name);
}

Scan moved(Scan scan, const Rigid3& motion) {
  for (Vector3d& x : scan.points) x = motion * x;
  for (Vector3d& x : scan.centres) x = motion * x;
  return scan;
}

Scan subset(const Scan& scan, const std::vector<std::uint32_t>& indices) {
  Scan part;
  part.name = scan.name;
  part.local_origin = scan.local_origin;
  part.level = scan.level;
  part.centre_source = scan.centre_source;
  part.points = pick(scan.points, indices);
  part.centres = scan.mobile() ? pick(scan.centres, indices) : scan.centres;
  part.topology.line = pick(scan.topology.line, indices);
  part.topology.index = pick(scan.topology.index, indices);
  part.times_s = pick(scan.times_s, indices);
  part.intensities = pick(scan.intensities, indices);
  if (!scan.colours.empty()) {
    part.colours.reserve(3 * indices.size());
    for (const std::size_t i : indices) {
      for (std::size_t k = 0; k < 3; ++k) part.colours.push_back(scan.colours[3 * i + k]);
    }
  }
  return part;
}

double median_range(const Scan& scan) {
  std::vector<double> ranges;
  for_drawn_steps(scan.size(), 1000,
                  [&](std::size_t i) { ranges.push_back((scan.points[i] - scan.centre(i)).norm()); });
  return median(ranges);
}

Extent extent_of(const std::vector<Vector3d>& points) {
  if (points.empty()) return {};
  const Extent start{points.front(), points.front()};
  return parallel_reduce(
      points.size(), 65536, start,
      [&](std::size_t begin, std::size_t end) {
        Extent extent{points[begin], points[begin]};
        for (std::size_t i = begin; i < end; ++i) {
          extent.low = extent.low.cwiseMin(points[i]);
          extent.high = extent.high.cwiseMax(points[i]);
        }
        return extent;
      },
      [](const Extent& a, const Extent& b) {
        return Extent{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
      });
}

Vector3d round_origin_near(const Vector3d& x) {
  if ((x.array().abs() < kNearZeroM).all()) return Vector3d::Zero();
  return (x / kRoundM).array().round() * kRoundM;
}

Scan scan_of_points(std::vector<Vector3d> points) {
  if (points.empty()) throw Error("there are no points", "scan", "give at least one");
  Scan scan;
  scan.local_origin = round_origin_near(points.front());
  for (Vector3d& x : points) {
    x -= scan.local_origin;
    if (!x.allFinite()) throw Error("a coordinate is not finite", "scan", "leave such points out");
  }
  scan.points = std::move(points);
  return scan;
}

Vector3d origin_near(const Scan& scan) {
  const Extent extent = extent_of(scan.points);
  const Vector3d middle = 0.5 * (extent.low + extent.high);
  if (middle.norm() < kFarM) return scan.local_origin;
  return scan.local_origin + middle.array().round().matrix();
}

std::pair<double, double> signed_distances(const Plane& plane, const Extent& box) {
  const double middle = plane.signed_distance(0.5 * (box.low + box.high));
  const double reach = plane.normal.cwiseAbs().dot(0.5 * (box.high - box.low));
  return {middle - reach, middle + reach};
}

}  // namespace limen
