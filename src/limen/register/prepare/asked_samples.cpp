// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/asked_samples.h"

#include <utility>

namespace limen {

AskedSamples asked_samples(const ScanView& scan, const ScanView& judge, const Rigid3& judge_from_scan,
                           std::size_t most) {
  const std::vector<SurfaceSample>& samples = scan.features->samples;
  AskedSamples asked;
  if (scan.model && scan.runs != nullptr) {
    SampleRuns::Within within = scan.runs->within(judge.reach, judge_from_scan, samples, most);
    asked.indices = std::move(within.indices);
    asked.factor = static_cast<double>(within.stride);
    return asked;
  }
  if (scan.model) {
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
      if (judge.reach.contains(judge_from_scan * samples[i].mean)) asked.indices.push_back(i);
    }
  }
  const std::size_t total = scan.model ? asked.indices.size() : samples.size();
  const std::size_t stride = most == 0 ? 1 : 1 + total / most;
  asked.factor = static_cast<double>(stride);
  if (scan.model) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < total; k += stride) asked.indices[kept++] = asked.indices[k];
    asked.indices.resize(kept);
    return asked;
  }
  asked.indices.reserve(total / stride + 1);
  for (std::size_t i = 0; i < total; i += stride) asked.indices.push_back(static_cast<std::uint32_t>(i));
  return asked;
}

}  // namespace limen
