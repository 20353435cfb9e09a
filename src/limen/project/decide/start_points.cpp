// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/decide/start_points.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/files/text_numbers.h"
#include "limen/geometry/linear.h"
#include "limen/project/control/fit_points.h"

namespace limen {
namespace {

constexpr const char* kWhere = "points";
constexpr const char* kRemedy =
    "show three places in both scans, the corners of a triangle with sides of some metres";
constexpr std::size_t kMostPoints = 20;
constexpr double kOnePlaceM = 0.2;
constexpr double kLeastSpreadM = 0.2;  // across the line that the points are nearest to, root mean square
constexpr double kMissM = 0.5;         // level: two clicks on one corner differ by less
constexpr double kMissUpM = 1.5;       // a wall that is clicked from above has any height
constexpr double kClickM = 0.5;        // what the start is believed to, one deviation
const double kClickRad = radians(5.0);

Vector3d place(const ShownPoint& point, std::size_t first) {
  return {point[first], point[first + 1], point[first + 2]};
}

/// All of one side, about their mean.
struct Side {
  Vector3d mean = Vector3d::Zero();
  std::vector<Vector3d> places;
};

Side side_of(const std::vector<ShownPoint>& points, std::size_t first) {
  Side side;
  for (const ShownPoint& point : points) {
    side.places.push_back(place(point, first));
    side.mean += side.places.back() / static_cast<double>(points.size());
  }
  Matrix3d spread = Matrix3d::Zero();
  for (Vector3d& at : side.places) {
    at -= side.mean;
    spread += at * at.transpose() / static_cast<double>(points.size());
  }
  const char* name = first == 0 ? "moving" : "fixed";
  for (std::size_t b = 1; b < points.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if ((side.places[a] - side.places[b]).norm() < kOnePlaceM)
        throw Error(fmt::format("points {} and {} are the same place of the {} scan", a + 1, b + 1, name),
                    kWhere, kRemedy);
    }
  }
  if (spectrum_of(spread).values[1] < kLeastSpreadM * kLeastSpreadM)
    throw Error(fmt::format("the points of the {} scan lie nearly in a line", name), kWhere, kRemedy);
  return side;
}

/// Level and upright parts of the largest misses.
std::pair<double, double> misses(const Side& source, const Side& target, const Matrix3d& turn) {
  double level = 0.0;
  double upright = 0.0;
  for (std::size_t k = 0; k < source.places.size(); ++k) {
    const Vector3d miss = turn * source.places[k] - target.places[k];
    level = std::max(level, miss.head<2>().norm());
    upright = std::max(upright, std::abs(miss.z()));
  }
  return {level, upright};
}

/// Of scans that stand upright: the heading that least squares give.
Matrix3d heading(const Side& source, const Side& target) {
  double cosine = 0.0;
  double sine = 0.0;
  for (std::size_t k = 0; k < source.places.size(); ++k) {
    const Vector3d& a = source.places[k];
    const Vector3d& b = target.places[k];
    cosine += a.x() * b.x() + a.y() * b.y();
    sine += a.x() * b.y() - a.y() * b.x();
  }
  return rotation_exp(Vector3d(0.0, 0.0, std::atan2(sine, cosine)));
}

/// In any orientation; what is clicked there has to be met in all three directions.
std::optional<Rigid3> any_turn(const Side& source, const Side& target) {
  std::vector<PointPair> pairs;
  const Matrix3d click = Matrix3d::Identity() * (0.1 * 0.1);
  for (std::size_t k = 0; k < source.places.size(); ++k)
    pairs.push_back({source.places[k], click, target.places[k], click});
  const PointFit fit = fit_points(pairs);
  const bool all = std::all_of(fit.taken.begin(), fit.taken.end(), [](bool taken) { return taken; });
  if (!all || fit.state == PointFitState::contradictory) return {};
  return fit.pose.target_from_source;
}

}  // namespace

ShownPoint shown_point(const std::string& text) {
  std::string numbers = text;
  const std::size_t middle = numbers.find('=');
  if (middle != std::string::npos) numbers[middle] = ',';
  ShownPoint point{};
  std::size_t begin = 0;
  for (std::size_t k = 0; k < point.size(); ++k) {
    const std::size_t end = std::min(numbers.find(',', begin), numbers.size());
    const std::optional<double> value = parse_number(numbers.substr(begin, end - begin));
    const bool last = k + 1 == point.size();
    const bool parted = k != 2 || end == middle;
    if (!value || !std::isfinite(*value) || !parted || last != (end == numbers.size()))
      throw Error(fmt::format("\"{}\" is not a point in two scans", text), kWhere,
                  "write x,y,z in the one, =, and x,y,z in the other: 1.2,3.4,0.5=10.2,-7.1,0.5");
    point[k] = *value;
    begin = end + 1;
  }
  return point;
}

std::string words_of(const ShownPoint& point) {
  return fmt::format("{},{},{}={},{},{}", point[0], point[1], point[2], point[3], point[4], point[5]);
}

StartPrior start_from_points(const std::vector<ShownPoint>& points) {
  if (points.size() < 3 || points.size() > kMostPoints)
    throw Error(fmt::format("{} points are given", points.size()), kWhere,
                fmt::format("show 3 to {} places in both scans", kMostPoints));
  const Side source = side_of(points, 0);
  const Side target = side_of(points, 3);
  StartPrior start;
  start.sigma_m = kClickM;
  start.sigma_rad = kClickRad;
  Rigid3 pose{heading(source, target), Vector3d::Zero()};
  const auto [level, upright] = misses(source, target, pose.rotation);
  if (level > kMissM || upright > kMissUpM) {
    const std::optional<Rigid3> turned = any_turn(source, target);
    if (!turned)
      throw Error(
          fmt::format("no pose brings the points together: {:.1f} m remain", std::hypot(level, upright)),
          kWhere, "check that each pair is one place of the building, in the same order");
    pose = *turned;
  }
  start.target_from_source = {pose.rotation, pose.translation + target.mean - pose.rotation * source.mean};
  return start;
}

}  // namespace limen
