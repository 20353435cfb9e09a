// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/building_deviation.h"

#include <cmath>

#include "support/box_room.h"
#include <gtest/gtest.h>

#include "limen/base/error.h"
#include "limen/base/parallel.h"
#include "limen/deviation/join_models.h"

namespace limen {
namespace {

/// Places in the room from which scans are taken.
const std::vector<Vector3d>& eyes() {
  static const std::vector<Vector3d> kEyes = {{3.0, 2.6, 1.5}, {1.0, 1.0, 1.6}, {5.2, 3.9, 1.4}};
  return kEyes;
}

BuildingDeviation measured(const std::vector<Box>& built, const BimModel& model, double pose_error_m = 0.0) {
  BuildingMeasurement measurement(model);
  RandomStream random(3);
  for (std::size_t k = 0; k < eyes().size(); ++k) {
    Rigid3 pose;
    for (Eigen::Index axis = 0; axis < 3; ++axis) pose.translation[axis] = pose_error_m * random.normal();
    measurement.add(scan_of(built, eyes()[k], kRays, 20 + k), pose, pose_error_m);
  }
  return measurement.finish();
}

/// Its error along the directions that are held.
double error_of(const ElementDeviation& it, const Vector3d& truth) {
  Vector3d error = it.shift.shift_m - truth;
  for (const Vector3d& open : it.shift.open) error -= open.dot(error) * open;
  return error.norm();
}

TEST(BuildingDeviation, OneScanSaysWhatItSaysByItself) {
  const BimModel model = model_of(room());
  const Scan scan = scan_of(room(), kEye, kRays);
  const Deviation alone = measure_deviation(scan, model, {});
  BuildingMeasurement measurement(model);
  const LaidScan laid = measurement.add(scan, {}, 0.0);
  const BuildingDeviation all = measurement.finish();
  EXPECT_EQ(laid.element, alone.element);
  EXPECT_EQ(all.matched, alone.matched);
  ASSERT_EQ(all.elements.size(), alone.elements.size());
  for (std::size_t k = 0; k < alone.elements.size(); ++k) {
    const ElementDeviation& a = all.elements[k];
    const ElementDeviation& b = alone.elements[k];
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.presence, b.presence);
    EXPECT_EQ(a.covered_m2, b.covered_m2);
    EXPECT_NEAR(a.median_m, b.median_m, 0.0001);
    EXPECT_NEAR(a.mean_m, b.mean_m, 1e-6);
    EXPECT_NEAR(a.sigma_m, b.sigma_m, 1e-6);
    EXPECT_NEAR(a.p95_m, b.p95_m, 0.0001);
    EXPECT_LT((a.shift.shift_m - b.shift.shift_m).norm(), 1e-9);
    EXPECT_EQ(all.seen_by[k], 1);
  }
}

TEST(BuildingDeviation, ManyScansWithErringPosesTellShiftsBetterThanEach) {
  std::vector<Box> built = room();
  std::vector<Vector3d> shifts(built.size(), Vector3d::Zero());
  shifts[2] = {0.02, 0.0, 0.0};
  shifts[6] = {-0.018, 0.024, 0.0};
  shifts[7] = {0.0, -0.03, 0.0};
  for (std::size_t k = 0; k < built.size(); ++k) built[k] = shifted(built[k], shifts[k]);
  const BimModel model = model_of(room());
  constexpr double kPoseErrorM = 0.003;
  const BuildingDeviation all = measured(built, model, kPoseErrorM);
  RandomStream random(3);
  double together = 0.0;
  double each = 0.0;
  for (std::size_t k = 0; k < built.size(); ++k)
    together += std::pow(error_of(all.elements[k], shifts[k]), 2);
  for (std::size_t s = 0; s < eyes().size(); ++s) {
    Rigid3 pose;
    for (Eigen::Index axis = 0; axis < 3; ++axis) pose.translation[axis] = kPoseErrorM * random.normal();
    const Deviation one = measure_deviation(scan_of(built, eyes()[s], kRays, 20 + s), model, pose);
    for (std::size_t k = 0; k < built.size(); ++k) each += std::pow(error_of(one.elements[k], shifts[k]), 2);
    EXPECT_LT((all.scans[s].common.shift_m - one.common.shift_m).norm(), 1e-9);
  }
  EXPECT_LT(together, each / static_cast<double>(eyes().size()));
  EXPECT_LT(std::sqrt(together / static_cast<double>(built.size())), 0.0035);
}

TEST(BuildingDeviation, WhatOneScanMissedAnotherFoundAndPiecesGrowTogether) {
  std::vector<Box> built = room();
  built.erase(built.begin() + 6);                                           // the column
  built.push_back({{4.9, 3.0, 0.0}, {5.5, 3.5, 0.8}, BimKind::furniture});  // a crate
  const BuildingDeviation all = measured(built, model_of(room()));
  EXPECT_EQ(all.elements[6].presence, Presence::not_found);
  ASSERT_EQ(all.unmodelled.size(), 1U);
  EXPECT_EQ(all.scans.size(), 3U);
  EXPECT_EQ(all.elements[0].presence, Presence::found);
  EXPECT_EQ(all.seen_by[0], 3);
  EXPECT_LT((all.unmodelled[0].low - Vector3d(4.9, 3.0, 0.1)).norm(), 0.1);
}

TEST(BuildingDeviation, ThreadsDoNotChangeIt) {
  const auto run = [](int threads) {
    set_thread_count(threads);
    const BuildingDeviation all = measured(room(), model_of(room()), 0.002);
    set_thread_count(0);
    return all;
  };
  const BuildingDeviation a = run(1);
  const BuildingDeviation b = run(3);
  for (std::size_t k = 0; k < a.elements.size(); ++k) {
    EXPECT_EQ(a.elements[k].shift.shift_m, b.elements[k].shift.shift_m);
    EXPECT_EQ(a.elements[k].mean_m, b.elements[k].mean_m);
    EXPECT_EQ(a.elements[k].passed_m2, b.elements[k].passed_m2);
  }
}

TEST(BuildingDeviation, MistakesAreNamed) {
  EXPECT_THROW(BuildingMeasurement{BimModel{}}, Error);
  const BimModel model = model_of(room());
  BuildingMeasurement measurement(model);
  EXPECT_THROW(measurement.add(Scan{}, {}, 0.0), Error);
}

TEST(JoinedOffset, WorsePosesCountLessAndOneThatDisagreesIsOutvoted) {
  const Vector3d n = Vector3d::UnitX();
  std::vector<FaceOffset> views = {{n, 0.010, 0.002, 1500, false, 0.001},
                                   {n, 0.012, 0.002, 1500, false, 0.001},
                                   {n, 0.060, 0.002, 1500, false, 0.001}};
  EXPECT_NEAR(joined_offset(views).offset_m, 0.011, 0.0005);
  EXPECT_FALSE(joined_offset(views).contested);
  views[2] = {n, 0.020, 0.002, 1500, false, 0.030};
  EXPECT_NEAR(joined_offset(views).offset_m, 0.011, 0.0005);
  views = {{n, 0.010, 0.002, 1500, true, 0.0}};
  EXPECT_TRUE(joined_offset(views).contested);
  EXPECT_EQ(joined_offset({}).points, 0U);
}

TEST(JoinModels, PartsOfOneBuildingBecomeOneModel) {
  std::vector<Box> boxes = room();
  BimModel whole = model_of(boxes);
  for (std::size_t k = 0; k < whole.elements.size(); ++k) whole.elements[k].guid = "guid" + std::to_string(k);
  // The second file: the last three elements in coordinates of its own, and the first wall once more.
  const Rigid3 second_from_first{rotation_exp({0.0, 0.0, 0.7}), Vector3d(100, -50, 3)};
  BimModel first = whole;
  BimModel second = whole;
  std::erase_if(first.faces, [](const BimFace& face) { return face.element >= 5; });
  std::erase_if(second.faces, [](const BimFace& face) { return face.element < 5 && face.element != 2; });
  second.local_origin = {95, -50, 0};
  const Rigid3 local = to_local(second_from_first, Vector3d::Zero(), second.local_origin);
  for (BimFace& face : second.faces) {
    face.plane = transformed(local, face.plane);
    face.frame.origin = local * face.frame.origin;
    face.frame.u = local.rotation * face.frame.u;
    face.frame.v = local.rotation * face.frame.v;
  }
  const JoinedModel joined = join_models({{first, {}}, {second, inverse(second_from_first)}});
  EXPECT_EQ(joined.model.elements.size(), 11U);
  EXPECT_EQ(joined.doubled, 5U);  // those of the first file that have faces there
  EXPECT_EQ(joined.model.faces.size(), whole.faces.size());
  ASSERT_EQ(joined.model_of_element.size(), 11U);
  EXPECT_EQ(joined.model_of_element[10], 1);
  joined.model.check();
  BuildingMeasurement measurement(joined.model);
  measurement.add(scan_of(boxes, kEye, kRays), {}, 0.0);
  const BuildingDeviation all = measurement.finish();
  for (std::size_t k = 0; k < 8; ++k) {
    const ElementDeviation& it = all.elements[k < 5 ? k : k + 3];
    EXPECT_EQ(it.presence, Presence::found) << k;
    EXPECT_NEAR(it.median_m, 0.0, 0.0005);
  }
}

}  // namespace
}  // namespace limen
