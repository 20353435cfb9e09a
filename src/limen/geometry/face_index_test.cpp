// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/geometry/face_index.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limen/base/random.h"
#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

/// Triangles, rectangles and rectangles with a hole, anywhere, of any direction.
std::vector<FlatFace> random_faces(int count, RandomStream& random) {
  std::vector<FlatFace> faces;
  const auto vector = [&random](double most) {
    const double x = random.uniform(-most, most);
    const double y = random.uniform(-most, most);
    return Vector3d(x, y, random.uniform(-most, most));
  };
  for (int i = 0; i < count; ++i) {
    FlatFace face;
    const Vector3d middle = vector(3.0);
    face.plane.normal = i % 3 == 0 ? Vector3d::Unit(i / 3 % 3) : Vector3d(vector(1.0).normalized());
    face.plane.offset = face.plane.normal.dot(middle);
    face.frame = make_frame(face.plane, middle);
    if (face.frame.u.cross(face.frame.v).dot(face.plane.normal) < 0.0) face.frame.u = -face.frame.u;
    const double w = random.uniform(0.1, 2.0);
    const double h = random.uniform(0.1, 2.0);
    if (i % 2 == 0) {
      face.outline.outer = {{0, 0}, {w, 0}, {w, h}, {0, h}};
      if (i % 4 == 0) {
        face.outline.holes = {
            {{0.2 * w, 0.2 * h}, {0.2 * w, 0.7 * h}, {0.7 * w, 0.7 * h}, {0.7 * w, 0.2 * h}}};
      }
    } else {
      face.outline.outer = {{0, 0}, {w, 0.1 * h}, {0.3 * w, h}};
    }
    faces.push_back(face);
  }
  return faces;
}

double ring_distance(const Ring& ring, const Vector2d& p) {
  double best = 1e300;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d edge = ring[(i + 1) % ring.size()] - a;
    const double along = std::clamp(edge.dot(p - a) / edge.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p - a - along * edge).norm());
  }
  return best;
}

double distance_to(const FlatFace& face, const Vector3d& x) {
  const Vector2d p = face.frame.to_plane(x);
  double off = ring_distance(face.outline.outer, p);
  for (const Ring& hole : face.outline.holes) off = std::min(off, ring_distance(hole, p));
  if (contains(face.outline, p)) off = 0.0;
  return std::hypot(off, face.plane.signed_distance(x));
}

TEST(FaceIndex, FindsTheNearestFaceAsLookingAtAllDoes) {
  RandomStream random(3);
  const std::vector<FlatFace> faces = random_faces(120, random);
  const double reach = 0.4;
  const FaceIndex index(faces, reach);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    FaceQuery query;
    query.x = {random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
    const Vector3d normal = normal_vector(random).normalized();
    const Vector3d eye(0.1, 0.2, 0.3);
    if (i % 2 == 0) query.normal = &normal;
    query.min_cosine = 0.7;
    query.oriented = i % 4 == 0;
    if (i % 3 == 0) query.seen_from = &eye;
    double best = reach;
    for (const FlatFace& face : faces) {
      const double cosine = face.plane.normal.dot(normal);
      if (query.normal != nullptr && (query.oriented ? cosine : std::abs(cosine)) < 0.7) continue;
      if (query.seen_from != nullptr && face.plane.signed_distance(eye) <= 0.0) continue;
      best = std::min(best, distance_to(face, query.x));
    }
    const FaceHit hit = index.nearest(query);
    EXPECT_EQ(hit.face >= 0, best < reach);
    if (hit.face < 0) continue;
    EXPECT_NEAR(hit.distance_m, best, 1e-9);
    EXPECT_NEAR(hit.signed_m, index.face(hit.face).plane.signed_distance(query.x), 1e-12);
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST(FaceIndex, FindsEveryFaceThatALineCrosses) {
  RandomStream random(4);
  const std::vector<FlatFace> faces = random_faces(150, random);
  const FaceIndex index(faces, 0.1);
  int crossed = 0;
  for (int i = 0; i < 2000; ++i) {
    const double most = i % 2 == 0 ? 3.0 : 30.0;
    Vector3d from = uniform_vector(Vector3d(-most, -most, -most), Vector3d(most, most, most), random);
    const Vector3d to = uniform_vector(Vector3d(-3, -3, -3), Vector3d(3, 3, 3), random);
    if (i % 10 == 0) from.head<2>() = to.head<2>();
    std::vector<int> expected;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const double a = faces[k].plane.signed_distance(from);
      const double b = faces[k].plane.signed_distance(to);
      if ((a > 0.0) == (b > 0.0)) continue;
      const Vector3d at = from + a / (a - b) * (to - from);
      if (contains(faces[k].outline, faces[k].frame.to_plane(at))) expected.push_back(static_cast<int>(k));
    }
    std::vector<int> found;
    for (const FaceCrossing& crossing : index.crossings(from, to)) {
      found.push_back(crossing.face);
      EXPECT_LT(std::abs(faces[static_cast<std::size_t>(crossing.face)].plane.signed_distance(crossing.at)),
                1e-9);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    crossed += static_cast<int>(found.size());
  }
  EXPECT_GT(crossed, 500);
}

TEST(FaceIndex, AnotherPlaneThanTheNearest) {
  std::vector<FlatFace> faces;
  for (const double height : {0.0, 0.003, 0.03, -0.02}) {
    FlatFace face;
    face.plane.offset = height;
    face.frame = make_frame(face.plane, Vector3d(0, 0, height));
    face.outline.outer = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    faces.push_back(face);
  }
  faces[3].plane = faces[3].plane.flipped();
  const FaceIndex index(faces, 0.1);
  FaceQuery query;
  query.x = {0.2, 0.1, 0.001};
  EXPECT_EQ(index.nearest(query).face, 0);
  query.but_not = &faces[0].plane;
  EXPECT_EQ(index.nearest(query).face, 3);  // the other way round, and so another one
  const Vector3d up = Vector3d::UnitZ();
  query.normal = &up;
  query.oriented = true;
  query.min_cosine = 0.9;
  EXPECT_EQ(index.nearest(query).face, 2);
}

TEST(FaceIndex, WithoutFacesNothingIsFound) {
  const FaceIndex index({}, 0.1);
  EXPECT_EQ(index.nearest({}).face, -1);
  EXPECT_TRUE(index.crossings(Vector3d::Zero(), Vector3d::Ones()).empty());
}

}  // namespace
}  // namespace limen
