// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/model/bim_scene.h"

#include <algorithm>
#include <utility>

#include "limen/base/error.h"
#include "limen/simulate/scanner/station_scan.h"

namespace limen {
namespace {

/// Streams of the seed, so that one choice does not disturb another.
enum Stream : std::uint64_t { kDoors = 5001, kPlaces, kChanges, kClutter, kFrames, kTargets };

/// Scans a model and writes down what is true.
class BimSimulation {
 public:
  BimSimulation(const BimModel& model, const BimSceneOptions& options, Monitor& monitor)
      : model_(model), o_(options), monitor_(monitor), rooms_(rooms_of(model)) {}

  SimulatedCase run() {
    build();
    monitor_.throw_if_cancelled();
    const RayCaster caster(built_.mesh);
    merged_ = merge_planes(built_.mesh);
    begin_truth();
    RandomStream random(o_.seed, kFrames);
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      monitor_.throw_if_cancelled();
      monitor_.advance(static_cast<double>(i), static_cast<double>(stations_.size()));
      add_station(caster, i, random);
    }
    case_.truth = of_seen_planes(std::move(case_.truth));
    return std::move(case_);
  }

 private:
  void build() {
    const std::vector<BimPart> parts = parts_of(model_);
    BuiltState doors = as_planned(model_);
    RandomStream door_random(o_.seed, kDoors);
    open_doors(model_, o_.open_door_share, door_random, doors);
    BimMesh planned = build_mesh(model_, parts, doors);
    if (planned.mesh.triangles().empty())
      throw Error("the model has no surface to be scanned", model_.name, "check it with limen info");
    RandomStream place_random(o_.seed, kPlaces);
    stations_ =
        place_bim_stations(model_, rooms_, RayCaster(planned.mesh), o_.stations, o_.room, place_random);
    stated_.as_built = o_.as_built.on;
    stated_.file = model_.name;
    if (!o_.as_built.on) {
      stated_.changes = changes_of(model_, doors, doors);
      built_ = std::move(planned);
    } else {
      build_otherwise(parts, doors, planned);
    }
    RandomStream target_random(o_.seed, kTargets);
    stated_.targets = put_up_spheres(built_, stations_, o_.targets, target_random);
  }

  void build_otherwise(const std::vector<BimPart>& parts, const BuiltState& doors, const BimMesh& planned) {
    RandomStream change_random(o_.seed, kChanges);
    const BuiltState state = as_built(model_, o_.as_built, doors, stations_, planned, change_random);
    stated_.changes = changes_of(model_, doors, state);
    built_ = build_mesh(model_, parts, state);
    RandomStream clutter_random(o_.seed, kClutter);
    stated_.furniture = add_clutter(built_, stations_, o_.as_built, clutter_random);
  }

  void begin_truth() {
    Truth& truth = case_.truth;
    truth.scene = model_.name;
    truth.seed = o_.seed;
    truth.local_origin = model_.local_origin;
    truth.planes = merged_.planes;
    for (const BimStation& station : stations_)
      stated_.rooms.push_back(
          station.room < 0 ? ModelRoom{} : describe(model_, rooms_, static_cast<std::size_t>(station.room)));
    truth.model = stated_;
  }

  void add_station(const RayCaster& caster, std::size_t number, RandomStream& random) {
    Rigid3 local_from_scan;
    local_from_scan.rotation = station_rotation(o_.any_rotation, random);
    local_from_scan.translation = rounded(stations_[number].position);
    // The head stands upright whatever frame the points are given in.
    const Rigid3 head{any_heading(random), local_from_scan.translation};
    const Sweep result = sweep_of(caster, head, mix64(o_.seed * 1000 + number + 77));
    Scan scan = station_scan((number < 9 ? "scan_0" : "scan_") + std::to_string(number + 1), result,
                             inverse(local_from_scan));
    scan.level = !o_.any_rotation;
    ScanTruth truth{.name = scan.name,
                    .room = case_.truth.model->rooms[number].space,
                    .local_from_scan = local_from_scan,
                    .plane_of_point = {},
                    .element_of_point = {}};
    record(std::move(scan), std::move(truth), result);
  }

  [[nodiscard]] Sweep sweep_of(const RayCaster& caster, const Rigid3& head, std::uint64_t seed) const {
    return sweep_of_points(
        o_.points, [&](std::size_t pulses) { return station_pattern(head, pulses); },
        [&](const ScanPattern& fired) { return sweep(caster, {}, fired, o_.scanner, seed); });
  }

  void record(Scan scan, ScanTruth truth, const Sweep& result) {
    for (const Echo& echo : result.echoes) {
      const bool mixed = echo.surface < 0;
      const auto surface = static_cast<std::size_t>(std::max(0, echo.surface));
      truth.plane_of_point.push_back(mixed ? -1 : merged_.plane_of_surface[surface]);
      truth.element_of_point.push_back(mixed ? -1 : built_.element_of_surface[surface]);
    }
    case_.scans.push_back(std::move(scan));
    case_.truth.scans.push_back(std::move(truth));
  }

  const BimModel& model_;
  const BimSceneOptions& o_;
  Monitor& monitor_;
  std::vector<BimRoom> rooms_;
  std::vector<BimStation> stations_;
  BimMesh built_;
  MergedPlanes merged_;
  ModelTruth stated_;
  SimulatedCase case_;
};

}  // namespace

void BimSceneOptions::check() const {
  constexpr std::size_t kMost = 100000000;
  if (points < 1 || points > kMost)
    throw_bad_option("points", static_cast<double>(points), "between 1 and 1e8");
  if (stations < 1 || stations > 20)
    throw_bad_option("stations", static_cast<double>(stations), "between 1 and 20");
  if (!(open_door_share >= 0.0 && open_door_share <= 1.0))
    throw_bad_option("open_door_share", open_door_share, "between 0 and 1");
  if (targets > 50) throw_bad_option("targets", static_cast<double>(targets), "at most 50");
  scanner.check();
}

SimulatedCase simulate_bim(const BimModel& model, const BimSceneOptions& options, Monitor& monitor) {
  options.check();
  monitor.begin_stage("simulating");
  return BimSimulation(model, options, monitor).run();
}

}  // namespace limen
