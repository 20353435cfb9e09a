// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/json/features_json.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limen/report/json/json_values.h"

namespace limen {
namespace {

/// A tilted square of 4 m x 4 m with a square hole, far out on a national grid, and a part of 1 m x 1 m.
Features far_features() {
  PlanarPolygon polygon;
  polygon.plane.normal = Vector3d(1, 2, 3).normalized();
  polygon.plane.offset = 0.75;
  polygon.frame = make_frame(polygon.plane, Vector3d(1, 2, 3));
  polygon.parts.resize(2);
  polygon.parts[0].outer = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
  polygon.parts[0].holes = {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}};
  polygon.parts[1].outer = {{5, 5}, {6, 5}, {6, 6}, {5, 6}};
  polygon.inliers = 1234;
  Features features;
  features.local_origin = Vector3d(1050000, 6840000, 100);
  features.planes = {polygon};
  return features;
}

Vector3d vector_of(const Json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

TEST(FeaturesJson, OutlineLiesInThePlaneAtNationalGridCoordinates) {
  const Json json = Json::parse(features_json(far_features(), {}));
  ASSERT_EQ(json["planes"].size(), 1U);
  const Json& plane = json["planes"][0];
  const Vector3d normal = vector_of(plane["normal"]);
  const auto offset = plane["offset"].get<double>();
  ASSERT_EQ(plane["outline"].size(), 2U);
  ASSERT_EQ(plane["parts"].size(), 1U);
  for (const Json& ring : {plane["outline"][0], plane["outline"][1], plane["parts"][0][0]}) {
    ASSERT_EQ(ring.size(), 4U);
    for (const Json& point : ring) EXPECT_NEAR(normal.dot(vector_of(point)), offset, 1e-8);
  }
  EXPECT_EQ(plane["inliers"], 1234);
}

TEST(FeaturesJson, OutlineKeepsItsSize) {
  const Json json = Json::parse(features_json(far_features(), {}));
  const Json& outer = json["planes"][0]["outline"][0];
  const Json& hole = json["planes"][0]["outline"][1];
  EXPECT_NEAR((vector_of(outer[1]) - vector_of(outer[0])).norm(), 4.0, 1e-8);
  EXPECT_NEAR((vector_of(hole[2]) - vector_of(hole[0])).norm(), 2.0 * std::sqrt(2.0), 1e-8);
}

TEST(FeaturesJson, OpeningsKeepEveryField) {
  Features features = far_features();
  Opening opening;
  opening.corners[0] = Vector3d(1, 2, 3);
  opening.corners[2] = Vector3d(2.125, 2, 4.5);
  opening.facade = 0;
  opening.evidence = 321;
  opening.view = OpeningView::recess;
  opening.edge_sigma_m[1] = 0.0625;
  opening.reveal_depth_m = 0.25;
  opening.reveal_sigma_m = 0.005;
  opening.reveal_complete = true;
  opening.outline = {Vector3d(0, 0, 1), Vector3d(1, 0, 1), Vector3d(1, 0, 2)};
  features.openings = {opening};
  const Json json = Json::parse(openings_json(features, {}));
  ASSERT_EQ(json["openings"].size(), 1U);
  const Json& it = json["openings"][0];
  EXPECT_EQ(vector_of(it["corners"][0]), Vector3d(1050001, 6840002, 103));
  EXPECT_EQ(vector_of(it["corners"][2]), Vector3d(1050002.125, 6840002, 104.5));
  EXPECT_EQ(it["facade"], 0);
  EXPECT_EQ(it["evidence"], 321);
  EXPECT_EQ(it["view"], "recess");
  EXPECT_EQ(it["edge_sigma_m"], Json({1.0, 0.0625, 1.0, 1.0}));
  EXPECT_EQ(it["reveal_depth_m"], 0.25);
  EXPECT_EQ(it["reveal_sigma_m"], 0.005);
  EXPECT_EQ(it["reveal_complete"], true);
  EXPECT_EQ(vector_of(it["outline"][2]), Vector3d(1050001, 6840000, 102));
  EXPECT_EQ(json["planes"].size(), 1U);
}

TEST(FeaturesJson, NoPlanesIsAnEmptyList) {
  const Json json = Json::parse(features_json({}, {}));
  EXPECT_TRUE(json["planes"].is_array());
  EXPECT_TRUE(json["planes"].empty());
}

}  // namespace
}  // namespace limen
