// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/deviation.h"

#include <cmath>
#include <numbers>

#include "support/box_room.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/base/random.h"
#include "limen/deviation/element_shift.h"
#include "limen/deviation/unmodelled.h"

namespace limen {
namespace {

TEST(Deviation, AsBuiltAsPlannedEverythingIsAtNoise) {
  const BimModel model = model_of(room());
  const Rigid3 scan_from_model{rotation_exp({0.1, -0.3, 2.0}), Vector3d(7, -3, 2)};
  Scan scan = scan_of(room(), kEye, kRays);
  for (Vector3d& x : scan.points) x = scan_from_model * x;
  scan.centres[0] = scan_from_model * kEye;
  const Deviation found = measure_deviation(scan, model, inverse(scan_from_model));
  EXPECT_EQ(found.far, 0U);
  EXPECT_TRUE(found.unmodelled.empty());
  EXPECT_GT(static_cast<double>(found.matched), 0.9 * static_cast<double>(scan.size()));
  for (const ElementDeviation& it : found.elements) {
    EXPECT_EQ(it.presence, Presence::found) << it.element;
    EXPECT_GT(it.covered_share, 0.99);
    EXPECT_NEAR(it.median_m, 0.0, 0.0005);
    EXPECT_NEAR(it.sigma_m, 0.0027, 0.0012);  // along the normal, of rays that meet it at a slant
    EXPECT_LT(it.p95_m, 0.0065);
    EXPECT_LT(it.shift.shift_m.norm(), 0.001);
  }
  EXPECT_EQ(found.common.held, 3);
  EXPECT_LT(found.common.shift_m.norm(), 0.001);
}

TEST(Deviation, ShiftsOfOneToFiveCentimetresAreFound) {
  RandomStream random(5);
  for (int trial = 0; trial < 6; ++trial) {
    std::vector<Box> built = room();
    std::vector<Vector3d> shifts(built.size(), Vector3d::Zero());
    for (const std::size_t k : {2U, 5U, 6U, 7U}) {
      const double length = random.uniform(0.01, 0.05);
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      shifts[k] = {length * std::cos(angle), length * std::sin(angle), 0.0};
      built[k] = shifted(built[k], shifts[k]);
    }
    const Deviation found = measure_deviation(scan_of(built, kEye, kRays), model_of(room()), {});
    for (std::size_t k = 0; k < built.size(); ++k) {
      const ElementDeviation& it = found.elements[k];
      ASSERT_GE(it.points, 1000U);
      Vector3d error = it.shift.shift_m - shifts[k];
      for (const Vector3d& open : it.shift.open) error -= open.dot(error) * open;
      EXPECT_LT(error.norm(), 0.003) << "trial " << trial << " element " << k;
      EXPECT_EQ(it.shift.held + static_cast<int>(it.shift.open.size()), 3);
    }
    // Walls are held across only, the column across both ways.
    EXPECT_EQ(found.elements[2].shift.held, 1);
    for (const Vector3d& open : found.elements[2].shift.open) EXPECT_NEAR(open.x(), 0.0, 1e-6);
    EXPECT_EQ(found.elements[6].shift.held, 2);
    // The sign: a surface that protrudes towards the room is positive.
    EXPECT_NEAR(found.elements[2].median_m, shifts[2].x(), 0.001);
    EXPECT_NEAR(found.elements[5].median_m, -shifts[5].y(), 0.001);
  }
}

TEST(Deviation, WhatIsNotThereAndWhatTheModelDoesNotHave) {
  std::vector<Box> built = room();
  built.erase(built.begin() + 6);                                           // the column
  built.push_back({{4.9, 3.6, 0.0}, {5.5, 4.4, 0.8}, BimKind::furniture});  // a crate
  built.push_back({{0.6, 0.7, 0.9}, {0.9, 1.0, 1.2}, BimKind::furniture});  // a lamp
  std::vector<Box> planned = room();
  planned.push_back({{8.0, 0.0, 0.0}, {8.2, 5.0, 3.0}, BimKind::wall});     // in the next room
  planned.push_back({{2.0, 0.3, 1.0}, {3.0, 0.35, 2.0}, BimKind::window});  // rays pass a pane
  const Deviation found = measure_deviation(scan_of(built, kEye, kRays), model_of(planned), {});
  EXPECT_EQ(found.elements[6].presence, Presence::not_found);
  EXPECT_GT(found.elements[6].passed_m2, 0.5);
  EXPECT_EQ(found.elements[7].presence, Presence::found);
  EXPECT_EQ(found.elements[8].presence, Presence::not_judged);
  EXPECT_EQ(found.elements[8].points, 0U);
  EXPECT_EQ(found.elements[9].presence, Presence::not_judged);
  ASSERT_EQ(found.unmodelled.size(), 2U);
  EXPECT_LT((found.unmodelled[0].high - Vector3d(5.5, 4.4, 0.8)).norm(), 0.1);
  EXPECT_LT((found.unmodelled[1].centre - Vector3d(0.8, 0.9, 1.05)).norm(), 0.2);
  EXPECT_TRUE(found.unmodelled[0].within_model);
}

TEST(Deviation, WithoutAnOpticalCentreNothingIsMissed) {
  std::vector<Box> built = room();
  built.erase(built.begin() + 6);
  Scan scan = scan_of(built, kEye, kRays);
  scan.centres.clear();
  const Deviation found = measure_deviation(scan, model_of(room()), {});
  EXPECT_FALSE(found.oriented);
  EXPECT_EQ(found.elements[6].presence, Presence::not_judged);
  EXPECT_EQ(found.elements[2].presence, Presence::found);
  EXPECT_NEAR(found.elements[2].median_m, 0.0, 0.001);
}

TEST(Deviation, ASheetIsSeenFromEitherSide) {
  // A single face that is no solid, its normal away from the scanner.
  BimModel model;
  model.name = "sheet";
  model.elements.push_back({BimKind::wall, "Sheet", "", "sheet", "", 0});
  model.faces.push_back(face_of({{0, 2, 0}, {4, 2, 3}}, 1, true, 0));
  const Scan scan = scan_of({{{0, 2.02, 0}, {4, 2.1, 3}}}, {2, 0, 1.5}, kRays);
  const Deviation found = measure_deviation(scan, model, {});
  EXPECT_EQ(found.elements[0].presence, Presence::found);
  EXPECT_NEAR(found.elements[0].median_m, -0.02, 0.001);  // behind the side that is seen
  EXPECT_LT((found.elements[0].shift.shift_m - Vector3d(0, 0.02, 0)).norm(), 0.001);
}

TEST(Deviation, TheSameForAnyThreads) {
  const Scan scan = scan_of(room(), kEye, 30000);
  const BimModel model = model_of(room());
  set_thread_count(1);
  const Deviation one = measure_deviation(scan, model, {});
  set_thread_count(3);
  const Deviation three = measure_deviation(scan, model, {});
  set_thread_count(0);
  EXPECT_EQ(one.element, three.element);
  for (std::size_t k = 0; k < one.elements.size(); ++k) {
    EXPECT_EQ(one.elements[k].shift.shift_m, three.elements[k].shift.shift_m);
    EXPECT_EQ(one.elements[k].covered_m2, three.elements[k].covered_m2);
    EXPECT_EQ(one.elements[k].passed_m2, three.elements[k].passed_m2);
  }
}

TEST(Deviation, BadInputIsNamed) {
  const Scan scan = scan_of(room(), kEye, 1000);
  const BimModel model = model_of(room());
  EXPECT_THROW((void)measure_deviation({}, model, {}), Error);
  EXPECT_THROW((void)measure_deviation(scan, {}, {}), Error);
  DeviationOptions options;
  options.max_distance_m = 0.0;
  EXPECT_THROW((void)measure_deviation(scan, model, {}, options), Error);
}

TEST(Deviation, ClassesOfAccuracy) {
  EXPECT_EQ(loa_class(0.0), 50);
  EXPECT_EQ(loa_class(0.001), 50);
  EXPECT_EQ(loa_class(0.0011), 40);
  EXPECT_EQ(loa_class(0.015), 30);
  EXPECT_EQ(loa_class(0.0151), 20);
  EXPECT_EQ(loa_class(0.05), 20);
  EXPECT_EQ(loa_class(0.15), 10);
  EXPECT_EQ(loa_class(0.16), 0);
}

TEST(FaceOffset, OtherSurfaceWithinReachDoesNotPull) {
  RandomStream random(3);
  std::vector<float> distances;
  for (int i = 0; i < 600; ++i) distances.push_back(static_cast<float>(0.021 + 0.003 * random.normal()));
  for (int i = 0; i < 300; ++i) distances.push_back(static_cast<float>(random.uniform(0.04, 0.1)));
  const FaceOffset face = face_offset(Vector3d::UnitX(), distances, 0.1);
  EXPECT_NEAR(face.offset_m, 0.021, 0.0006);
  EXPECT_NEAR(face.sigma_m, 0.003, 0.0008);
}

TEST(ShiftOf, OneFaceThatSaysOtherwiseIsOutvoted) {
  const Vector3d shift(0.03, -0.01, 0.0);
  std::vector<FaceOffset> faces;
  for (const Vector3d& n : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                            Vector3d(0.6, 0.8, 0), Vector3d(0.8, -0.6, 0)})
    faces.push_back({n, n.dot(shift), 0.003, 1500});
  faces[1].offset_m += 0.05;
  const ElementShift found = shift_of(faces, {});
  EXPECT_EQ(found.held, 2);
  ASSERT_EQ(found.open.size(), 1U);
  EXPECT_NEAR(std::abs(found.open[0].z()), 1.0, 1e-9);
  EXPECT_LT((found.shift_m - shift).norm(), 0.001);
}

TEST(PiecesOf, TouchingCubesAreOnePiece) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(0.1 * i, 0.0, -2.0);
  for (int i = 0; i < 20; ++i) points.emplace_back(0.1 * i, 3.0, 0.0);
  points.emplace_back(9.0, 9.0, 9.0);
  const auto pieces = pieces_of(points, 0.15, 5, Vector3d::Zero(), Vector3d::Constant(5.0));
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].points, 50U);
  EXPECT_FALSE(pieces[0].within_model);
  EXPECT_EQ(pieces[1].points, 20U);
  EXPECT_TRUE(pieces[1].within_model);
  EXPECT_NEAR(pieces[1].high.x(), 1.9, 1e-9);
}

}  // namespace
}  // namespace limen
