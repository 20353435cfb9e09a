// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/write_clouds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/guarded_mapping.h"
#include "limen/base/length_unit.h"
#include "limen/base/text.h"
#include "limen/io/cloud/read_cloud.h"
#include "limen/io/e57/e57.h"
#include "limen/io/e57/e57_copy.h"
#include "limen/io/las/las.h"
#include "limen/io/ply/ply.h"
#include "limen/io/table/packed_rows.h"
#include "limen/io/text/text.h"

namespace limen {
namespace {

std::string ending_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

bool is_las_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".las" || ending == ".laz";
}

bool is_text(const std::string& ending) {
  return ending == ".xyz" || ending == ".txt" || ending == ".asc" || ending == ".csv";
}

}  // namespace

std::unique_ptr<CloudWriter> make_cloud_writer(const std::filesystem::path& path, const CloudPlan& plan) {
  const std::string ending = ending_of(path);
  if (is_las_ending(path)) return make_las_writer(path, plan);
  if (ending == ".e57") return make_e57_writer(path, plan);
  if (is_text(ending)) return make_text_writer(path, plan);
  // What has no ending is no ordinary file: a pipe.
  if (ending == ".ply" || ending.empty()) return make_ply_writer(path, plan);
  throw Error(fmt::format("limen cannot write files with the ending \"{}\"", ending), path.string(),
              "name the output .ply, .las, .laz, .e57, .xyz or .csv");
}

bool is_cloud_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return is_las_ending(path) || ending == ".e57" || ending == ".ply" || is_text(ending) || ending.empty();
}

bool has_cloud_ending(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  return ending == ".pcd" || ending == ".ptx" || ending == ".pts" ||
         (!ending.empty() && is_cloud_ending(path));
}

namespace {

/// Files up to this size are looked into for the place of the scanner.
constexpr std::uint64_t kFewPoints = 20000000;

bool has_origins(const CloudFacts& facts) {
  return std::any_of(facts.fields.begin(), facts.fields.end(),
                     [](const std::string& field) { return lower_case(field) == "x_origin"; });
}

/// The rows whose coordinates are finite, of tables whose first three columns are x, y and z.
class FiniteRows {
 public:
  /// The table itself where all of it is finite.
  RecordTable of(const RecordTable& table) {
    std::vector<char> good(table.rows, 1);
    std::vector<double> numbers(table.rows);
    for (std::size_t k = 0; k < 3; ++k) {
      load_numbers(table, table.fields[k], {0, table.rows}, numbers.data());
      for (std::size_t i = 0; i < table.rows; ++i)
        good[i] = good[i] != 0 && std::isfinite(numbers[i]) ? 1 : 0;
    }
    const auto bad = static_cast<std::uint64_t>(std::count(good.begin(), good.end(), 0));
    if (bad == 0) return table;
    left_out_ += bad;
    PackedRows rows;
    rows.require_columns(table);
    for (std::size_t i = 0; i < table.rows; ++i) {
      if (good[i] != 0) rows.append(table, i);
    }
    packed_ = std::move(rows);
    return packed_.view();
  }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  PackedRows packed_;
  std::uint64_t left_out_ = 0;
};

}  // namespace

PlacedCloud placed_cloud(const OpenPoints& input, std::size_t cloud, const Rigid3& target_from_world,
                         const std::optional<Vector3d>& origin, Monitor& monitor) {
  const CloudFacts& facts = input.file().clouds()[cloud];
  PlacedCloud placed{&input, cloud, target_from_world, origin, std::min<std::size_t>(cloud, 255)};
  const bool stated = facts.table.centre || facts.points <= kFewPoints;
  if (!origin && stated && facts.points > 0 && !has_origins(facts))
    placed.centre = settled_centre(input, cloud, monitor);
  return placed;
}

std::vector<PlacedCloud> placed_clouds(const OpenPoints& input, const Rigid3& target_from_world,
                                       const std::optional<Vector3d>& origin, Monitor& monitor) {
  std::vector<PlacedCloud> placed;
  for (std::size_t k = 0; k < input.file().clouds().size(); ++k)
    placed.push_back(placed_cloud(input, k, target_from_world, origin, monitor));
  return placed;
}

