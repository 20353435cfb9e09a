// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/laws.h"

#include "limen/geometry/alpha_shape.h"
#include "limen/geometry/polygon.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/geometry/rigid.h"
#include "limen/geometry/triangulate.h"

namespace limen {
namespace {

using namespace testing_laws;

/// Clipping works on a grid of 10 um, and the borders here are at most 400 m long.
constexpr double kClipTolerance_m2 = 4e-3;

double distance(const Rigid3& a, const Rigid3& b) {
  return (a.rotation - b.rotation).norm() + (a.translation - b.translation).norm();
}

Vector2d moved(const Rigid3& b_from_a, const Vector2d& p) {
  const Vector3d x = b_from_a * Vector3d(p.x(), p.y(), 0.0);
  return {x.x(), x.y()};
}

/// A motion within the plane.
Rigid3 plane_motion() {
  Rigid3 b_from_a;
  b_from_a.rotation = rotation_exp(Vector3d(0.0, 0.0, number(-3.1, 3.1)));
  b_from_a.translation = {number(-50.0, 50.0), number(-50.0, 50.0), 0.0};
  return b_from_a;
}

Ring moved(const Rigid3& b_from_a, Ring ring) {
  for (Vector2d& p : ring) p = moved(b_from_a, p);
  return ring;
}

std::vector<Polygon> moved(const Rigid3& b_from_a, std::vector<Polygon> polygons) {
  for (Polygon& polygon : polygons) {
    polygon.outer = moved(b_from_a, polygon.outer);
    for (Ring& hole : polygon.holes) hole = moved(b_from_a, hole);
  }
  return polygons;
}

RC_GTEST_PROP(RigidLaws, AMotionAndItsInverseCancel, ()) {
  const Rigid3 b_from_a = motion();
  RC_ASSERT(distance(inverse(b_from_a) * b_from_a, {}) < 1e-11);
  RC_ASSERT(distance(b_from_a * inverse(b_from_a), {}) < 1e-11);
  RC_ASSERT(distance(inverse(inverse(b_from_a)), b_from_a) < 1e-11);
}

RC_GTEST_PROP(RigidLaws, ComposingIsMovingTwice, ()) {
  const Rigid3 c_from_b = motion();
  const Rigid3 b_from_a = motion();
  const Rigid3 d_from_c = motion();
  const Vector3d x = vector(100.0);
  RC_ASSERT(((c_from_b * b_from_a) * x - c_from_b * (b_from_a * x)).norm() < 1e-11);
  RC_ASSERT(distance((d_from_c * c_from_b) * b_from_a, d_from_c * (c_from_b * b_from_a)) < 1e-11);
  const Rigid3 order_turned = inverse(b_from_a) * inverse(c_from_b);
  RC_ASSERT(distance(inverse(c_from_b * b_from_a), order_turned) < 1e-11);
}

RC_GTEST_PROP(RigidLaws, DistancesAndHandednessStay, ()) {
  const Rigid3 b_from_a = motion();
  const Vector3d x = vector(100.0);
  const Vector3d y = vector(100.0);
  RC_ASSERT(std::abs((b_from_a * x - b_from_a * y).norm() - (x - y).norm()) < 1e-11);
  RC_ASSERT(std::abs(b_from_a.rotation.determinant() - 1.0) < 1e-12);
}

RC_GTEST_PROP(RigidLaws, LogarithmAndMatrixGoThereAndBack, ()) {
  const Rigid3 b_from_a = motion();
  RC_ASSERT((rotation_exp(rotation_log(b_from_a.rotation)) - b_from_a.rotation).norm() < 1e-9);
  RC_ASSERT(distance(from_matrix(to_matrix(b_from_a)), b_from_a) < 1e-12);
  RC_ASSERT((nearest_rotation(b_from_a.rotation) - b_from_a.rotation).norm() < 1e-12);
}

RC_GTEST_PROP(RigidLaws, TheNearestRotationOfOneThatWasStretchedIsThatOne, ()) {
  const Matrix3d rotation = motion().rotation;
  const Vector3d a = vector(1.0);
  const Vector3d b = vector(1.0);
  const Matrix3d stretch = a * a.transpose() - b * b.transpose();
  for (const double amount : {1e-10, 1e-9, 1e-8, 1e-4, 0.1}) {
    const Matrix3d nearest = nearest_rotation(rotation * (Matrix3d::Identity() + amount * stretch));
    RC_ASSERT((nearest - rotation).norm() < 1e-14);
    RC_ASSERT((nearest.transpose() * nearest - Matrix3d::Identity()).norm() < 1e-14);
  }
  RC_ASSERT(nearest_rotation(-rotation).determinant() > 0.0);
}

RC_GTEST_PROP(RigidLaws, LocalFramesChangeNothing, ()) {
  const Rigid3 target_from_source = motion();
  const Vector3d source_origin = 1e3 * vector(1000.0);
  const Vector3d target_origin = 1e3 * vector(1000.0);
  const Rigid3 local = to_local(target_from_source, source_origin, target_origin);
  RC_ASSERT(distance(to_world(local, source_origin, target_origin), target_from_source) < 1e-8);
}

RC_GTEST_PROP(PolygonLaws, AreaDoesNotMove, ()) {
  const Ring outline = ring();
  const double before = signed_area(outline);
  RC_ASSERT(before > 0.0);
  RC_ASSERT(std::abs(signed_area(moved(plane_motion(), outline)) - before) < 1e-10);
  Ring turned = outline;
  std::reverse(turned.begin(), turned.end());
  RC_ASSERT(std::abs(signed_area(turned) + before) < 1e-12);
  std::rotate(turned.begin(), turned.begin() + 1, turned.end());
  RC_ASSERT(std::abs(signed_area(turned) + before) < 1e-12);
}

RC_GTEST_PROP(PolygonLaws, WhatLiesWithinMovesAlong, ()) {
  const Ring outline = ring();
  const Vector2d p(number(-4.0, 4.0), number(-4.0, 4.0));
  // A point on the border may fall to either side.
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vector2d& a = outline[k];
    const Vector2d along = outline[(k + 1) % outline.size()] - a;
    const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    RC_PRE((p - a - share * along).norm() > 1e-9);
  }
  const Rigid3 b_from_a = plane_motion();
  RC_ASSERT(contains(outline, p) == contains(moved(b_from_a, outline), moved(b_from_a, p)));
}

RC_GTEST_PROP(PolygonLaws, TrianglesHaveTheAreaOfTheirPolygon, ()) {
  // Merging takes out crossings, of a hole with the border, say.
  for (const Polygon& polygon : merged(polygons())) {
    double sum = 0.0;
    for (const Triangle2& t : triangulate(polygon)) sum += signed_area({t[0], t[1], t[2]});
    RC_ASSERT(std::abs(sum - area(polygon)) < 1e-9);
  }
}

RC_GTEST_PROP(ClipLaws, WhatIsCommonAndWhatIsLeftMakeTheWhole, ()) {
  const std::vector<Polygon> a = merged(polygons());
  const std::vector<Polygon> b = merged(polygons());
  const double common = area(intersection(a, b));
  RC_ASSERT(std::abs(common + area(difference(a, b)) - area(a)) < kClipTolerance_m2);
  RC_ASSERT(std::abs(area(a) + area(b) - common - area(merged(a, b))) < kClipTolerance_m2);
  RC_ASSERT(std::abs(common - intersection_area(b, a)) < kClipTolerance_m2);
}

RC_GTEST_PROP(ClipLaws, OfOneselfNothingIsLeft, ()) {
  const std::vector<Polygon> a = merged(polygons());
  RC_ASSERT(area(difference(a, a)) < kClipTolerance_m2);
  RC_ASSERT(std::abs(area(intersection(a, a)) - area(a)) < kClipTolerance_m2);
  RC_ASSERT(std::abs(area(merged(a, a)) - area(a)) < kClipTolerance_m2);
}

RC_GTEST_PROP(ClipLaws, ClippingMovesAlong, ()) {
  const std::vector<Polygon> a = merged(polygons());
  const std::vector<Polygon> b = merged(polygons());
  const Rigid3 there = plane_motion();
  const double before = intersection_area(a, b);
  RC_ASSERT(std::abs(intersection_area(moved(there, a), moved(there, b)) - before) < kClipTolerance_m2);
}

std::vector<Vector2d> some_points() {
  std::vector<Vector2d> points;
  for (int k = *rc::gen::inRange(30, 200); k > 0; --k) {
    points.emplace_back(number(0.0, 3.0, 1e-6), number(0.0, 2.0, 1e-6));
  }
  return points;
}

/// Without thinning, which has a lattice of its own.
AlphaShapeOptions exactly(double alpha_m) {
  AlphaShapeOptions options;
  options.alpha_m = alpha_m;
  options.thin = false;
  return options;
}

/// Points are rounded to 10 um, so that a moved triangle may pass where it did not before: the area lies
/// between those of discs that are one percent smaller and larger, but for slivers.
bool is_shape_of(const std::vector<Vector2d>& points, double alpha_m, double found_m2) {
  const double sliver_m2 = 5e-3;
  return found_m2 > area(alpha_shape(points, exactly(0.99 * alpha_m))) - sliver_m2 &&
         found_m2 < area(alpha_shape(points, exactly(1.01 * alpha_m))) + sliver_m2;
}

RC_GTEST_PROP(AlphaShapeLaws, TheOrderOfPointsDoesNotMatter, ()) {
  std::vector<Vector2d> points = some_points();
  const AlphaShapeOptions options = exactly(number(0.2, 1.0));
  const double before = area(alpha_shape(points, options));
  std::reverse(points.begin(), points.end());
  points.push_back(points.front());
  RC_ASSERT(std::abs(area(alpha_shape(points, options)) - before) < 1e-9);
}

RC_GTEST_PROP(AlphaShapeLaws, TheShapeMovesAlong, ()) {
  const std::vector<Vector2d> points = some_points();
  const double alpha_m = number(0.2, 1.0);
  RC_ASSERT(is_shape_of(points, alpha_m, area(alpha_shape(moved(plane_motion(), points), exactly(alpha_m)))));
}

RC_GTEST_PROP(AlphaShapeLaws, ALargerDiscLeavesMore, ()) {
  const std::vector<Vector2d> points = some_points();
  const double alpha_m = number(0.1, 1.0);
  const double less = area(alpha_shape(points, exactly(alpha_m)));
  const double more = area(alpha_shape(points, exactly(alpha_m * number(1.0, 3.0))));
  RC_ASSERT(less <= more + 1e-9);
  RC_ASSERT(more <= 3.0 * 2.0);
}

RC_GTEST_PROP(AlphaShapeLaws, GrowsWithItsUnit, ()) {
  const std::vector<Vector2d> points = some_points();
  const double alpha_m = number(0.2, 1.0);
  const double scale = number(0.5, 4.0);
  std::vector<Vector2d> scaled = points;
  for (Vector2d& p : scaled) p *= scale;
  const double found_m2 = area(alpha_shape(scaled, exactly(alpha_m * scale)));
  RC_ASSERT(is_shape_of(points, alpha_m, found_m2 / (scale * scale)));
}

}  // namespace
}  // namespace limen
