// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/sample_runs.h"

#include <algorithm>

namespace limen {
namespace {

constexpr std::uint32_t kLongestRun = 24;
constexpr double kWidestM = 4.0;  // of a run's box: a run that leaps to another plane tells nothing
constexpr double kSlackM = 1e-6;  // rounding never decides: what is near a face is looked at by itself

}  // namespace

SampleRuns::SampleRuns(const std::vector<SurfaceSample>& samples) {
  const auto size = static_cast<std::uint32_t>(samples.size());
  for (std::uint32_t begin = 0; begin < size;) {
    Eigen::AlignedBox3d box(samples[begin].mean);
    std::uint32_t end = begin + 1;
    for (; end < size && end - begin < kLongestRun; ++end) {
      Eigen::AlignedBox3d larger = box;
      larger.extend(samples[end].mean);
      if (larger.diagonal().norm() > kWidestM) break;
      box = larger;
    }
    runs_.push_back({begin, end, box.center(), 0.5 * box.diagonal().norm() + kSlackM});
    begin = end;
  }
}

std::vector<std::uint32_t> SampleRuns::within(const Eigen::AlignedBox3d& box, const Rigid3& box_from_sample,
                                              const std::vector<SurfaceSample>& samples) const {
  std::vector<std::uint32_t> found;
  for (const Run& run : runs_) {
    const Vector3d centre = box_from_sample * run.centre;
    // Along the axis in which the centre is deepest outside, or nearest to a face.
    const double inside = std::min((centre - box.min()).minCoeff(), (box.max() - centre).minCoeff());
    if (inside < -run.radius_m) continue;
    const bool all = inside > run.radius_m;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      if (all || box.contains(box_from_sample * samples[i].mean)) found.push_back(i);
    }
  }
  return found;
}

}  // namespace limen