double require_one_unit(const std::vector<PlacedCloud>& clouds, const std::filesystem::path& output) {
  const auto unit_of = [](const PlacedCloud& placed) {
    return placed.input->file().clouds()[placed.cloud].table.metres_per_unit.value_or(1.0);
  };
  const double unit = unit_of(clouds.front());
  for (const PlacedCloud& placed : clouds) {
    if (unit_of(placed) == unit) continue;
    throw Error(fmt::format("has its numbers in {}, and {} in {}: one file has one unit",
                            unit_name(unit_of(placed)), clouds.front().input->name(), unit_name(unit)),
                placed.input->name(), "convert all to one unit first");
  }
  const std::string ending = ending_of(output);
  if (unit != 1.0 && !is_las_ending(output))
    throw Error(fmt::format("has its numbers in {}, which a {} file cannot state", unit_name(unit),
                            ending.empty() ? "PLY" : ending),
                clouds.front().input->name(), "write .las or .laz, or convert it to metres first");
  return unit;
}

WrittenClouds write_clouds(const JoinedClouds& clouds, const std::filesystem::path& output,
                           Monitor& monitor) {
  const auto total = static_cast<double>(clouds.plan().most_points);
  // Only LAS has numbers of one kind, which must be known before the first row.
  const bool states_kind = is_las_ending(output);
  const std::unique_ptr<CloudWriter> writer =
      make_cloud_writer(output, states_kind ? clouds.plan_with_largest() : clouds.plan());
  const std::unique_ptr<PointStream> stream = clouds.read();
  monitor.set_unit(WorkUnit::points);
  WrittenClouds result;
  result.notes = clouds.notes();
  FiniteRows finite;
  while (const std::optional<RecordTable> piece = stream->next(kPointsAtOnce)) {
    writer->write(finite.of(*piece));
    result.read += piece->rows;
    monitor.throw_if_cancelled();
    monitor.advance(static_cast<double>(result.read), total);
  }
  writer->finish();
  result.written = result.read - finite.left_out();
  if (finite.left_out() > 0)
    result.notes.push_back(
        fmt::format("{} points without finite coordinates are left out", finite.left_out()));
  return result;
}

bool is_copied(const OpenPoints& input, const std::filesystem::path& output) {
  return input.format() == PointFormat::e57 && lower_case(output.extension().string()) == ".e57";
}

namespace {

std::uint64_t points_of(const std::vector<PlacedCloud>& stations) {
  std::uint64_t total = 0;
  for (const PlacedCloud& station : stations) total += station.input->file().clouds()[station.cloud].points;
  return total;
}

}  // namespace

WrittenClouds write_stations(const std::vector<PlacedCloud>& stations, const std::filesystem::path& output,
                             Monitor& monitor, const std::string& system) {
  const auto total = static_cast<double>(points_of(stations));
  E57StationsWriter writer(output);
  monitor.set_unit(WorkUnit::points);
  WrittenClouds result;
  const auto advance = [&](std::uint64_t points) {
    result.read += points;
    monitor.throw_if_cancelled();
    monitor.advance(static_cast<double>(result.read), total);
  };
  const OpenPoints* opened = nullptr;
  std::optional<E57Original> original;
  for (const PlacedCloud& station : stations) {
    const OpenPoints& input = *station.input;
    if (is_copied(input, output) && !station.bend) {
      if (opened != &input) original.emplace(input.bytes(), input.name(), [&input] { input.forget(); });
      opened = &input;
      input.prove(station.cloud);
      writer.copy(*original, input.number_in_file(station.cloud), station.target_from_world, system, monitor);
      advance(input.file().clouds()[station.cloud].points);
      continue;
    }
    const JoinedClouds cloud({station}, false, system);
    writer.begin_station(cloud.plan());
    const std::unique_ptr<PointStream> stream = cloud.read();
    while (const std::optional<RecordTable> piece = stream->next(kPointsAtOnce)) {
      writer.write(*piece);
      advance(piece->rows);
    }
  }
  writer.finish();
  result.written = result.read;
  return result;
}

