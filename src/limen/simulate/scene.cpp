// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/scene.h"

#include <algorithm>
#include <functional>

#include "limen/base/error.h"
#include "limen/simulate/recipes.h"
#include "limen/simulate/scanner/drift.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/stations.h"

namespace limen {
namespace {

/// Scans a recipe and writes down what is true.
class Simulation {
 public:
  Simulation(const SceneOptions& options, Monitor& monitor)
      : o_(options),
        monitor_(monitor),
        recipe_(make_recipe(options)),
        caster_(recipe_.world.mesh),
        merged_(merge_planes(recipe_.world.mesh, merge_distance(recipe_.world))),
        counter_(merged_),
        random_(options.seed, 1000) {
    world_from_scene_.rotation = any_heading(random_);
    if (recipe_.national_grid) origin_ = Vector3d(1050000.0, 6840000.0, 150.0);
  }

  SimulatedCase run() {
    begin_truth();
    const std::vector<Station> stations = place_stations(recipe_, caster_, random_);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      monitor_.throw_if_cancelled();
      add_station(stations[i], i);
    }
    monitor_.throw_if_cancelled();
    if (o_.outdoor == Outdoor::tripod) {
      add_station(place_in_street(recipe_, caster_, stations.front(), random_), stations.size());
    } else if (recipe_.path) {
      add_mobile();
    }
    if (counts_shared()) case_.truth.shared = counter_.shared();
    case_.truth = of_seen_planes(std::move(case_.truth));
    return std::move(case_);
  }

 private:
  /// Of cases as drawn the truth is what it always was.
  [[nodiscard]] bool counts_shared() const { return o_.as_built || o_.outdoor == Outdoor::tripod; }

  void begin_truth() {
    Truth& truth = case_.truth;
    truth.scene = o_.name;
    truth.seed = o_.seed;
    truth.local_origin = origin_;
    truth.local_from_scene = world_from_scene_;
    truth.as_built = o_.as_built;
    truth.planes = merged_.planes;
    for (TruePlane& plane : truth.planes) {
      plane.plane = transformed(world_from_scene_, plane.plane);
      plane.bulge = transformed(world_from_scene_, plane.bulge);
    }
    truth.openings = recipe_.world.openings;
    for (TrueOpening& opening : truth.openings) {
      for (Vector3d& corner : opening.outer) corner = world_from_scene_ * corner;
      for (Vector3d& corner : opening.inner) corner = world_from_scene_ * corner;
      for (Vector3d& corner : opening.outer_outline) corner = world_from_scene_ * corner;
      for (Vector3d& corner : opening.inner_outline) corner = world_from_scene_ * corner;
      opening.normal = world_from_scene_.rotation * opening.normal;
    }
  }

  void add_station(const Station& station, std::size_t number) {
    Rigid3 local_from_scan;
    local_from_scan.rotation = station_rotation(o_.any_rotation, random_);
    local_from_scan.translation = rounded(world_from_scene_ * station.position);
    const Rigid3 scene_from_scan = inverse(world_from_scene_) * local_from_scan;
    // The head stands upright whatever frame the points are given in.
    const Rigid3 head{any_heading(random_), scene_from_scan.translation};
    const bool street = station.room == kStreet;
    const std::size_t wanted = street ? o_.points_outdoor : o_.points_indoor;
    const std::size_t points = wanted > 0 ? wanted : recipe_.points_indoor;
    const std::uint64_t seed = mix64(o_.seed * 1000 + number);
    const auto pattern = [&](std::size_t pulses) { return station_pattern(head, pulses); };
    const Sweep result = sweep_of(pattern, points, seed);
    const std::string name =
        street ? "outdoor" : (number < 10 ? "indoor_0" : "indoor_") + std::to_string(number);
    Scan scan = station_scan(name, result, inverse(scene_from_scan));
    scan.level = !o_.any_rotation;
    ScanTruth truth{.name = scan.name,
                    .room = street ? -1 : static_cast<int>(station.room),
                    .local_from_scan = local_from_scan,
                    .plane_of_point = {}};
    record(std::move(scan), std::move(truth), result);
  }

  void add_mobile() {
    const std::size_t points = o_.points_outdoor > 0 ? o_.points_outdoor : recipe_.points_outdoor;
    ScanPattern pattern;
    const auto make = [&](std::size_t pulses) {
      pattern = profiler_pattern(*recipe_.path, recipe_.head_turns_rad, pulses);
      return pattern;
    };
    const Sweep result = sweep_of(make, points, mix64(o_.seed * 1000 + 900));
    const Drift drift(o_.drift_m, pattern.pulse(0, 0).time_s, pattern.pulse(pattern.lines - 1, 0).time_s,
                      random_);
    Scan scan = pass_scan("outdoor", result, pattern, drift, world_from_scene_);
    scan.local_origin = origin_;
    ScanTruth truth{.name = scan.name,
                    .mobile = true,
                    .drift_m = o_.drift_m,
                    .local_from_scan = {},
                    .plane_of_point = {}};
    record(std::move(scan), std::move(truth), result);
  }

  [[nodiscard]] Sweep sweep_of(const std::function<ScanPattern(std::size_t)>& pattern, std::size_t points,
                               std::uint64_t seed) const {
    return sweep_of_points(points, pattern, [&](const ScanPattern& fired) {
      return sweep(caster_, recipe_.world.openings, fired, o_.scanner, seed);
    });
  }

  void record(Scan scan, ScanTruth truth, const Sweep& result) {
    for (const Echo& echo : result.echoes)
      truth.plane_of_point.push_back(
          echo.surface < 0 ? -1 : merged_.plane_of_surface[static_cast<std::size_t>(echo.surface)]);
    for (std::size_t i = 0; i < result.sights.size(); ++i)
      case_.truth.openings[i].sights.push_back(result.sights[i]);
    if (counts_shared()) counter_.add(result);
    case_.scans.push_back(std::move(scan));
    case_.truth.scans.push_back(std::move(truth));
  }

  const SceneOptions& o_;
  Monitor& monitor_;
  Recipe recipe_;
  RayCaster caster_;
  MergedPlanes merged_;
  SharedSurfaceCounter counter_;
  RandomStream random_;
  Rigid3 world_from_scene_;
  Vector3d origin_ = Vector3d::Zero();
  SimulatedCase case_;
};

}  // namespace

void SceneOptions::check() const {
  const auto names = scene_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) make_recipe(*this);
  constexpr std::size_t kMost = 100000000;
  if (points_indoor > kMost)
    throw_bad_option("points_indoor", static_cast<double>(points_indoor), "at most 1e8");
  if (points_outdoor > kMost)
    throw_bad_option("points_outdoor", static_cast<double>(points_outdoor), "at most 1e8");
  if (stations > 99) throw_bad_option("stations", static_cast<double>(stations), "at most 99");
  if (facades > 2) throw_bad_option("facades", static_cast<double>(facades), "at most 2");
  if (!(curtain_share <= 1.0)) throw_bad_option("curtain_share", curtain_share, "at most 1");
  if (!(drift_m >= 0.0 && drift_m <= 1.0)) throw_bad_option("drift_m", drift_m, "between 0 and 1");
  scanner.check();
}

SimulatedCase simulate(const SceneOptions& options, Monitor& monitor) {
  options.check();
  monitor.begin_stage("simulating");
  return Simulation(options, monitor).run();
}

}  // namespace limen
