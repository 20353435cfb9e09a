// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/open_sky.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kStep = 1.0;  // degrees

/// What a scanner at `centre` sees, of which rays up to `field_deg` above the horizon come back; `range`: of
/// a ray.
void look(Scan& scan, const Vector3d& centre, double field_deg, bool mobile,
          const std::function<double(const Vector3d&)>& range) {
  for (double up = -60.0; up <= field_deg; up += kStep) {
    for (double turn = 0.5; turn < 360.0; turn += kStep) {
      const Vector3d ray(std::cos(radians(up)) * std::cos(radians(turn)),
                         std::cos(radians(up)) * std::sin(radians(turn)), std::sin(radians(up)));
      const double away = range(ray);
      if (!std::isfinite(away)) continue;
      scan.points.emplace_back(centre + away * ray);
      if (mobile) scan.centres.push_back(centre);
    }
  }
  if (!mobile) scan.centres = {centre};
  scan.level = true;
}

/// In a box 6 m by 6 m, 2.8 m high.
double in_room(const Vector3d& ray) {
  return std::min({3.0 / std::abs(ray.x()), 3.0 / std::abs(ray.y()), 1.4 / std::abs(ray.z())});
}

/// Before a façade, 8 m off and 10 m high.
double in_street(const Vector3d& ray) {
  if (ray.z() < 0.0) return -2.0 / ray.z();
  const double away = ray.x() > 0.0 ? 8.0 / ray.x() : INFINITY;
  return away * ray.z() < 8.0 ? away : INFINITY;
}

TEST(OpenSkyTest, ARoomHasNone) {
  for (const double field : {15.0, 45.0, 90.0}) {
    Scan room;
    look(room, Vector3d::Zero(), field, false, in_room);
    EXPECT_EQ(open_sky_share(room), 0.0) << field;
    EXPECT_FALSE(taken_outside(room));
  }
}

TEST(OpenSkyTest, AStreetHasMuch) {
  Scan street;
  look(street, Vector3d(3, 4, 1), 90.0, false, in_street);
  EXPECT_GT(open_sky_share(street), 0.5);
  EXPECT_FALSE(taken_outside(street)) << "a static scan may stand askew in a hall";
}

TEST(OpenSkyTest, AWayThroughARoomIsInside) {
  Scan inside;
  Scan outside;
  for (double along = 0.0; along < 12.0; along += 0.5) {
    look(inside, Vector3d(along, 0, 0), 60.0, true, in_room);
    look(outside, Vector3d(0, along, 0), 60.0, true, in_street);
  }
  EXPECT_FALSE(taken_outside(inside));
  EXPECT_TRUE(taken_outside(outside));
}

TEST(OpenSkyTest, WithoutUpOrScannerNothingIsSaid) {
  Scan street;
  look(street, Vector3d::Zero(), 90.0, true, in_street);
  EXPECT_TRUE(taken_outside(street));
  street.level = false;
  EXPECT_FALSE(taken_outside(street));
  street.level = true;
  street.centres.clear();
  EXPECT_FALSE(taken_outside(street));
  EXPECT_EQ(open_sky_share(Scan{}), 0.0);
}

}  // namespace
}  // namespace limen
