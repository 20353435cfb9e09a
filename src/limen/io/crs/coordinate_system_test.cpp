// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/crs/coordinate_system.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/io/crs/proj_library.h"
#include "limen/io/trajectory/transverse_mercator.h"

namespace limen {
namespace {

constexpr const char* kLocal = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";
constexpr const char* kProjcs =
    "PROJCS[\"RGF93 v1 / Lambert-93\",GEOGCS[\"RGF93 "
    "v1\",DATUM[\"Reseau_Geodesique_Francais_1993_v1\",SPHEROID[\"GRS "
    "1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433],AUTHORITY["
    "\"EPSG\","
    "\"4171\"]],PROJECTION[\"Lambert_Conformal_Conic_2SP\"],PARAMETER[\"latitude_of_origin\",46.5],PARAMETER["
    "\"central_meridian\",3],PARAMETER[\"standard_parallel_1\",49],PARAMETER[\"standard_parallel_2\",44],"
    "PARAMETER["
    "\"false_easting\",700000],PARAMETER[\"false_northing\",6600000],UNIT[\"metre\",1],AUTHORITY[\"EPSG\","
    "\"2154\"]]";

TEST(CoordinateSystem, WhatATextSaysOfItself) {
  const CoordinateSystem lambert = stated_system(kProjcs);
  EXPECT_EQ(lambert.name, "RGF93 v1 / Lambert-93");
  EXPECT_EQ(lambert.code, "EPSG:2154");
  EXPECT_EQ(words_of(lambert), "RGF93 v1 / Lambert-93 (EPSG:2154)");
  EXPECT_EQ(stated_system(kLocal).name, "site");
  EXPECT_EQ(stated_system(kLocal).code, "");
  const CoordinateSystem strange = stated_system("our own grid");
  EXPECT_EQ(strange.wkt, "");
  EXPECT_EQ(words_of(strange), "our own grid");
}

TEST(CoordinateSystem, SameOnes) {
  EXPECT_TRUE(same_system(stated_system(kProjcs), stated_system("EPSG:2154")));
  EXPECT_TRUE(same_system(stated_system(kProjcs), {}));
  EXPECT_FALSE(same_system(stated_system("EPSG:2154"), stated_system("EPSG:25832")));
}

TEST(CoordinateSystem, MistakesAreNamed) {
  for (const char* wrong : {"", "Lambert", "EPSG:", "EPSG:abc", "4326", "{}"})
    EXPECT_THROW(static_cast<void>(coordinate_system(wrong, "--crs")), Error) << wrong;
  // Degrees and feet are not what is written.
  EXPECT_THROW(static_cast<void>(coordinate_system(
                   "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
                   "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]",
                   "--crs")),
               Error);
  EXPECT_THROW(static_cast<void>(coordinate_system("LOCAL_CS[\"site\",UNIT[\"foot\",0.3048]]", "--crs")),
               Error);
}

TEST(CoordinateSystem, WithProjEverySystemIsKnown) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const CoordinateSystem lambert = coordinate_system("epsg:2154", "--crs");
  EXPECT_EQ(lambert.code, "EPSG:2154");
  EXPECT_EQ(lambert.wkt.rfind("PROJCS[", 0), 0U);
  EXPECT_NE(lambert.name.find("Lambert-93"), std::string::npos);
  EXPECT_THROW(static_cast<void>(coordinate_system("EPSG:999999", "--crs")), Error);
  EXPECT_THROW(static_cast<void>(coordinate_system("EPSG:4326", "--crs")), Error);
  EXPECT_THROW(static_cast<void>(coordinate_system("EPSG:2263", "--crs")), Error);  // US survey feet
  // Heights do not make another system on the ground.
  EXPECT_TRUE(same_system(stated_system("EPSG:2154+5720"), lambert));
}

TEST(MapProjection, LambertOfTheEiffelTower) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const MapProjection lambert("EPSG:2154", "--crs");
  // The formulas of Lambert's conic with two parallels (EPSG guidance note 7-2, method 9802), worked out
  // here.
  constexpr double kE = 0.081819191042815791;
  const auto m = [](double phi) {
    return std::cos(phi) / std::sqrt(1 - kE * kE * std::sin(phi) * std::sin(phi));
  };
  const auto t = [](double phi) {
    const double s = kE * std::sin(phi);
    return std::tan(M_PI / 4 - phi / 2) / std::pow((1 - s) / (1 + s), kE / 2);
  };
  const double a = 6378137.0;
  const double phi1 = radians(44.0);
  const double phi2 = radians(49.0);
  const double n = (std::log(m(phi1)) - std::log(m(phi2))) / (std::log(t(phi1)) - std::log(t(phi2)));
  const double f = m(phi1) / (n * std::pow(t(phi1), n));
  const double latitude = radians(48.85837);
  const double longitude = radians(2.294481);
  const double r = a * f * std::pow(t(latitude), n);
  const double r0 = a * f * std::pow(t(radians(46.5)), n);
  const double theta = n * (longitude - radians(3.0));
  const Vector3d expected(700000.0 + r * std::sin(theta), 6600000.0 + r0 - r * std::cos(theta), 35.0);
  const Vector3d found = lambert.to_map(latitude, longitude, 35.0);
  EXPECT_LT((found - expected).norm(), 1e-5);
  EXPECT_NEAR(lambert.convergence_rad(latitude, longitude, 35.0), theta, 1e-7);
  const Vector3d back = lambert.from_map(found);
  EXPECT_NEAR(back.x(), latitude, 1e-12);
  EXPECT_NEAR(back.y(), longitude, 1e-12);
  EXPECT_NEAR(back.z(), 35.0, 1e-6);
}

TEST(MapProjection, ZonesOfUtmAgreeWithTheSeriesToAMicrometre) {
  if (proj_library() == nullptr) GTEST_SKIP() << "there is no PROJ";
  const MapProjection zone("EPSG:32632", "--utm-zone");
  for (const double latitude : {-10.0, 0.5, 48.58, 71.0}) {
    for (const double longitude : {6.2, 7.75, 9.0, 11.9}) {
      const Geodetic place{radians(latitude), radians(longitude), 123.0};
      const GridPlace series = to_utm(place, *parse_utm_zone("32N"));
      EXPECT_LT((zone.to_map(place.latitude_rad, place.longitude_rad, 123.0) - series.x).norm(), 1e-6);
      EXPECT_NEAR(zone.convergence_rad(place.latitude_rad, place.longitude_rad, 123.0),
                  series.convergence_rad, 1e-7);
    }
  }
}

}  // namespace
}  // namespace limen
