// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/point_print.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/random.h"
#include "limen/geometry/linear.h"
#include "limen/model/plausible_size.h"

namespace limen {
namespace {

/// Marks of a scan, so many that a hundredth of its points has some of them.
constexpr std::size_t kMarks = 1024;
constexpr double kMarkM = 1e-4;
/// A step that any format may have.
constexpr double kLeastStepM = 1e-4;

/// As files of whole millimetres have it, whatever their offset.
double millimetres_of(const Scan& scan) {
  constexpr double kStepM = 1e-3;
  constexpr double kEqual = 1e-4;  // of a step
  const bool all = std::all_of(scan.points.begin(), scan.points.end(), [&](const Vector3d& point) {
    const Vector3d steps = (point - scan.points.front()) / kStepM;
    return (steps - steps.array().round().matrix()).lpNorm<Eigen::Infinity>() < kEqual;
  });
  return all ? kStepM : 0.0;
}

std::array<double, 4> spread_of(const Scan& scan) {
  if (scan.points.empty()) return {};
  const auto count = static_cast<double>(scan.size());
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& point : scan.points) middle += point / count;
  Matrix3d covariance = Matrix3d::Zero();
  double distance = 0.0;
  for (const Vector3d& point : scan.points) {
    covariance += (point - middle) * (point - middle).transpose() / count;
    distance += (point - middle).norm() / count;
  }
  const Vector3d deviations = spectrum_of(covariance).values.cwiseMax(0.0).cwiseSqrt();
  return {deviations[0], deviations[1], deviations[2], distance};
}

std::vector<std::uint64_t> marks_of(const Scan& scan) {
  std::vector<std::uint64_t> marks;
  std::uint64_t least_left_out = UINT64_MAX;
  const auto cut = [&] {
    std::sort(marks.begin(), marks.end());
    marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
    if (marks.size() <= kMarks) return;
    least_left_out = marks[kMarks];
    marks.resize(kMarks);
  };
  for (const Vector3d& point : scan.points) {
    const std::uint64_t number = mix_place(scan.local_origin + point, kMarkM);
    if (number < least_left_out) marks.push_back(number);
    if (marks.size() >= 4 * kMarks) cut();
  }
  cut();
  return marks;
}

}  // namespace

PointPrint print_of(const Scan& scan) {
  return {scan.size(), spread_of(scan), std::max(coordinate_step_m(scan), millimetres_of(scan)),
          marks_of(scan)};
}

bool same_points(const PointPrint& a, const PointPrint& b) {
  if (a.points != b.points || a.points == 0) return false;
  // Three and a half deviations of what rounding by a step leaves of the mean.
  const double most_m =
      std::max({kLeastStepM, a.step_m, b.step_m}) / std::sqrt(static_cast<double>(a.points));
  return std::equal(a.spread_m.begin(), a.spread_m.end(), b.spread_m.begin(),
                    [most_m](double one, double other) { return std::abs(one - other) <= most_m; });
}

bool is_part_of(const PointPrint& part_print, const PointPrint& whole_print) {
  const std::vector<std::uint64_t>& part = part_print.marks;
  const std::vector<std::uint64_t>& whole = whole_print.marks;
  constexpr std::size_t kFewest = 6;
  // Numbers beyond the last mark are not known, unless there are none.
  const std::uint64_t last = whole.size() < kMarks ? UINT64_MAX : whole.back();
  std::size_t asked = 0;
  std::size_t shared = 0;
  for (const std::uint64_t mark : part) {
    if (mark > last) break;
    ++asked;
    if (std::binary_search(whole.begin(), whole.end(), mark)) ++shared;
  }
  return shared >= kFewest && 10 * shared > 8 * asked;
}

namespace {
constexpr const char* kNoTest = "a scan is registered to itself, which is no test for other scans";
}  // namespace

std::string same_points_note(std::size_t points) {
  return fmt::format("SOURCE and TARGET hold the same {} points: {}", points, kNoTest);
}

std::string same_points_note(const PointPrint& source, const PointPrint& target) {
  if (same_points(source, target)) return same_points_note(target.points);
  const bool fewer = is_part_of(target, source);
  if (!fewer && !is_part_of(source, target)) return {};
  return fmt::format("{} holds only points of {}, of which it seems a thinned copy or a part: {}",
                     fewer ? "TARGET" : "SOURCE", fewer ? "SOURCE" : "TARGET", kNoTest);
}

}  // namespace limen
