// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/extract/model/model_surface.h"

#include <algorithm>
#include <cmath>

#include "support/synthetic_model.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/progress.h"
#include "limen/extract/model/model_edges.h"
#include "limen/extract/model/model_features.h"
#include "limen/sight/model_space.h"

namespace limen {
namespace {

double total_area(const ModelSurface& surface) {
  double sum = 0.0;
  for (const PlanarPolygon& polygon : surface.polygons) sum += polygon.area_m2;
  return sum;
}

double length_of(const std::vector<Segment>& segments) {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length();
  return sum;
}

TEST(CrossSection, BoxGivesItsRectangle) {
  BimModel model;
  add_box(model, BimKind::wall, {0, 0, 0}, {2, 1, 3});
  std::vector<const BimFace*> faces;
  for (const BimFace& face : model.faces) faces.push_back(&face);
  PlaneFrame frame;
  frame.origin = {0, 0, 1.5};
  EXPECT_NEAR(area(cross_section(faces, frame)), 2.0, 1e-9);
  frame.origin.z() = 3.5;
  EXPECT_TRUE(cross_section(faces, frame).empty());
  // Obliquely: a plane through the box's middle, 45 degrees about y.
  frame = {{1.0, 0.5, 1.5}, Vector3d(1, 0, 1).normalized(), Vector3d::UnitY()};
  EXPECT_NEAR(area(cross_section(faces, frame)), 2.0 * std::sqrt(2.0), 1e-9);
}

TEST(CrossSection, HollowBoxHasAHole) {
  BimModel model;
  add_box(model, BimKind::wall, {0, 0, 0}, {4, 4, 4});
  add_box(model, BimKind::wall, {1, 1, 1}, {3, 3, 3});
  // The inner box turned inside out: a cavity.
  for (std::size_t k = 6; k < 12; ++k) {
    BimFace& face = model.faces[k];
    face.plane = face.plane.flipped();
    std::swap(face.frame.u, face.frame.v);
    for (Vector2d& p : face.outline.outer) p = Vector2d(p.y(), p.x());
    std::reverse(face.outline.outer.begin(), face.outline.outer.end());
  }
  std::vector<const BimFace*> faces;
  for (const BimFace& face : model.faces) faces.push_back(&face);
  PlaneFrame frame;
  frame.origin = {0, 0, 2};
  EXPECT_NEAR(area(cross_section(faces, frame)), 12.0, 1e-9);
}

TEST(VisibleSurface, WhatStandsAgainstAnotherIsHidden) {
  BimModel model;
  add_box(model, BimKind::slab, {0, 0, -1}, {4, 4, 0});
  add_box(model, BimKind::wall, {1, 1, 0}, {3, 3, 2});
  const ModelSurface surface = visible_surface(model);
  // Slab 2 x 16 + 4 x 4, wall 4 x 4 + 4; the slab's top loses the wall's foot, the wall its foot.
  EXPECT_NEAR(total_area(surface), 32 + 16 - 4 + 16 + 4, 1e-6);
  EXPECT_EQ(surface.polygons.size(), 6U + 5U);
}

TEST(VisibleSurface, WhatPenetratesIsCutOff) {
  BimModel model;
  add_box(model, BimKind::slab, {0, 0, -1}, {4, 4, 0});
  add_box(model, BimKind::column, {1, 1, -0.5}, {2, 2, 2});
  EXPECT_NEAR(total_area(visible_surface(model)), 32 + 16 - 1 + 4 * 2 + 1, 1e-6);
}

TEST(VisibleSurface, FlushNeighboursBecomeOne) {
  BimModel model;
  add_box(model, BimKind::wall, {0, 0, 0}, {4, 0.2, 3});
  add_box(model, BimKind::wall, {4, 0, 0}, {9, 0.2, 3});
  const ModelSurface surface = visible_surface(model);
  ASSERT_EQ(surface.polygons.size(), 6U);
  EXPECT_NEAR(surface.polygons.front().area_m2, 27.0, 1e-6);
  EXPECT_EQ(surface.elements.front(), 1);  // it gives 15 of the 27 m2
  EXPECT_EQ(sharp_edges(surface.polygons).size(), 12U);
}

TEST(VisibleSurface, WindowsAndFurnitureAreNotBuilt) {
  BimModel model = row_of_rooms({5.0});
  const double bare = total_area(visible_surface(model));
  add_box(model, BimKind::furniture, {1, 1, 0}, {2, 2, 1});
  add_box(model, BimKind::window, {2, 4, 1}, {3, 4.2, 2});
  EXPECT_DOUBLE_EQ(total_area(visible_surface(model)), bare);
}

TEST(SharpEdges, RoomsHaveTwelveEdgesInsideEach) {
  const ModelSurface surface = visible_surface(row_of_rooms({5.0, 3.0}));
  // Outside: a box of 8.6 x 4.4 x 3.4; inside: two of 4 x 3 and 5 or 3.
  const double outside = 4 * (8.6 + 4.4 + 3.4);
  EXPECT_NEAR(length_of(sharp_edges(surface.polygons)), outside + 4 * (5 + 4 + 3) + 4 * (3 + 4 + 3), 1e-3);
}

TEST(SharpEdges, RoundColumnHasOnlyItsRims) {
  BimModel model;
  model.elements.push_back({BimKind::column, "IfcColumn", "", "", "", 0});
  constexpr int kSides = 32;
  std::vector<Vector3d> top;
  std::vector<Vector3d> foot;
  const auto at = [](int k, double z) {
    const double angle = 2.0 * 3.14159265358979 * k / kSides;
    return Vector3d(std::cos(angle), std::sin(angle), z);
  };
  for (int k = 0; k < kSides; ++k) {
    add_face(model, {at(k, 0), at(k + 1, 0), at(k + 1, 3), at(k, 3)}, 0);
    top.push_back(at(k, 3));
    foot.insert(foot.begin(), at(k, 0));
  }
  add_face(model, top, 0);
  add_face(model, foot, 0);
  const std::vector<Segment> edges = sharp_edges(visible_surface(model).polygons);
  EXPECT_EQ(edges.size(), 2U * kSides);
  for (const Segment& edge : edges) EXPECT_NEAR(edge.a.z(), edge.b.z(), 1e-9);
}

TEST(ModelFeatures, SamplesStandForTheWholeSurface) {
  const ModelFeatures made = model_features(row_of_rooms({5.0, 3.0}));
  double planes = 0.0;
  double samples = 0.0;
  for (const PlanarPolygon& plane : made.features.planes) planes += plane.area_m2;
  for (const SurfaceSample& sample : made.features.samples) samples += static_cast<double>(sample.area_m2);
  EXPECT_NEAR(samples, planes, 0.01 * planes);
  EXPECT_EQ(made.elements.size(), made.features.planes.size());
}

TEST(ModelFeatures, OpeningsAreSeenFromBothSides) {
  BimModel model = row_of_rooms({5.0});
  BimOpening opening;
  const Vector3d corners[4] = {{3, 4.2, 1}, {2, 4.2, 1}, {2, 4.2, 2}, {3, 4.2, 2}};
  std::copy(corners, corners + 4, opening.corners);
  opening.normal = Vector3d::UnitY();
  opening.thickness_m = 0.2;
  model.openings.push_back(opening);
  const Features features = model_features(model).features;
  ASSERT_EQ(features.openings.size(), 2U);
  for (const Opening& seen : features.openings) {
    const Plane& wall = features.planes[static_cast<std::size_t>(seen.facade)].plane;
    EXPECT_NEAR(wall.signed_distance(seen.corners[0]), 0.0, 1e-9);
    // Counter-clockwise from lower left, seen from where the wall's normal points to.
    const Vector3d turn = (seen.corners[1] - seen.corners[0]).cross(seen.corners[2] - seen.corners[1]);
    EXPECT_GT(turn.dot(wall.normal), 0.0);
    EXPECT_LT(seen.corners[0].z(), seen.corners[3].z());
  }
}

TEST(ModelSpace, KnowsItsSurfacesAndNothingElse) {
  const Features features = model_features(row_of_rooms({5.0, 3.0})).features;
  const ModelSpace space(features);
  SightQuery query;
  query.surface_m = 0.05;
  query.normal = Vector3d::UnitZ();
  query.oriented = true;
  query.at = {2.5, 2.0, 0.03};
  const Sight floor = space.look(query);
  ASSERT_EQ(floor.kind, SightKind::surface);
  EXPECT_NEAR(floor.distance_m, 0.03, 1e-9);
  query.normal = -Vector3d::UnitZ();
  EXPECT_EQ(space.look(query).kind, SightKind::unseen);  // seen from below
  query.normal = Vector3d::UnitZ();
  query.at = {2.5, 2.0, 0.06};
  EXPECT_EQ(space.look(query).kind, SightKind::unseen);  // too far
  query.at = {2.5, 4.13, 0.0};
  EXPECT_EQ(space.look(query).kind, SightKind::unseen);  // under a wall
  query.at = {2.5, 2.0, 1.5};
  EXPECT_EQ(space.look(query).kind, SightKind::unseen);  // in the air: things may stand there
}

TEST(VisibleSurface, RefusesAModelInMillimetres) {
  BimModel model;
  add_box(model, BimKind::wall, {0, 0, 0}, {8000, 200, 3000});
  EXPECT_THROW((void)visible_surface(model), Error);
  EXPECT_THROW((void)model_features(model), Error);
}

TEST(ModelFeatures, AreBoundedByTheSurfaceTheyStandFor) {
  BimModel model;
  add_box(model, BimKind::slab, {0, 0, 0}, {100, 100, 0.2});
  EXPECT_THROW((void)model_features(model, 0.001), Error);  // 2e10 tiles
  // A thin strip across a large box has few tiles, and its row is not walked from end to end of the box.
  BimModel diagonal;
  diagonal.elements.push_back({BimKind::wall, "IfcWall", "", "", "", 0});
  add_face(diagonal, {{0, 0, 0}, {1000, 700, 0}, {1000, 702, 0}, {0, 2, 0}}, 0);
  const ModelFeatures made = model_features(diagonal);
  double area = 0.0;
  for (const SurfaceSample& sample : made.features.samples) area += static_cast<double>(sample.area_m2);
  EXPECT_NEAR(area, 2000.0, 40.0);
}

TEST(ModelFeatures, CanBeStopped) {
  const ModelSurface surface = visible_surface(row_of_rooms({5.0}));
  Monitor monitor;
  const CancelScope scope(monitor);
  monitor.cancel();
  EXPECT_THROW((void)sharp_edges(surface.polygons), Error);
}

TEST(ModelSpace, RefusesBoxesThatNoMemoryHolds) {
  Features features;
  PlanarPolygon strip;
  strip.parts = {{{{0, 0}, {1e6, 1e6}, {1e6, 1e6 + 1}}, {}}};
  features.planes = {strip};
  EXPECT_THROW((void)ModelSpace(features), Error);
}

}  // namespace
}  // namespace limen
