// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/people.h"

#include <array>
#include <cmath>
#include <optional>

#include "limen/simulate/buildings/furniture.h"

namespace limen {
namespace {

struct BodyPart {
  Vector3d middle;  ///< in shares of the height; x to the person's right
  Vector3d radii;
};

// Legs, trunk, head.
constexpr int kParts = 4;
const std::array<BodyPart, kParts>& parts() {
  static const std::array<BodyPart, kParts> body = {
      BodyPart{{-0.06, 0.0, 0.24}, {0.055, 0.065, 0.25}}, BodyPart{{0.06, 0.02, 0.24}, {0.055, 0.065, 0.25}},
      BodyPart{{0.0, 0.0, 0.64}, {0.15, 0.085, 0.22}}, BodyPart{{0.0, 0.01, 0.93}, {0.05, 0.06, 0.075}}};
  return body;
}

/// The range at which a unit ray meets an upright ellipsoid turned by `heading`.
std::optional<double> meets(const Vector3d& origin, const Vector3d& direction, const Person& person,
                            const BodyPart& part) {
  const double c = std::cos(person.heading_rad);
  const double s = std::sin(person.heading_rad);
  const auto turned = [&](const Vector3d& v) {
    return Vector3d(c * v.x() + s * v.y(), -s * v.x() + c * v.y(), v.z());
  };
  const Vector3d foot(person.at.x(), person.at.y(), person.floor_m);
  const Vector3d radii = person.height_m * part.radii;
  const Vector3d from = (turned(origin - foot) - person.height_m * part.middle).cwiseQuotient(radii);
  const Vector3d way = turned(direction).cwiseQuotient(radii);
  const double a = way.squaredNorm();
  const double b = from.dot(way);
  const double root = b * b - a * (from.squaredNorm() - 1.0);
  if (root <= 0.0 || -b <= 0.0) return std::nullopt;
  return (-b - std::sqrt(root)) / a;
}

}  // namespace

std::vector<Person> people_in(const Building& building, std::size_t room, const Vector3d& scanner, int count,
                              RandomStream& random) {
  const Room& r = building.plan.rooms[room];
  Vector2d low = r.outline[0];
  Vector2d high = low;
  for (const Vector2d& p : r.outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<Person> people;
  for (int attempt = 0; attempt < 60 && static_cast<int>(people.size()) < count; ++attempt) {
    Person person;
    person.at.x() = random.uniform(low.x(), high.x());
    person.at.y() = random.uniform(low.y(), high.y());
    person.floor_m = r.floor_m;
    person.height_m = random.uniform(1.55, 1.95);
    person.heading_rad = random.uniform(0.0, 6.2831853);
    if ((person.at - scanner.head<2>()).norm() < 0.8 || !is_free(building, room, person.at, 0.3)) continue;
    people.push_back(person);
  }
  return people;
}

void hide_behind(Sweep& sweep, const Vector3d& scanner, const std::vector<Person>& people, double noise_m,
                 RandomStream& random) {
  for (Echo& echo : sweep.echoes) {
    const double range = (echo.point - scanner).norm();
    const Vector3d direction = (echo.point - scanner) / range;
    double nearest = range;
    for (const Person& person : people)
      for (const BodyPart& part : parts())
        if (const auto met = meets(scanner, direction, person, part)) nearest = std::min(nearest, *met);
    if (nearest >= range) continue;
    echo.point = scanner + (nearest + noise_m * random.normal()) * direction;
    echo.surface = -1;
    echo.intensity = 0.4F;
  }
}

}  // namespace limen
