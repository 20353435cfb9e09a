// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/bim_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limen/base/error.h"

namespace limen {
namespace {

/// Streams of the seed, so that one choice does not disturb another.
enum Stream : std::uint64_t { kDoors = 5001, kPlaces, kChanges, kClutter, kFrames };

Matrix3d heading(RandomStream& random) {
  return rotation_exp({0.0, 0.0, random.uniform(0.0, 2.0 * std::numbers::pi)});
}

/// Uniform over all orientations.
Matrix3d any_orientation(RandomStream& random) {
  const Eigen::Quaterniond q(random.normal(), random.normal(), random.normal(), random.normal());
  return nearest_rotation(q.normalized().toRotationMatrix());
}

/// The nearest multiple of 2^-16 m, so that adding a whole number of metres is exact.
Vector3d rounded(const Vector3d& x) {
  return (x * 65536.0).array().round().matrix() / 65536.0;
}

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
    keep_seen_planes();
    return std::move(case_);
  }

 private:
  void build() {
    const std::vector<BimMatter> matter = matter_of(model_);
    BuiltState doors = as_planned(model_);
    RandomStream door_random(o_.seed, kDoors);
    open_doors(model_, o_.open_door_share, door_random, doors);
    const BimMesh planned = build_mesh(model_, matter, doors);
    if (planned.mesh.triangles().empty())
      throw Error("the model has no surface to be scanned", model_.name, "look at it with limen info");
    RandomStream place_random(o_.seed, kPlaces);
    stations_ = place_bim_stations(rooms_, RayCaster(planned.mesh), o_.stations, o_.room, place_random);
    BuiltState state = doors;
    if (o_.as_built.on) {
      RandomStream change_random(o_.seed, kChanges);
      state = as_built(model_, o_.as_built, doors, stations_, planned, change_random);
    }
    built_ = build_mesh(model_, matter, state);
    told_.as_built = o_.as_built.on;
    told_.file = model_.name;
    told_.changes = changes_of(model_, doors, state);
    if (!o_.as_built.on) return;
    RandomStream clutter_random(o_.seed, kClutter);
    told_.furniture = add_clutter(built_, stations_, o_.as_built.furniture_per_m2, clutter_random);
  }

  void begin_truth() {
    Truth& truth = case_.truth;
    truth.scene = model_.name;
    truth.seed = o_.seed;
    truth.local_origin = model_.local_origin;
    truth.planes = merged_.planes;
    for (const BimStation& station : stations_)
      told_.rooms.push_back(
          station.room < 0 ? ModelRoom{} : describe(model_, rooms_, static_cast<std::size_t>(station.room)));
    truth.model = told_;
  }

  void add_station(const RayCaster& caster, std::size_t number, RandomStream& random) {
    Rigid3 local_from_scan;
    local_from_scan.rotation = o_.any_rotation ? any_orientation(random) : heading(random);
    local_from_scan.translation = rounded(stations_[number].position);
    // The head stands upright whatever frame the points are given in.
    const Rigid3 head{heading(random), local_from_scan.translation};
    const Sweep result = sweep_of(caster, head, mix64(o_.seed * 1000 + number + 77));
    Scan scan;
    scan.name = (number < 9 ? "scan_0" : "scan_") + std::to_string(number + 1);
    scan.centres = {Vector3d::Zero()};
    scan.level = !o_.any_rotation;
    const Rigid3 scan_from_local = inverse(local_from_scan);
    for (const Echo& echo : result.echoes) {
      scan.points.push_back(scan_from_local * echo.point);
      scan.intensities.push_back(echo.intensity);
    }
    ScanTruth truth{.name = scan.name,
                    .room = case_.truth.model->rooms[number].space,
                    .local_from_scan = local_from_scan,
                    .plane_of_point = {},
                    .element_of_point = {}};
    record(std::move(scan), std::move(truth), result);
  }

  /// As many pulses as give about the asked number of points: a thin sweep measures the share that returns.
  [[nodiscard]] Sweep sweep_of(const RayCaster& caster, const Rigid3& head, std::uint64_t seed) const {
    const ScanPattern thin = station_pattern(head, 20000);
    const Sweep trial = sweep(caster, {}, thin, o_.scanner, seed);
    const double share = std::max(0.02, static_cast<double>(trial.echoes.size()) /
                                            static_cast<double>(thin.lines * thin.pulses_per_line));
    const auto pulses = static_cast<std::size_t>(std::lround(static_cast<double>(o_.points) / share));
    return sweep(caster, {}, station_pattern(head, pulses), o_.scanner, seed);
  }

  void record(Scan scan, ScanTruth truth, const Sweep& result) {
    std::vector<std::size_t> inliers(case_.truth.planes.size(), 0);
    for (const Echo& echo : result.echoes) {
      const bool mixed = echo.surface < 0;
      const auto surface = static_cast<std::size_t>(std::max(0, echo.surface));
      const int plane = mixed ? -1 : merged_.plane_of_surface[surface];
      truth.plane_of_point.push_back(plane);
      truth.element_of_point.push_back(mixed ? -1 : built_.element_of_surface[surface]);
      if (plane >= 0) ++inliers[static_cast<std::size_t>(plane)];
    }
    for (std::size_t i = 0; i < inliers.size(); ++i) case_.truth.planes[i].inliers.push_back(inliers[i]);
    case_.scans.push_back(std::move(scan));
    case_.truth.scans.push_back(std::move(truth));
  }

  /// Drops planes nobody saw a point of, and renumbers.
  void keep_seen_planes() {
    Truth& truth = case_.truth;
    std::vector<std::int32_t> renumbered(truth.planes.size(), -1);
    std::vector<TruePlane> seen;
    for (std::size_t i = 0; i < truth.planes.size(); ++i) {
      const auto& counts = truth.planes[i].inliers;
      if (std::none_of(counts.begin(), counts.end(), [](std::size_t n) { return n > 0; })) continue;
      renumbered[i] = static_cast<std::int32_t>(seen.size());
      seen.push_back(std::move(truth.planes[i]));
    }
    truth.planes = std::move(seen);
    for (ScanTruth& scan : truth.scans)
      for (std::int32_t& plane : scan.plane_of_point)
        if (plane >= 0) plane = renumbered[static_cast<std::size_t>(plane)];
  }

  const BimModel& model_;
  const BimSceneOptions& o_;
  Monitor& monitor_;
  std::vector<BimRoom> rooms_;
  std::vector<BimStation> stations_;
  BimMesh built_;
  MergedPlanes merged_;
  ModelTruth told_;
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
  as_built.check();
  scanner.check();
}

SimulatedCase simulate_bim(const BimModel& model, const BimSceneOptions& options, Monitor& monitor) {
  options.check();
  monitor.begin_stage("simulating");
  return BimSimulation(model, options, monitor).run();
}

}  // namespace limen
