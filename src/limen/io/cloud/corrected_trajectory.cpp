// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/cloud/corrected_trajectory.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>

#include "limen/base/guarded_mapping.h"
#include "limen/io/cloud/join_clouds.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/write_clouds.h"
#include "limen/io/table/record_table.h"

namespace limen {
namespace {

constexpr double kPlaceEveryS = 0.005;
constexpr std::size_t kRowsPerLook = 65536;

/// A place of the scanner for each short time, the first by time.
class PlacesByTime {
 public:
  /// False: the table does not tell them.
  bool add(const RecordTable& table) {
    const Field* time = find_times(table);
    const Field* x = table.find({"x_origin"});
    const Field* y = table.find({"y_origin"});
    const Field* z = table.find({"z_origin"});
    if (time == nullptr || x == nullptr || y == nullptr || z == nullptr) return false;
    std::vector<double> numbers(4 * table.rows);
    const Field* fields[4] = {time, x, y, z};
    for (std::size_t k = 0; k < 4; ++k)
      load_numbers(table, *fields[k], {0, table.rows}, numbers.data() + k, 4);
    for (std::size_t i = 0; i < table.rows; ++i) {
      const double* row = numbers.data() + 4 * i;
      if (!std::all_of(row, row + 4, [](double number) { return std::isfinite(number); })) continue;
      const auto [at, fresh] = places_.try_emplace(std::floor(row[0] / kPlaceEveryS), TimedPlace{});
      if (!fresh && at->second.time_s <= row[0]) continue;
      at->second = {row[0], {row[1], row[2], row[3]}};
    }
    return true;
  }

  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] std::vector<TimedPlace> list() const {
    std::vector<TimedPlace> list;
    for (const auto& [moment, place] : places_) list.push_back(place);
    return list;
  }

 private:
  std::map<double, TimedPlace> places_;
};

}  // namespace

std::vector<TimedPlace> corrected_places(const StationToMove& pass, Monitor& monitor) {
  const OpenPoints file(pass.path);
  PlacesByTime places;
  return with_whole_inputs([&]() -> std::vector<TimedPlace> {
    std::size_t with_points = 0;
    for (PlacedCloud cloud : placed_clouds(file, pass.target_from_source, {}, monitor)) {
      if (file.file().clouds()[cloud.cloud].points == 0 || with_points++ != pass.cloud) continue;
      cloud.bend = pass.bend;
      const JoinedClouds moved({cloud}, false);
      const std::unique_ptr<PointStream> stream = moved.read();
      while (const std::optional<RecordTable> piece = stream->next(kRowsPerLook)) {
        monitor.throw_if_cancelled();
        if (!places.add(*piece)) return {};
      }
    }
    return places.list();
  });
}

std::string text_of_places(const std::vector<TimedPlace>& places) {
  std::string text = "time,x,y,z\n";
  for (const TimedPlace& place : places)
    text += fmt::format("{:.6f},{:.5f},{:.5f},{:.5f}\n", place.time_s, place.x.x(), place.x.y(), place.x.z());
  return text;
}

}  // namespace limen
