// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/las/las_unit.h"

#include <gtest/gtest.h>

namespace limen {
namespace {

constexpr const char* kFeet =
    "COMPD_CS[\"x\",PROJCS[\"NAD83 / Oregon (ftUS)\",GEOGCS[\"NAD83\",DATUM[\"D\",SPHEROID[\"GRS 1980\","
    "6378137,298.257]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"LCC\"],"
    "PARAMETER[\"false_easting\",8202099.738],UNIT[\"US survey foot\",0.304800609601219],AXIS[\"X\",EAST]],"
    "VERT_CS[\"NAVD88\",VERT_DATUM[\"N\",2005],UNIT[\"metre\",1]]]";

/// A header with a directory of one key that holds its value.
LasHeader with_key(const std::string& body) {
  LasHeader header;
  LasRecord record;
  record.user = "LASF_Projection";
  record.number = 34735;
  record.body = body;
  header.records.push_back(record);
  return header;
}

std::string directory(std::uint16_t key, std::uint16_t value) {
  std::string body(16, '\0');
  put_las_number<std::uint16_t>(body, 0, 1);
  put_las_number<std::uint16_t>(body, 6, 1);
  put_las_number<std::uint16_t>(body, 8, key);
  put_las_number<std::uint16_t>(body, 12, 1);
  put_las_number<std::uint16_t>(body, 14, value);
  return body;
}

TEST(LasUnit, ReadsTheProjectedSystemsOwnUnit) {
  EXPECT_NEAR(*wkt_metres_per_unit(kFeet), 0.304800609601219, 1e-15);
  EXPECT_EQ(*wkt_metres_per_unit(
                "PROJCS[\"a \"\"[\"\" b\",GEOGCS[\"g\",UNIT[\"degree\",0.017]],UNIT[\"metre\",1]]"),
            1.0);
  EXPECT_EQ(
      *wkt_metres_per_unit("PROJCRS[\"p\",CS[Cartesian,2],AXIS[\"x\",east],LENGTHUNIT[\"foot\",0.3048]]"),
      0.3048);
  EXPECT_FALSE(wkt_metres_per_unit("GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174532925199433]]"));
  EXPECT_FALSE(wkt_metres_per_unit("PROJCS[\"cut"));
  EXPECT_FALSE(wkt_metres_per_unit(""));
}

TEST(LasUnit, ReadsGeoTiffKeys) {
  EXPECT_EQ(*las_metres_per_unit(with_key(directory(3076, 9002))), 0.3048);
  EXPECT_EQ(*las_metres_per_unit(with_key(directory(3076, 9001))), 1.0);
  EXPECT_FALSE(las_metres_per_unit(with_key(directory(3076, 9102)))) << "degrees";
  EXPECT_FALSE(las_metres_per_unit(with_key(directory(3077, 9)))) << "no size is there";
  EXPECT_FALSE(las_metres_per_unit(with_key(std::string(9, 'x'))));
  EXPECT_FALSE(las_metres_per_unit(LasHeader{}));
}

TEST(LasUnit, ProjectedSystemsByTheirNumber) {
  EXPECT_EQ(las_projected_code(with_key(directory(3072, 2154))), "EPSG:2154");
  EXPECT_EQ(las_projected_code(with_key(directory(3072, 32767))), "") << "defined by the user";
  EXPECT_EQ(las_projected_code(with_key(directory(3076, 9001))), "");
  EXPECT_EQ(las_projected_code(LasHeader{}), "");
  const std::string keys = las_key_directory("EPSG:25832");
  const LasHeader header = with_key(keys);
  EXPECT_EQ(las_projected_code(header), "EPSG:25832");
  EXPECT_EQ(*las_metres_per_unit(header), 1.0);
  EXPECT_EQ(las_coordinate_systems(header), std::vector<std::string>{"EPSG:25832"});
  // The directory counts its keys, which ascend.
  EXPECT_EQ(las_number<std::uint16_t>(keys, 6) * 8U + 8U, keys.size());
  for (std::size_t at = 16; at < keys.size(); at += 8)
    EXPECT_LT(las_number<std::uint16_t>(keys, at - 8), las_number<std::uint16_t>(keys, at));
}

}  // namespace
}  // namespace limen
