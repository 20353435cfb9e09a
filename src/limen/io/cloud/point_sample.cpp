// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/point_sample.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/random.h"

namespace limen {
namespace {

constexpr std::size_t kSampled = 64;
/// Formats round to half a millimetre per axis, or less.
constexpr double kSamePointM = 1e-3;
/// Marks of a scan, so many that a hundredth of its points has some of them.
constexpr std::size_t kMarks = 1024;
constexpr double kMarkM = 1e-4;

bool stands_left_of(const Vector3d& point, double x) {
  return point.x() < x;
}

}  // namespace

PointSample::PointSample(const Scan& scan) : points_(scan.size()) {
  const std::size_t count = std::min(points_, kSampled);
  for (std::size_t k = 0; k < count; ++k)
    some_.push_back(scan.local_origin + scan.points[k * points_ / count]);
  std::sort(some_.begin(), some_.end(), [](const Vector3d& a, const Vector3d& b) { return a.x() < b.x(); });
}

double PointSample::share_in(const Scan& scan) const {
  if (some_.empty()) return 0.0;
  std::vector<char> met(some_.size(), 0);
  std::size_t left = some_.size();
  for (std::size_t i = 0; i < scan.size() && left > 0; ++i) {
    const Vector3d place = scan.local_origin + scan.points[i];
    auto at = std::lower_bound(some_.begin(), some_.end(), place.x() - kSamePointM, stands_left_of);
    for (; at != some_.end() && at->x() <= place.x() + kSamePointM; ++at) {
      char& seen = met[static_cast<std::size_t>(at - some_.begin())];
      if (seen != 0 || (*at - place).norm() > kSamePointM) continue;
      seen = 1;
      --left;
    }
  }
  return 1.0 - static_cast<double>(left) / static_cast<double>(some_.size());
}

std::vector<std::uint64_t> point_marks(const Scan& scan) {
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

bool is_part_of(const std::vector<std::uint64_t>& part, const std::vector<std::uint64_t>& whole) {
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

std::string same_points_note(const PointSample& source, const std::vector<std::uint64_t>& marks_of_source,
                             const Scan& target) {
  if (source.is_of(target)) return same_points_note(target.size());
  const std::vector<std::uint64_t> marks = point_marks(target);
  const bool fewer = is_part_of(marks, marks_of_source);
  if (!fewer && !is_part_of(marks_of_source, marks)) return {};
  return fmt::format("{} holds only points of {}, of which it seems a thinned copy or a part: {}",
                     fewer ? "TARGET" : "SOURCE", fewer ? "SOURCE" : "TARGET", kNoTest);
}

}  // namespace limen
