// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/transform_cloud.h"

#include <deque>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"
#include "limen/base/text.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/e57/e57_poses.h"
#include "limen/io/las/las.h"
#include "limen/io/las/laz/copc_writer.h"
#include "limen/io/pcd/pcd.h"
#include "limen/io/ply/ply.h"
#include "limen/io/ptx/ptx.h"
#include "limen/io/table/record_table.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

/// Whether a file of this name is of the format: its own endings, and for PLY also none.
bool has_ending_of(PointFormat format, const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  switch (format) {
    case PointFormat::ply:
      return ending == ".ply" || ending.empty();
    case PointFormat::pcd:
      return ending == ".pcd";
    case PointFormat::ptx:
      return ending == ".ptx";
    case PointFormat::e57:
      return ending == ".e57";
    case PointFormat::las:
      // A COPC has its points in another order, and is written anew.
      return ending == ".las" || (ending == ".laz" && !is_copc_ending(path));
    case PointFormat::text:
      return ending == ".pts" || ending == ".xyz" || ending == ".txt" || ending == ".csv" || ending == ".asc";
  }
  return false;
}

/// Moves the file as it is.
TransformedCloud move_in_format(const OpenPoints& input, const Rigid3& pose,
                                const std::filesystem::path& output, const ReadOptions& options,
                                Monitor& monitor, const CoordinateSystem& system) {
  const NamedBytes bytes{input.bytes(), input.name()};
  switch (input.format()) {
    case PointFormat::ply:
      return transform_ply(bytes, pose, output, options);
    case PointFormat::pcd:
      return transform_pcd(bytes, pose, output);
    case PointFormat::ptx:
      for (std::size_t k = 0; k < input.file().clouds().size(); ++k) input.prove(k);
      return transform_ptx(bytes, pose, output);
    case PointFormat::text:
      return transform_text(bytes, pose, output);
    case PointFormat::las:
      return transform_las(input.bytes(), input.name(), pose, output, monitor, {system.wkt, system.code});
    case PointFormat::e57:
      break;
  }
  for (std::size_t k = 0; k < input.file().clouds().size(); ++k) input.prove(k);
  const MovedE57 moved = replace_e57_poses(input.bytes(), input.name(), pose, output, monitor, system.wkt);
  return {moved.points, input.file().format(), moved.notes};
}

/// Formats without a place for a coordinate system are moved all the same, and a note tells it.
TransformedCloud move_and_tell(const OpenPoints& input, const Rigid3& pose,
                               const std::filesystem::path& output, const ReadOptions& options,
                               Monitor& monitor, const CoordinateSystem& system) {
  TransformedCloud cloud = move_in_format(input, pose, output, options, monitor, system);
  const bool stated = input.format() == PointFormat::las || input.format() == PointFormat::e57;
  if (system.known() && !stated)
    cloud.notes.push_back(fmt::format("{} cannot store a coordinate system: it is not written to the file",
                                      input.file().format()));
  return cloud;
}

void require_known_ending(const std::filesystem::path& output, const OpenPoints& input) {
  if (is_cloud_ending(output)) return;
  const std::string ending = lower_case(output.extension().string());
  const bool own = has_ending_of(input.format(), output);
  throw Error(fmt::format("{}{} cannot be written as \"{}\"", own ? "a part of a " : "",
                          input.file().format(), ending),
              output.string(),
              fmt::format("name the output .ply, .las, .laz, .e57, .xyz or .csv, or {}",
                          own ? "move the whole file alone" : "give it the ending of the input"));
}

/// All clouds of a file; those that are copied need no scanner position, and empty ones are only copied.
std::vector<PlacedCloud> placed_for(const std::filesystem::path& output, const OpenPoints& input,
                                    const Rigid3& pose, const std::optional<Vector3d>& origin,
                                    Monitor& monitor) {
  std::vector<PlacedCloud> placed;
  if (is_copied(input, output)) {
    for (std::size_t k = 0; k < input.file().clouds().size(); ++k) placed.push_back({&input, k, pose});
    return placed;
  }
  for (const std::size_t k : scans_with_points(input.file()))
    placed.push_back(placed_cloud(input, k, pose, origin, monitor));
  return placed;
}

void note_lost_images(const std::vector<PlacedCloud>& clouds, const std::filesystem::path& output,
                      std::vector<std::string>& notes) {
  std::set<const OpenPoints*> seen;
  for (const PlacedCloud& cloud : clouds) {
    const OpenPoints& input = *cloud.input;
    const bool kept = is_copied(input, output) && !cloud.bend;
    if (kept || input.format() != PointFormat::e57 || !seen.insert(&input).second) continue;
    const std::size_t images = E57Original(input.bytes(), input.name()).document().images.size();
    if (images > 0)
      notes.push_back(
          fmt::format("{}: its {} images are left out, which only E57 keeps", input.name(), images));
  }
}

