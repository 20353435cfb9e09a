// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/store/scan_picture.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/random.h"

namespace limen {
namespace {

/// A wall of 10 m by 3 m, two thirds of its points on its first metre, and each point's number as its
/// colour.
Scan uneven_wall(std::size_t points) {
  RandomStream random(7, 1);
  Scan scan;
  scan.local_origin = {652000.0, 6862000.0, 35.0};
  for (std::size_t i = 0; i < points; ++i) {
    const double reach = i % 3 == 0 ? 10.0 : 1.0;
    scan.points.emplace_back(reach * random.uniform(), 0.0, 3.0 * random.uniform());
    for (const std::size_t byte : {i & 255U, (i >> 8U) & 255U, (i >> 16U) & 255U})
      scan.colours.push_back(static_cast<std::uint8_t>(byte));
    scan.intensities.push_back(static_cast<float>(i));
  }
  return scan;
}

TEST(ScanPicture, IsEvenOverTheSurfaceAndComesBackInPart) {
  const Scan scan = uneven_wall(200000);
  const Scan picture = picture_of(scan, 3000);
  EXPECT_LE(picture.size(), 3000U);
  EXPECT_GE(picture.size(), 1000U);
  const std::string bytes = picture_bytes(picture);
  for (const std::size_t most : {std::size_t{400}, std::size_t{1000000}}) {
    const Scan back = picture_from(bytes, "here", most);
    ASSERT_EQ(back.size(), std::min(most, picture.size()));
    EXPECT_EQ(back.local_origin, scan.local_origin);
    std::size_t far = 0;
    for (std::size_t k = 0; k < back.size(); ++k) {
      const std::size_t i =
          back.colours[3 * k] + 256U * back.colours[3 * k + 1] + 65536U * back.colours[3 * k + 2];
      EXPECT_LT((back.points[k] - scan.points[i]).norm(), 1e-5);
      EXPECT_EQ(back.intensities[k], scan.intensities[i]);
      far += back.points[k].x() > 1.0 ? 1 : 0;
    }
    // Of the points three tenths lie beyond the first metre, of the surface nine tenths.
    EXPECT_GT(static_cast<double>(far), 0.8 * static_cast<double>(back.size())) << most;
  }
}

TEST(ScanPicture, DamagedBytesAreStatedSo) {
  const std::string bytes = picture_bytes(picture_of(uneven_wall(100), 50));
  EXPECT_THROW(picture_from(bytes.substr(0, bytes.size() / 2), "here", 10), Error);
  EXPECT_EQ(picture_from(picture_bytes(Scan{}), "here", 10).size(), 0U);
}

}  // namespace
}  // namespace limen
