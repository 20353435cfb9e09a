// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/sample_model.h"

#include <algorithm>

#include "support/synthetic_model.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/extract/model/model_edges.h"
#include "limen/extract/model/model_surface.h"

namespace limen {
namespace {

TEST(SampleModel, PointsKeepTheirDistanceAndLeaveNoRoom) {
  BimModel model;
  add_box(model, BimKind::slab, {0, 0, 0}, {2, 1, 0.5});
  ModelSamplingOptions options;
  options.spacing_m = 0.05;
  const Scan scan = sample_model(model, options);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) ASSERT_GE((scan.points[i] - scan.points[k]).norm(), 0.05);
  }
  // Every place of the top has a point within little more than the spacing.
  for (double x = 0.0; x <= 2.0; x += 0.04) {
    for (double y = 0.0; y <= 1.0; y += 0.04) {
      const bool near = std::any_of(scan.points.begin(), scan.points.end(), [&](const Vector3d& p) {
        return (p - Vector3d(x, y, 0.5)).norm() < 0.075;
      });
      EXPECT_TRUE(near) << x << " " << y;
    }
  }
  EXPECT_EQ(sample_model(model, options).points, scan.points);
}

TEST(SampleModel, TooFineASpacingIsRefused) {
  BimModel model;
  add_box(model, BimKind::slab, {0, 0, 0}, {200, 100, 0.5});
  ModelSamplingOptions options;
  options.spacing_m = 0.01;
  EXPECT_THROW(sample_model(model, options), Error);
}

TEST(SampleModel, DetectorFindsTheRoomsEdges) {
  const BimModel model = row_of_rooms({5.0});
  const std::vector<Segment> found = sampled_model_segments(model);
  const std::vector<Segment> exact = sharp_edges(visible_surface(model).polygons);
  // Of every inner edge, most of the length is met within a centimetre.
  for (const Segment& edge : exact) {
    int met = 0;
    for (int k = 1; k < 20; ++k) {
      const Vector3d x = edge.a + (edge.b - edge.a) * (k / 20.0);
      met += std::any_of(found.begin(), found.end(),
                         [&](const Segment& s) {
                           const double t = std::clamp((x - s.a).dot(s.direction()), 0.0, s.length());
                           return (x - s.a - t * s.direction()).norm() < 0.01;
                         })
                 ? 1
                 : 0;
    }
    EXPECT_GE(met, 15) << edge.a.transpose() << " to " << edge.b.transpose();
  }
}

}  // namespace
}  // namespace limen
