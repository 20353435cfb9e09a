// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/furnishing/shapes.h"

#include <cmath>
#include <numbers>

#include "limen/geometry/random_vectors.h"

namespace limen {
namespace {

constexpr int kSides = 10;

Vector3d unit_at(double turn, double rise) {
  const double a = 2.0 * std::numbers::pi * turn;
  const double b = std::numbers::pi * (rise - 0.5);
  return {std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b)};
}

}  // namespace

ShapeBuilder::ShapeBuilder(Mesh& mesh, const Vector3d& origin, const Vector2d& along, double reflectivity)
    : mesh_(mesh),
      origin_(origin),
      x_(along.x(), along.y(), 0.0),
      y_(-along.y(), along.x(), 0.0),
      yaw_(std::atan2(along.y(), along.x())),
      like_(surface_of(Element::furniture)) {
  like_.reflectivity = reflectivity;
}

Vector3d ShapeBuilder::at(const Vector3d& p) const {
  return origin_ + p.x() * x_ + p.y() * y_ + Vector3d(0.0, 0.0, p.z());
}

Surface ShapeBuilder::round() const {
  Surface surface = like_;
  surface.planar = false;
  return surface;
}

void ShapeBuilder::box(const Vector3d& bottom_middle, const Vector3d& size, double yaw_rad) {
  mesh_.add_box({at(bottom_middle), yaw_ + yaw_rad}, size, like_);
}

void ShapeBuilder::cylinder(const Vector3d& bottom_middle, double radius, double height, double top) {
  const int side = mesh_.add_surface(round());
  std::vector<Vector3d> lid;
  for (int i = 0; i < kSides; ++i) {
    const auto ring = [&](int k, double r, double z) {
      const double a = 2.0 * std::numbers::pi * k / kSides;
      return at(bottom_middle + Vector3d(r * std::cos(a), r * std::sin(a), z));
    };
    const Vector3d a = ring(i, radius, 0.0);
    const Vector3d b = ring(i + 1, radius, 0.0);
    const Vector3d c = ring(i + 1, top * radius, height);
    const Vector3d d = ring(i, top * radius, height);
    mesh_.add_triangle(a, b, c, side);
    mesh_.add_triangle(a, c, d, side);
    lid.push_back(d);
  }
  if (radius * top > 0.03) mesh_.add_polygon(lid, like_);
}

void ShapeBuilder::ellipsoid(const Vector3d& middle, const Vector3d& radii) {
  constexpr int kRings = 6;
  const int id = mesh_.add_surface(round());
  const auto point = [&](int i, int j) {
    return at(middle +
              unit_at(static_cast<double>(i) / kSides, static_cast<double>(j) / kRings).cwiseProduct(radii));
  };
  for (int i = 0; i < kSides; ++i) {
    for (int j = 0; j < kRings; ++j) {
      if (j > 0) mesh_.add_triangle(point(i, j), point(i + 1, j), point(i + 1, j + 1), id);
      if (j + 1 < kRings) mesh_.add_triangle(point(i, j), point(i + 1, j + 1), point(i, j + 1), id);
    }
  }
}

void ShapeBuilder::leaves(const Vector3d& middle, const Vector3d& radii, int count, RandomStream& random) {
  const int id = mesh_.add_surface(round());
  for (int i = 0; i < count; ++i) {
    const Vector3d p = at(middle + vector_in_ball(random).cwiseProduct(radii));
    const double size = random.uniform(0.04, 0.13);
    const Vector3d tip = p + size * vector_in_ball(random);
    mesh_.add_triangle(p, p + size * vector_in_ball(random), tip, id);
  }
}

void ShapeBuilder::leaning_board(const Vector3d& bottom_middle, double width, double height,
                                 double lean_rad) {
  const double back = height * std::sin(lean_rad);
  const double up = height * std::cos(lean_rad);
  const Vector3d half(0.5 * width, 0.0, 0.0);
  const Vector3d rise(0.0, -back, up);
  mesh_.add_sheet({at(bottom_middle - half), at(bottom_middle + half), at(bottom_middle + half + rise),
                   at(bottom_middle - half + rise)},
                  like_);
}

}  // namespace limen
