// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/register/prepare/open_sky.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "limen/base/angles.h"

namespace limen {
namespace {

constexpr double kRayStepDeg = 1.0;

/// What a scanner at `centre` sees, of which rays up to `field_deg` above the horizon come back; `range`: of
/// a ray.
void look(Scan& scan, const Vector3d& centre, double field_deg, bool mobile,
          const std::function<double(const Vector3d&)>& range) {
  for (double up = -60.0; up <= field_deg; up += kRayStepDeg) {
    for (double turn = 0.5; turn < 360.0; turn += kRayStepDeg) {
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
    EXPECT_EQ(surroundings_of(room), field < 60.0 ? Surroundings::unknown : Surroundings::inside);
  }
}

TEST(OpenSkyTest, AStreetHasMuch) {
  Scan street;
  look(street, Vector3d(3, 4, 1), 90.0, false, in_street);
  EXPECT_GT(open_sky_share(street), 0.5);
  EXPECT_EQ(surroundings_of(street), Surroundings::outside);
}

TEST(OpenSkyTest, OfAStaticScannerOfNarrowFieldOfViewItIsNotKnown) {
  Scan narrow;
  look(narrow, Vector3d::Zero(), 90.0, false, [](const Vector3d& ray) {
    const Vector3d axis(std::sin(0.7), 0.0, std::cos(0.7));  // its own, askew
    return std::abs(axis.dot(ray)) < 0.6 ? in_room(ray) : INFINITY;
  });
  EXPECT_GT(open_sky_share(narrow), 0.4);
  EXPECT_EQ(surroundings_of(narrow), Surroundings::unknown);
}

TEST(OpenSkyTest, ARoomWhoseCeilingWasCutOffIsNotOutside) {
  Scan room;
  look(room, Vector3d(0.4, 0.2, 1.4), 90.0, false, [](const Vector3d& ray) {
    const double away =
        std::min({(ray.x() > 0 ? 2.0 : 5.0) / std::abs(ray.x()),
                  (ray.y() > 0 ? 2.5 : 9.0) / std::abs(ray.y()), ray.z() < 0.0 ? -1.4 / ray.z() : INFINITY});
    return away * ray.z() < 1.2 ? away : INFINITY;
  });
  EXPECT_GT(open_sky_share(room), 0.4);
  EXPECT_EQ(surroundings_of(room), Surroundings::unknown);
}

TEST(OpenSkyTest, AWayThroughARoomIsInside) {
  Scan inside;
  Scan outside;
  for (double along = 0.0; along < 12.0; along += 0.5) {
    look(inside, Vector3d(along, 0, 0), 60.0, true, in_room);
    look(outside, Vector3d(0, along, 0), 60.0, true, in_street);
  }
  EXPECT_EQ(surroundings_of(inside), Surroundings::inside);
  EXPECT_EQ(surroundings_of(outside), Surroundings::outside);
}

TEST(OpenSkyTest, OfAPathItIsNotKnownWhereTheScannerCannotSeeACeiling) {
  Scan hall;  // of which the scanner reaches one wall
  for (double along = 0.0; along < 12.0; along += 0.5) {
    look(hall, Vector3d(0, along, 0), 25.0, true, [](const Vector3d& ray) {
      const double away = std::min(ray.x() < 0.0 ? -6.0 / ray.x() : INFINITY,
                                   (ray.z() > 0.0 ? 4.0 : 1.5) / std::abs(ray.z()));
      return away < 8.0 && ray.z() > std::sin(radians(-25.0)) ? away : INFINITY;
    });
  }
  EXPECT_GT(open_sky_share(hall), 0.2);
  EXPECT_EQ(surroundings_of(hall), Surroundings::unknown);
}

TEST(OpenSkyTest, WithoutUpOrScannerNothingIsSaid) {
  Scan street;
  look(street, Vector3d::Zero(), 90.0, true, in_street);
  EXPECT_EQ(surroundings_of(street), Surroundings::outside);
  street.level = false;
  EXPECT_EQ(surroundings_of(street), Surroundings::unknown);
  street.level = true;
  street.centres.clear();
  EXPECT_EQ(surroundings_of(street), Surroundings::unknown);
  EXPECT_EQ(open_sky_share(Scan{}), 0.0);
}

}  // namespace
}  // namespace limen
