// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {
namespace {

/// Rows of tiles on walls here and there, as models have them.
std::vector<SurfaceSample> walls(RandomStream& random) {
  std::vector<SurfaceSample> samples;
  for (int wall = 0; wall < 40; ++wall) {
    const Vector3d corner(30.0 * random.uniform(), 20.0 * random.uniform(), 9.0 * random.uniform());
    for (int k = 0; k < 200; ++k) {
      SurfaceSample sample;
      sample.mean =
          corner + 0.25 * (wall % 2 == 0 ? Vector3d(k % 20, 0, k / 20) : Vector3d(0, k % 20, k / 20));
      samples.push_back(sample);
    }
  }
  return samples;
}

TEST(SampleRuns, FindTheSamplesThatALookAtEachFinds) {
  RandomStream random(1, 0);
  const std::vector<SurfaceSample> samples = walls(random);
  const SampleRuns runs(samples);
  std::size_t found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d axis(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform());
    const Rigid3 pose{
        Eigen::AngleAxisd(6.0 * random.uniform(), axis.normalized()).toRotationMatrix(),
        10.0 * Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5)};
    const Eigen::AlignedBox3d box(Vector3d(-4.0, -5.0, -1.5), Vector3d(6.0 * random.uniform(), 5.0, 9.0));
    std::vector<std::uint32_t> by_itself;
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
      if (box.contains(pose * samples[i].mean)) by_itself.push_back(i);
    }
    EXPECT_EQ(runs.within(box, pose, samples).indices, by_itself);
    found += by_itself.size();
    const SampleRuns::Within few = runs.within(box, pose, samples, 50);
    EXPECT_EQ(few.stride, 1 + by_itself.size() / 50);
    std::vector<std::uint32_t> thinned;
    for (std::size_t k = 0; k < by_itself.size(); k += few.stride) thinned.push_back(by_itself[k]);
    EXPECT_EQ(few.indices, thinned);
  }
  EXPECT_GT(found, 1000U);
  EXPECT_TRUE(SampleRuns().within({}, {}, samples).indices.empty());
  const Eigen::AlignedBox3d nothing;
  EXPECT_TRUE(runs.within(nothing, {}, samples).indices.empty());
}

}  // namespace
}  // namespace limen
