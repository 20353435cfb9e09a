// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/pass_track.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"

namespace limen {
namespace {

/// A drive of 40 m along a wall 6 m away, with a stop of a minute half way, at 5 m/s; all points on plane 0.
struct Drive {
  Scan scan;
  ExtractedFeatures extracted;
};
Drive drive_along_wall(double length_m) {
  Drive drive;
  RandomStream random(5);
  for (int k = 0; k < 20000; ++k) {
    const double at = length_m * k / 20000.0;
    const double stop = at > 0.5 * length_m ? 60.0 : 0.0;
    drive.scan.points.emplace_back(at, 6.0, random.uniform(0.0, 4.0));
    drive.scan.centres.emplace_back(at, 0.0, 2.0);
    drive.scan.times_s.push_back(381000.0 + at / 5.0 + stop);
    drive.extracted.labels.push_back(0);
  }
  return drive;
}

TEST(PassTrack, KnotsStandEvenlyAlongTheWay) {
  const Drive drive = drive_along_wall(40.0);
  const PassTrack track = find_pass_track(drive.scan, drive.extracted);
  ASSERT_EQ(track.way.knots(), 17);
  for (std::size_t k = 0; k < 17; ++k) {
    EXPECT_NEAR(track.way.distances_m[k], 2.5 * static_cast<double>(k), 0.4) << k;
    EXPECT_NEAR(track.way.places[k].x(), 2.5 * static_cast<double>(k), 0.5) << k;
    EXPECT_GT(track.way.times_s[k], k == 0 ? 0.0 : track.way.times_s[k - 1]);
  }
  EXPECT_GT(track.way.times_s[10] - track.way.times_s[6], 60.0);
}

TEST(PassTrack, OfALongWayThereAreNoMoreKnotsThanCanBeSolved) {
  EXPECT_EQ(find_pass_track(drive_along_wall(900.0).scan, drive_along_wall(900.0).extracted).way.knots(),
            361);
  const Drive drive = drive_along_wall(6000.0);
  const PassTrack track = find_pass_track(drive.scan, drive.extracted);
  ASSERT_EQ(track.way.knots(), 401);
  EXPECT_NEAR(track.way.distances_m[200], 3000.0, 1.0);
}

TEST(PassTrack, StripsHoldWhatWasSeenWhereTheyLie) {
  const Drive drive = drive_along_wall(40.0);
  const PassTrack track = find_pass_track(drive.scan, drive.extracted);
  ASSERT_GT(track.strips.size(), 30U);
  for (const PassStrip& strip : track.strips) {
    const Vector3d middle = strip.anchor + strip.moments.mean();
    EXPECT_NEAR(middle.y(), 6.0, 1e-9);
    // From knot to knot it goes evenly with time, so not where the drive stopped.
    if (std::abs(middle.x() - 20.0) > 6.0) {
      EXPECT_NEAR(middle.x(), 2.5 * strip.place, 0.6);
    }
    EXPECT_GE(strip.moments.count, 4.0);
    EXPECT_LT(12.0 * strip.moments.covariance().trace(), 2.0 * 2.5 * 2.5);
  }
}

TEST(PassTrack, WithoutTimesOrWayThereIsNone) {
  EXPECT_FALSE(find_pass_track(drive_along_wall(8.0).scan, drive_along_wall(8.0).extracted).way.known());
  Drive timeless = drive_along_wall(40.0);
  timeless.scan.times_s.clear();
  EXPECT_FALSE(find_pass_track(timeless.scan, timeless.extracted).way.known());
  Drive broken = drive_along_wall(40.0);
  broken.scan.times_s[77] = std::nan("");
  EXPECT_FALSE(find_pass_track(broken.scan, broken.extracted).way.known());
}

}  // namespace
}  // namespace limen
