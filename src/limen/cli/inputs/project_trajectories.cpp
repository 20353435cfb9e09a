// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/project_trajectories.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "limen/base/text.h"
#include "limen/io/cloud/corrected_trajectory.h"
#include "limen/io/crs/proj_library.h"
#include "limen/io/trajectory/read_trajectory.h"
#include "limen/io/trajectory/transverse_mercator.h"
#include "limen/io/trajectory/write_sbet.h"

namespace limen {
namespace {

constexpr double kAroundPassS = 1.0;  // of a trajectory that goes on before and after a pass

std::filesystem::path beside(const std::filesystem::path& cloud, const char* ending) {
  return cloud.parent_path() / (cloud.stem().string() + "_trajectory" + ending);
}

/// Which of the files the pass was measured along: the one that knows most of its knots' times.
std::optional<std::size_t> file_of(const ProjectEntry& pass, const Trajectories& all) {
  std::optional<std::size_t> best;
  std::size_t most = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto known = static_cast<std::size_t>(
        std::count_if(pass.knot_times_s.begin(), pass.knot_times_s.end(),
                      [&](double time_s) { return all[k]->position(time_s).has_value(); }));
    if (known <= most || 2 * known < pass.knot_times_s.size()) continue;
    best = k;
    most = known;
  }
  return best;
}

bool is_of_pass(const ProjectEntry& pass, double time_s) {
  return time_s >= pass.knot_times_s.front() - kAroundPassS &&
         time_s <= pass.knot_times_s.back() + kAroundPassS;
}

std::vector<TimedPlace> places_along(const ProjectEntry& pass, const Trajectory& trajectory) {
  std::vector<TimedPlace> places;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const double time_s = trajectory.time_s(i);
    if (is_of_pass(pass, time_s))
      places.push_back({time_s, pass.bend->moved(*pass.frame_from_scan * trajectory.place(i), time_s)});
  }
  return places;
}

/// "32N" as PROJ calls it.
std::string system_of_zone(const std::string& zone) {
  const std::optional<UtmZone> utm = parse_utm_zone(zone);
  return utm ? fmt::format("EPSG:{}", (utm->south ? 32700 : 32600) + utm->number) : zone;
}

bool is_sbet(const std::string& file) {
  const std::string ending = lower_case(std::filesystem::path(file).extension().string());
  return ending == ".sbet" || ending == ".out";
}

/// The records of the trajectory's own file, moved; nothing where it is no SBET, or its places are of no
/// system.
std::optional<std::vector<SbetRecord>> own_records(const ProjectEntry& pass, const StatedTrajectories& stated,
                                                   const std::string& file, const MapProjection& target) {
  if (!is_sbet(file) || stated.reading.utm_zone == "local" || !stated.reading.lever_arm_m.isZero()) return {};
  std::vector<SbetRecord> records = read_sbet_records(file);
  for (SbetRecord& record : records) record[0] += stated.reading.time_offset_s;
  std::erase_if(records, [&](const SbetRecord& record) { return !is_of_pass(pass, record[0]); });
  if (records.empty()) return {};
  std::string zone = stated.reading.utm_zone;
  if (zone == "auto") {
    const SbetRecord first = read_sbet_records(file).front();
    const UtmZone utm = utm_zone_of({first[1], first[2], first[3]});
    zone = fmt::format("{}{}", utm.number, utm.south ? "S" : "N");
  }
  const MapProjection source(system_of_zone(zone), file);
  return moved_records(records, source, target, {*pass.frame_from_scan, pass.bend.get()});
}

}  // namespace

void add_trajectories_option(CommandLine& command, TrajectoryChoice& choice) {
  command
      .add_option("--trajectory FILE", choice.files,
                  "Trajectory of a mobile scanner: SBET, or text with times and positions; may be given "
                  "several times: each scan with times uses the one that covers it")
      ->type_size(1)
      ->take_all();
  command.add_option("--trajectory-columns NAMES", choice.reading.columns,
                     "Columns of the text files, as time,x,y,z (default: as named in their header lines)");
  command.add_option("--utm-zone ZONE", choice.reading.utm_zone,
                     "Zone for latitudes and longitudes, as 32N, or a system as EPSG:2154; auto (default): "
                     "that of --crs, else the zone of the first; local: east, north, up");
  command.add_option("--trajectory-time-offset-s S", choice.reading.time_offset_s,
                     "Seconds that are added to the times of the trajectories");
  command.add_option(
      "--lever-arm x,y,z", choice.reading.lever_arm,
      "Lever arm from the reference point of the trajectories to the scanner: forward, right, down, metres");
}

StatedTrajectories stated_trajectories(const TrajectoryChoice& choice, const CoordinateSystem& system) {
  if (choice.files.empty()) require_trajectory(choice.reading);
  StatedTrajectories stated{choice.files, trajectory_options(choice.reading)};
  if (stated.reading.utm_zone == "auto" && system.known())
    stated.reading.utm_zone = system.code.empty() ? system.stated : system.code;
  return stated;
}

std::vector<std::string> write_pass_trajectory(const ProjectEntry& pass, const StatedTrajectories& stated,
                                               const CoordinateSystem& system,
                                               const std::filesystem::path& output, Monitor& monitor) {
  const Trajectories all = read_trajectories(stated);
  const std::optional<std::size_t> file = file_of(pass, all);
  const std::vector<TimedPlace> places =
      file
          ? places_along(pass, *all[*file])
          : corrected_places(
                {pass.file, static_cast<std::size_t>(pass.index), *pass.frame_from_scan, pass.bend}, monitor);
  if (places.size() < 2) return {"its scanner positions are unknown: no corrected trajectory is written"};
  write_file(beside(output, ".csv"), text_of_places(places));
  if (!system.known()) return {};
  if (proj_library() == nullptr)
    return {"without PROJ (Debian: libproj25) its corrected trajectory is not written as SBET"};
  const MapProjection target(system.wkt.empty() ? system.stated : system.wkt, pass.file);
  std::optional<std::vector<SbetRecord>> records;
  if (file) records = own_records(pass, stated, stated.files[*file], target);
  std::vector<std::string> notes;
  if (!records) {
    records = records_of_places(places, target);
    notes.emplace_back(
        "its attitude is unknown: the SBET gets the heading of the path, and roll and pitch 0");
  }
  write_file(beside(output, ".sbet"), sbet_bytes(*records));
  return notes;
}

}  // namespace limen
