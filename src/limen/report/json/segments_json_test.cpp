// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "limen/report/json/features_json.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

TEST(SegmentsJson, EndsAreWorldCoordinates) {
  Features features;
  features.local_origin = Vector3d(1050000, 6840000, 100);
  features.segments = {{Vector3d(0.125, 1, 2), Vector3d(3, 4.5, 5)}, {}};
  const Json json = Json::parse(segments_json(features, {}));
  ASSERT_EQ(json["segments"].size(), 2U);
  EXPECT_EQ(json["segments"][0]["a"], Json::parse("[1050000.125, 6840001.0, 102.0]"));
  EXPECT_EQ(json["segments"][0]["b"], Json::parse("[1050003.0, 6840004.5, 105.0]"));
}

TEST(SegmentsJson, NoSegmentsIsAnEmptyList) {
  const Json json = Json::parse(segments_json({}, {}));
  EXPECT_TRUE(json["segments"].is_array());
  EXPECT_TRUE(json["segments"].empty());
}

}  // namespace
}  // namespace limen
