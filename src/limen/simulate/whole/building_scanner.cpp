// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/building_scanner.h"

#include <numbers>
#include <utility>

#include "limen/simulate/scanner/drift.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/people.h"

namespace limen {
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
  // The instrument's own frame, about its optical centre; the file's may lie elsewhere.
  Rigid3 local_from_head;
  local_from_head.rotation = station_rotation(style.any_rotation, random);
  const Matrix3d tilt = tilted(style.tilt_rad, random);
  if (!style.any_rotation && style.tilt_rad > 0.0) local_from_head.rotation = local_from_head.rotation * tilt;
  local_from_head.translation = rounded(local_from_scene_ * place.position);
  const Rigid3 scene_from_head = inverse(local_from_scene_) * local_from_head;
  // Of a file in any rotation the instrument stood upright (or tilted) all the same.
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
  Scan& scan = made.scan;
  scan.name = name;
  scan.local_origin = local_origin_;
  scan.level = true;
  for (const Echo& echo : result.echoes) {
    const Pulse pulse = pattern.pulse(echo.line, echo.index);
    const Vector3d error = drift.at(pulse.time_s);
    scan.points.push_back(local_from_scene_ * echo.point + error);
    scan.centres.push_back(local_from_scene_ * pulse.origin + error);
    scan.times_s.push_back(pulse.time_s);
    scan.topology.line.push_back(static_cast<std::int32_t>(echo.line));
    scan.topology.index.push_back(static_cast<std::int32_t>(echo.index));
    scan.intensities.push_back(echo.intensity);
  }
  return counted(std::move(made), result);
}

ScannedBuilding BuildingScanner::counted(ScannedBuilding made, const Sweep& result) {
  made.truth.points = made.scan.size();
  made.truth.surface_m2 = counter_.add(result);
  return made;
}

}  // namespace limen
