// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/html_scene.h"

#include "support/box_room.h"
#include "support/synthetic_room.h"
#include <gtest/gtest.h>

namespace limen {
namespace {

PicturedSide pictured_about(const Vector3d& origin) {
  PicturedSide pictured;
  pictured.features.local_origin = origin;
  return pictured;
}

TEST(HtmlScene, WhatIsDrawnStandsInTheWorldWhereTheScanHasIt) {
  RegisterInput input;
  input.scans.push_back({box_scan(500, -1.2, 1.5), {}});
  Scan& scan = input.scans.front().scan;
  scan.local_origin = {6840000.0, 1050000.0, 100.0};
  const SceneSide side = with_picture(scene_side(input), pictured_about({6839990.5, 1050003.0, 98.25}));
  ASSERT_EQ(side.points.size(), scan.size());
  EXPECT_EQ(side.origin, Vector3d(6839990.5, 1050003.0, 98.25));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vector3d apart = side.points[i] - scan.points[i] - (scan.local_origin - side.origin);
    EXPECT_LT(apart.norm(), 1e-12);
  }
}

TEST(HtmlScene, FacesOfAModelAsWell) {
  RegisterInput input;
  input.model = model_of({{Vector3d(0, 0, 0), Vector3d(4, 0.3, 2.5)}});
  input.model->local_origin = {100.0, 200.0, 5.0};
  const SceneSide given = with_picture(scene_side(input), pictured_about(input.model->local_origin));
  const SceneSide moved = with_picture(scene_side(input), pictured_about({90.0, 201.0, 5.5}));
  ASSERT_EQ(given.faces.size(), moved.faces.size());
  ASSERT_GT(given.faces.size(), 0U);
  for (std::size_t k = 0; k < given.faces.size(); ++k) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_LT((moved.faces[k][corner] - given.faces[k][corner] - Vector3d(10.0, -1.0, -0.5)).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace limen
