// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/whole/project_scene.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/building_scanner.h"
#include "limen/simulate/whole/site_targets.h"
#include "limen/simulate/whole/whole_building.h"

namespace limen {
namespace {

WholeBuildingOptions building_options(const ProjectSceneOptions& options) {
  WholeBuildingOptions building;
  building.name = options.name;
  building.seed = options.seed;
  building.stations = options.stations;
  building.passes = options.passes;
  building.places = options.places;
  building.open_door_share = options.open_door_share;
  building.as_built = options.as_built;
  if (options.styles) building.furnishing = random_furnishing_style(options.seed);
  return building;
}

/// Scans a building, station by station and pass by pass.
class ProjectSimulation {
 public:
  ProjectSimulation(const ProjectSceneOptions& options, const std::function<void(const Scan&)>& keep,
                    Monitor& monitor)
      : o_(options),
        keep_(keep),
        monitor_(monitor),
        building_(make_whole_building(building_options(options))),
        targets_(put_up_targets(building_, options.targets, options.seed)),
        scanner_(building_, heading_of(options.seed), kLocalOrigin) {
    for (SiteTarget target : targets_) {
      target.centre = heading_of(options.seed) * target.centre;
      truth_.targets.push_back(std::move(target));
    }
    truth_.building = options.name;
    truth_.seed = options.seed;
    truth_.as_built = options.as_built;
    truth_.local_origin = kLocalOrigin;
    truth_.rooms = building_.rooms;
  }

  ProjectTruth run() {
    const auto total = static_cast<double>(building_.wishes.size() + o_.tripods + building_.passes.size());
    double done = 0.0;
    for (const StationWish& wish : building_.wishes) {
      monitor_.throw_if_cancelled();
      record(survey(building_, scanner_.caster(), wish, o_.seed));
      monitor_.advance(++done, total);
    }
    for (std::size_t i = 0; i < o_.tripods; ++i) {
      monitor_.throw_if_cancelled();
      record(survey_street(building_, scanner_.caster(), i, o_.tripods, o_.seed));
      monitor_.advance(++done, total);
    }
    for (std::size_t i = 0; i < building_.passes.size(); ++i) {
      monitor_.throw_if_cancelled();
      record(scanner_.pass(fmt::format("pass_{}", i + 1), building_.passes[i], points_of_pass(i),
                           {o_.drift_m, o_.drift}, o_.scanner, scan_seed()));
      monitor_.advance(++done, total);
    }
    truth_.shared = scanner_.shared();
    return std::move(truth_);
  }

 private:
  inline static const Vector3d kLocalOrigin{1050000.0, 6840000.0, 150.0};

  static Rigid3 heading_of(std::uint64_t seed) {
    RandomStream random(seed, 2000);
    return {any_heading(random), Vector3d::Zero()};
  }

  [[nodiscard]] std::uint64_t scan_seed() const { return mix64(o_.seed * 100003 + truth_.scans.size()); }

  [[nodiscard]] ScanStyle style() const {
    ScanStyle plain;
    plain.points = o_.points_station;
    plain.scanner = o_.scanner;
    plain.any_rotation = o_.any_rotation;
    return o_.styles ? random_scan_style(plain, scan_seed()) : plain;
  }

  [[nodiscard]] std::size_t points_of_pass(std::size_t pass) const {
    if (o_.points_pass > 0) return o_.points_pass;
    return std::min<std::size_t>(1200000, static_cast<std::size_t>(6000.0 * building_.passes[pass].length()));
  }

  void record(const std::optional<StationPlace>& place) {
    if (place)
      record(scanner_.station(fmt::format("station_{:03}", truth_.scans.size() + 1), *place, style(),
                              scan_seed()));
  }

  void record(const ScannedBuilding& made) {
    truth_.scans.push_back(made.truth);
    keep_(made.scan);
  }

  const ProjectSceneOptions& o_;
  const std::function<void(const Scan&)>& keep_;
  Monitor& monitor_;
  WholeBuilding building_;
  std::vector<SiteTarget> targets_;  ///< in the building's frame; before it is scanned
  BuildingScanner scanner_;
  ProjectTruth truth_;
};

}  // namespace

void ProjectSceneOptions::check() const {
  if (stations > 2000) throw_bad_option("stations", static_cast<double>(stations), "at most 2000");
  if (targets > 50) throw_bad_option("targets", static_cast<double>(targets), "at most 50");
  if (tripods > 500) throw_bad_option("tripods", static_cast<double>(tripods), "at most 500");
  if (passes > 12) throw_bad_option("passes", passes, "at most 12");
  constexpr std::size_t kMost = 100000000;
  if (points_station < 1000 || points_station > kMost)
    throw_bad_option("points_station", static_cast<double>(points_station), "between 1e3 and 1e8");
  if (points_pass > kMost) throw_bad_option("points_pass", static_cast<double>(points_pass), "at most 1e8");
  if (!(drift_m >= 0.0 && drift_m <= 1.0)) throw_bad_option("drift_m", drift_m, "between 0 and 1");
  if (!(open_door_share >= 0.0 && open_door_share <= 1.0))
    throw_bad_option("open_door_share", open_door_share, "between 0 and 1");
  scanner.check();
}

ProjectTruth simulate_project(const ProjectSceneOptions& options,
                              const std::function<void(const Scan&)>& keep, Monitor& monitor) {
  options.check();
  monitor.begin_stage("simulating");
  return ProjectSimulation(options, keep, monitor).run();
}

}  // namespace limen
