// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/scan_view.h"

#include <algorithm>

namespace limen {
namespace {

constexpr std::uint32_t kLongestRun = 24;
constexpr std::size_t kRunsTogether = 32;
constexpr double kWidestM = 4.0;      // of a run's box: a run that leaps to another plane tells nothing
constexpr double kFaceSlackM = 1e-6;  // rounding never decides: what is near a face is looked at by itself

/// Samples that follow one another.
struct Span {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// Of the samples of `spans`, so many in all, every so many-th: no more than `most`.
SampleRuns::Within chosen(const std::vector<Span>& spans, std::size_t total, std::size_t most) {
  SampleRuns::Within within;
  within.stride = most == 0 ? 1 : 1 + total / most;
  within.indices.reserve(total / within.stride + 1);
  std::size_t skip = 0;  // of the next span
  for (const Span& span : spans) {
    const std::size_t size = span.end - span.begin;
    for (; skip < size; skip += within.stride)
      within.indices.push_back(span.begin + static_cast<std::uint32_t>(skip));
    skip -= size;
  }
  return within;
}

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
    runs_.push_back({begin, end, box.center(), 0.5 * box.diagonal().norm() + kFaceSlackM});
    begin = end;
  }
  for (std::size_t begin = 0; begin < runs_.size(); begin += kRunsTogether) {
    const std::size_t end = std::min(begin + kRunsTogether, runs_.size());
    Eigen::AlignedBox3d box;
    for (std::size_t k = begin; k < end; ++k) {
      const Vector3d reach = Vector3d::Constant(runs_[k].radius_m);
      box.extend(runs_[k].centre - reach).extend(runs_[k].centre + reach);
    }
    groups_.push_back({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), box.center(),
                       0.5 * box.diagonal().norm() + kFaceSlackM});
  }
}

SampleRuns::Within SampleRuns::within(const Eigen::AlignedBox3d& box, const Rigid3& box_from_sample,
                                      const std::vector<SurfaceSample>& samples, std::size_t most) const {
  // Of a ball: how deep its centre lies inside, along the axis in which it is deepest outside, or nearest to
  // a face.
  const auto depth = [&](const Run& ball) {
    const Vector3d centre = box_from_sample * ball.centre;
    return std::min((centre - box.min()).minCoeff(), (box.max() - centre).minCoeff());
  };
  std::vector<Span> spans;
  std::size_t total = 0;
  const auto add = [&](std::uint32_t begin, std::uint32_t end) {
    total += end - begin;
    if (!spans.empty() && spans.back().end == begin)
      spans.back().end = end;
    else
      spans.push_back({begin, end});
  };
  for (const Run& group : groups_) {
    if (depth(group) < -group.radius_m) continue;
    for (std::uint32_t k = group.begin; k < group.end; ++k) {
      const Run& run = runs_[k];
      const double inside = depth(run);
      if (inside < -run.radius_m) continue;
      if (inside > run.radius_m) {
        add(run.begin, run.end);
        continue;
      }
      for (std::uint32_t i = run.begin; i < run.end; ++i) {
        if (box.contains(box_from_sample * samples[i].mean)) add(i, i + 1);
      }
    }
  }
  return chosen(spans, total, most);
}

}  // namespace limen