namespace {

/// The clouds' points, thinned; `read` counts those of all, of `total`.
ThinnedCloud thinned(const JoinedClouds& clouds, const ThinOptions& thinning, std::uint64_t& read,
                     std::uint64_t total, Monitor& monitor) {
  CloudThinner thinner(thinning, clouds.plan().most_points);
  const std::unique_ptr<PointStream> stream = clouds.read();
  while (const std::optional<RecordTable> piece = stream->next(kStreamRows)) {
    thinner.add(*piece);
    read += piece->rows;
    monitor.throw_if_cancelled();
    monitor.advance(static_cast<double>(read), static_cast<double>(total));
  }
  return thinner.finish();
}

std::vector<std::string> notes_of_thinning(std::vector<std::string> notes, std::uint64_t unusable) {
  if (unusable > 0)
    notes.push_back(fmt::format("{} points without finite coordinates are left out", unusable));
  return notes;
}

WrittenClouds write_thinned(const JoinedClouds& clouds, const ThinOptions& thinning,
                            const std::filesystem::path& output, Monitor& monitor) {
  monitor.set_unit(WorkUnit::points);
  std::uint64_t read = 0;
  CloudPlan plan = clouds.plan();
  const ThinnedCloud kept = thinned(clouds, thinning, read, plan.most_points, monitor);
  plan.most_points = kept.table.rows;
  const std::unique_ptr<CloudWriter> writer = make_cloud_writer(output, plan);
  writer->write(kept.table);
  writer->finish();
  return {kept.read, kept.table.rows, kept.spacing_m, notes_of_thinning(clouds.notes(), kept.unusable)};
}

WrittenClouds write_thinned_stations(const std::vector<PlacedCloud>& stations, const ThinOptions& thinning,
                                     const std::filesystem::path& output, Monitor& monitor) {
  const std::uint64_t total = points_of(stations);
  E57StationsWriter writer(output);
  monitor.set_unit(WorkUnit::points);
  WrittenClouds result;
  std::uint64_t unusable = 0;
  for (const PlacedCloud& station : stations) {
    if (points_of({station}) == 0) continue;
    const JoinedClouds cloud({station}, false);
    ThinOptions share = thinning;
    if (thinning.most_points > 0) {
      const double part = static_cast<double>(cloud.plan().most_points) / static_cast<double>(total);
      share.most_points = std::max<std::uint64_t>(
          1, static_cast<std::uint64_t>(part * static_cast<double>(thinning.most_points)));
    }
    CloudPlan plan = cloud.plan();
    const ThinnedCloud kept = thinned(cloud, share, result.read, total, monitor);
    plan.most_points = kept.table.rows;
    if (kept.table.rows > 0) {
      writer.begin_station(plan);
      writer.write(kept.table);
    }
    result.written += kept.table.rows;
    result.spacing_m = std::max(result.spacing_m, kept.spacing_m);
    unusable += kept.unusable;
    for (const std::string& note : cloud.notes()) {
      if (std::find(result.notes.begin(), result.notes.end(), note) == result.notes.end())
        result.notes.push_back(note);
    }
  }
  if (result.written == 0)
    throw Error("no points are left to write", stations.front().input->name(),
                "check how the file was exported");
  writer.finish();
  result.notes = notes_of_thinning(std::move(result.notes), unusable);
  return result;
}

}  // namespace

WrittenClouds thin_file(const OpenPoints& input, ThinOptions thinning, const std::filesystem::path& output,
                        Monitor& monitor) {
  thinning.check();
  const std::vector<PlacedCloud> placed = placed_clouds(input, {});
  const double unit = require_one_unit(placed, output);
  thinning.spacing_m /= unit;
  const JoinedClouds clouds(placed, placed.size() > 1);
  const bool few = thinning.spacing_m == 0.0 && thinning.most_points > 0 &&
                   clouds.plan().most_points <= thinning.most_points;
  WrittenClouds written = with_whole_inputs([&] {
    if (placed.size() > 1 && ending_of(output) == ".e57")
      return few ? write_stations(placed, output, monitor)
                 : write_thinned_stations(placed, thinning, output, monitor);
    return few ? write_clouds(clouds, output, monitor) : write_thinned(clouds, thinning, output, monitor);
  });
  written.spacing_m *= unit;
  return written;
}

}  // namespace limen