/// One .e57 keeps each cloud as a scan of its own, and E57 ones as they are; all others join them.
/// `tell_source`: as in JoinedClouds.
TransformedCloud write_placed(const std::vector<PlacedCloud>& clouds, bool tell_source,
                              const std::filesystem::path& output, Monitor& monitor,
                              const CoordinateSystem& system) {
  if (clouds.empty()) throw Error("there are no points", output.string(), "give scans with points");
  const PlacedCloud& first = clouds.front();
  require_known_ending(output, *first.input);
  require_one_unit(clouds, output);
  const bool stations = lower_case(output.extension().string()) == ".e57" &&
                        (clouds.size() > 1 || (is_copied(*first.input, output) && !first.bend));
  if (!stations && tell_source && clouds.back().source > 255)
    throw Error("more than 256 clouds cannot be merged into this format", output.string(),
                "write an .e57, which keeps each as a scan of its own, or a file for each");
  WrittenClouds written = stations
                              ? write_stations(clouds, output, monitor, system.wkt)
                              : write_clouds(JoinedClouds(clouds, tell_source, system.wkt), output, monitor);
  note_lost_images(clouds, output, written.notes);
  return {written.written, first.input->file().format(), written.notes};
}

}  // namespace

Scan transformed(const Scan& scan, const Rigid3& target_from_source) {
  Scan moved = scan;
  if (scan.points.empty()) return moved;
  moved.local_origin = round_origin_near(target_from_source * (scan.local_origin + scan.points.front()));
  const Rigid3 local = to_local(target_from_source, scan.local_origin, moved.local_origin);
  for (Vector3d& point : moved.points) point = local * point;
  for (Vector3d& centre : moved.centres) centre = local * centre;
  return moved;
}

TransformedCloud transform_cloud(const std::filesystem::path& input, const Rigid3& target_from_source,
                                 const std::filesystem::path& output, const ReadOptions& options,
                                 Monitor& monitor, const CoordinateSystem& system) {
  monitor.begin_stage("transform");
  const OpenPoints open(input);
  return with_whole_inputs([&] {
    // One of several scans is written anew: the file holds the others too.
    if (!open.chosen() && has_ending_of(open.format(), output))
      return move_and_tell(open, target_from_source, output, options, monitor, system);
    return write_placed(placed_for(output, open, target_from_source, options.origin, monitor), false, output,
                        monitor, system);
  });
}

TransformedCloud merge_clouds(const CloudToMove& moved, const std::vector<std::string>& others,
                              const std::filesystem::path& output, Monitor& monitor,
                              const CoordinateSystem& system) {
  if (others.empty())
    return transform_cloud(moved.path, moved.target_from_source, output, {}, monitor, system);
  monitor.begin_stage("merging");
  std::deque<OpenPoints> files;
  std::vector<PlacedCloud> clouds;
  for (std::size_t k = 0; k <= others.size(); ++k) {
    const OpenPoints& file = k == 0 ? files.emplace_back(moved.path) : files.emplace_back(others[k - 1]);
    for (PlacedCloud placed :
         placed_for(output, file, k == 0 ? moved.target_from_source : Rigid3{}, {}, monitor)) {
      placed.source = k;
      clouds.push_back(placed);
    }
  }
  return with_whole_inputs([&] { return write_placed(clouds, true, output, monitor, system); });
}

TransformedCloud move_stations(const std::vector<StationToMove>& stations,
                               const std::filesystem::path& output, Monitor& monitor,
                               const CoordinateSystem& system) {
  if (stations.empty()) throw Error("there is no scan to move", output.string(), "give at least one");
  monitor.begin_stage("merging");
  std::deque<OpenPoints> files;
  std::vector<PlacedCloud> clouds;
  for (const StationToMove& station : stations) {
    if (files.empty() || files.back().path() != station.path) files.emplace_back(station.path);
    const OpenPoints& file = files.back();
    const std::vector<std::size_t> scans = scans_with_points(file.file());
    if (station.cloud >= scans.size())
      throw Error(fmt::format("has no scan {}", station.cloud), station.path.string(),
                  "give the file that the project was made from");
    const std::size_t cloud = scans[station.cloud];
    clouds.push_back(is_copied(file, output) && !station.bend
                         ? PlacedCloud{&file, cloud, station.target_from_source}
                         : placed_cloud(file, cloud, station.target_from_source, {}, monitor));
    clouds.back().source = clouds.size() - 1;
    clouds.back().bend = station.bend;
  }
  return with_whole_inputs(
      [&] { return write_placed(clouds, stations.size() > 1, output, monitor, system); });
}

}  // namespace limen
