// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/building_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "limen/base/angles.h"
#include "limen/base/random.h"
#include "limen/geometry/polygon_clip.h"
#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/station_scan.h"

namespace limen {

ScanStyle random_scan_style(const ScanStyle& plain, std::uint64_t seed) {
  RandomStream random(seed, 30);
  ScanStyle style = plain;
  style.points = static_cast<std::size_t>(static_cast<double>(plain.points) * random.uniform(0.5, 1.5));
  style.scanner.noise_m = random.uniform(0.001, 0.008);
  style.scanner.mixed_pixel_share = random.uniform(0.05, 0.45);
  style.scanner.loss_share = random.uniform(0.0, 0.03);
  style.scanner.glass_return_share = random.uniform(0.0, 0.15);
  style.scanner.glass_loss_share = random.uniform(0.0, 0.5);
  style.scanner.glass_mirror_share = random.uniform() < 0.4 ? random.uniform(0.05, 0.3) : 0.0;
  style.view.low_deg = random.uniform(-65.0, -40.0);
  style.view.high_deg = random.uniform() < 0.3 ? random.uniform(45.0, 75.0) : 90.0;
  if (random.uniform() < 0.12) style.view.span_deg = random.uniform(190.0, 270.0);
  if (random.uniform() < 0.3) style.tilt_rad = radians(std::min(3.0, std::abs(random.normal())));
  if (random.uniform() < 0.3) {
    style.file_origin = {random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0), random.uniform(-2.0, 2.0)};
    style.origin_stated = random.uniform() < 0.4;
  }
  if (random.uniform() < 0.3) style.people = 1 + static_cast<int>(random.below(3));
  return style;
}

FurnishingStyle random_furnishing_style(std::uint64_t seed) {
  RandomStream random(seed, 31);
  FurnishingStyle style;
  style.least_hidden = random.uniform(0.0, 0.3);
  style.most_hidden = random.uniform(style.least_hidden, 0.7);
  style.small_per_m2 = random.uniform(0.0, 0.25);
  style.shift_m = random.uniform(0.01, 0.05);
  style.turn_rad = random.uniform(0.005, 0.05);
  return style;
}

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
  const auto [low, high] = box_of(r.outline);
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

namespace {

constexpr int kDriftSamples = 400;

Matrix3d tilted(double tilt_rad, RandomStream& random) {
  const double way = random.uniform(0.0, 2.0 * std::numbers::pi);
  return rotation_exp(tilt_rad * Vector3d(std::cos(way), std::sin(way), 0.0));
}

}  // namespace

BuildingScanner::BuildingScanner(const WholeBuilding& building, const Rigid3& local_from_scene,
                                 const Vector3d& local_origin)
    : building_(building),
      caster_(building.world.mesh),
      merged_(merge_planes(building.world.mesh, merge_distance(building.world))),
      counter_(merged_),
      local_from_scene_(local_from_scene),
      local_origin_(local_origin) {}

ScannedBuilding BuildingScanner::station(const std::string& name, const StationPlace& place,
                                         const ScanStyle& style, std::uint64_t seed) {
  RandomStream random(seed, 1);
  // The instrument's own frame, about its scanner position; the file's may lie elsewhere.
  Rigid3 local_from_head;
  local_from_head.rotation = station_rotation(style.any_rotation, random);
  const Matrix3d tilt = tilted(style.tilt_rad, random);
  if (!style.any_rotation && style.tilt_rad > 0.0) local_from_head.rotation = local_from_head.rotation * tilt;
  local_from_head.translation = rounded(local_from_scene_ * place.position);
  const Rigid3 scene_from_head = inverse(local_from_scene_) * local_from_head;
  // Even if the file's axes have any rotation, the instrument stood upright, or was slightly tilted.
  const Matrix3d stand = style.any_rotation ? tilt : scene_from_head.rotation;
  const Rigid3 pulses_from{stand * any_heading(random), scene_from_head.translation};
  Sweep result = sweep_of_points(
      style.points, [&](std::size_t pulses) { return station_pattern(pulses_from, pulses, style.view); },
      [&](const ScanPattern& fired) {
        return sweep(caster_, building_.world.openings, fired, style.scanner, seed);
      });
  if (style.people > 0 && place.room != kStreet) {
    const auto people =
        people_in(building_.world.buildings[0], place.room, place.position, style.people, random);
    hide_behind(result, scene_from_head.translation, people, style.scanner.noise_m, random);
  }
  ScannedBuilding made;
  made.scan = station_scan(name, result, inverse(scene_from_head));
  for (Vector3d& point : made.scan.points) point += style.file_origin;
  made.scan.centres = {style.file_origin};
  if (!style.origin_stated) made.scan.centres.clear();
  made.scan.level = !style.any_rotation && style.tilt_rad == 0.0;
  made.truth.name = name;
  made.truth.room = place.room == kStreet ? -1 : static_cast<int>(place.room);
  made.truth.scanner = style.file_origin;
  made.truth.local_from_scan = local_from_head * Rigid3{Matrix3d::Identity(), -style.file_origin};
  return counted(std::move(made), result);
}

ScannedBuilding BuildingScanner::pass(const std::string& name, const VehiclePath& path, std::size_t points,
                                      const PassDrift& wanted, const ScannerOptions& scanner,
                                      std::uint64_t seed) {
  RandomStream random(seed, 1);
  ScanPattern pattern;
  const auto make = [&](std::size_t pulses) {
    pattern = profiler_pattern(path, building_.head_turns_rad, pulses);
    return pattern;
  };
  const Sweep result = sweep_of_points(points, make, [&](const ScanPattern& fired) {
    return sweep(caster_, building_.world.openings, fired, scanner, seed);
  });
  const double begin_s = pattern.pulse(0, 0).time_s;
  const double end_s = pattern.pulse(pattern.lines - 1, 0).time_s;
  const Drift drift(wanted.sigma_m, begin_s, end_s, random, wanted.kind);
  ScannedBuilding made;
  made.truth.name = name;
  made.truth.mobile = true;
  made.truth.drift_m = wanted.sigma_m;
  for (int k = 0; k <= kDriftSamples; ++k) {
    const double time_s = begin_s + (end_s - begin_s) * k / kDriftSamples;
    made.truth.drift.push_back({time_s, drift.at(time_s)});
  }
  made.scan = pass_scan(name, result, pattern, drift, local_from_scene_);
  made.scan.local_origin = local_origin_;
  return counted(std::move(made), result);
}

ScannedBuilding BuildingScanner::counted(ScannedBuilding made, const Sweep& result) {
  made.truth.points = made.scan.size();
  made.truth.surface_m2 = counter_.add(result);
  return made;
}

}  // namespace limen
