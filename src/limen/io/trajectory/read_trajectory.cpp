// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/io/trajectory/read_trajectory.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "limen/base/angles.h"
#include "limen/base/error.h"
#include "limen/base/text.h"
#include "limen/files/mapped_file.h"
#include "limen/files/text_numbers.h"
#include "limen/io/crs/coordinate_system.h"
#include "limen/io/table/record_table.h"
#include "limen/io/trajectory/transverse_mercator.h"

namespace limen {
namespace {

constexpr std::size_t kSbetNumbers = 17;
constexpr std::size_t kSbetBytes = kSbetNumbers * sizeof(double);

/// Turns of the body: about its forward, right and down axes.
struct Attitude {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double heading_rad = 0.0;  ///< clockwise from north: true north for geographic places, else of the grid
};

/// One place as it was read.
struct Entry {
  double time_s = 0.0;
  Vector3d x = Vector3d::Zero();  ///< of the grid, where it is not geographic
  std::optional<Geodetic> geodetic;
  std::optional<Attitude> attitude;
};

/// East, north, up from forward, right, down.
Matrix3d world_from_body(const Attitude& attitude) {
  Matrix3d enu_from_ned;
  enu_from_ned << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  return enu_from_ned * rotation_exp({0.0, 0.0, attitude.heading_rad}) *
         rotation_exp({0.0, attitude.pitch_rad, 0.0}) * rotation_exp({attitude.roll_rad, 0.0, 0.0});
}

double number_at(std::string_view bytes, std::size_t record, std::size_t k) {
  double number = 0.0;
  std::memcpy(&number, bytes.data() + record * kSbetBytes + k * sizeof number, sizeof number);
  return number;
}

Entry sbet_entry(std::string_view bytes, std::size_t i, const std::string& name) {
  const auto number = [&](std::size_t k) { return number_at(bytes, i, k); };
  const bool good = std::isfinite(number(0)) && std::abs(number(1)) <= std::numbers::pi / 2 &&
                    std::abs(number(2)) <= 2 * std::numbers::pi && std::abs(number(3)) < 1e5;
  if (!good) {
    throw Error(fmt::format("record {} of the SBET is not a position: time {:g} s, latitude {:g}, longitude "
                            "{:g} rad, height {:g} m",
                            i + 1, number(0), number(1), number(2), number(3)),
                fmt::format("{}, byte {}", name, i * kSbetBytes),
                "check the file, or export it again as SBET");
  }
  Entry entry;
  entry.time_s = number(0);
  entry.geodetic = Geodetic{number(1), number(2), number(3)};
  entry.attitude = Attitude{number(7), number(8), number(9) - number(10)};
  return entry;
}

std::vector<Entry> read_sbet(std::string_view bytes, const std::string& name) {
  if (bytes.size() % kSbetBytes != 0) {
    throw Error(
        fmt::format("{} bytes are not a whole number of SBET records of {} bytes", bytes.size(), kSbetBytes),
        name, "get the whole file; a text needs an ending like .csv");
  }
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < bytes.size() / kSbetBytes; ++i) entries.push_back(sbet_entry(bytes, i, name));
  return entries;
}

/// The one name for each of the names a column may have.
std::string canonical(const std::string& name) {
  static const std::map<std::string, std::string> kNames{{"gps_time", "time"},
                                                         {"gpstime", "time"},
                                                         {"t", "time"},
                                                         {"timestamp", "time"},
                                                         {"seconds", "time"},
                                                         {"easting", "x"},
                                                         {"east", "x"},
                                                         {"e", "x"},
                                                         {"northing", "y"},
                                                         {"north", "y"},
                                                         {"n", "y"},
                                                         {"height", "z"},
                                                         {"altitude", "z"},
                                                         {"alt", "z"},
                                                         {"up", "z"},
                                                         {"h", "z"},
                                                         {"lat", "latitude"},
                                                         {"lon", "longitude"},
                                                         {"long", "longitude"},
                                                         {"lng", "longitude"},
                                                         {"yaw", "heading"},
                                                         {"azimuth", "heading"}};
  const auto found = kNames.find(name);
  return found == kNames.end() ? name : found->second;
}

std::vector<std::string> canonical_names(const std::vector<std::string_view>& words) {
  std::vector<std::string> names;
  for (std::string_view word : words) {
    word = word.substr(0, word.find_first_of("[("));
    names.push_back(canonical(lower_case(word)));
  }
  return names;
}

/// The names in a line that is no row of numbers, where the time is among them.
std::vector<std::string> names_in(std::string_view line) {
  while (!line.empty() && (line.front() == '#' || line.front() == '%' || line.front() == '/'))
    line.remove_prefix(1);
  std::vector<std::string> names = canonical_names(split_tokens(line));
  if (std::find(names.begin(), names.end(), "time") == names.end()) names.clear();
  return names;
}

bool is_row(std::string_view line) {
  const auto tokens = split_tokens(line);
  return !tokens.empty() && parse_number(tokens[0]).has_value();
}

/// A text with the names of its columns.
struct TrajectoryText {
  std::string_view rows;
  std::size_t first_line = 1;
  std::vector<std::string> names;

  [[nodiscard]] std::optional<std::size_t> column(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::nullopt
                                : std::optional<std::size_t>(static_cast<std::size_t>(found - names.begin()));
  }
  [[nodiscard]] bool has(std::initializer_list<const char*> wanted) const {
    return std::all_of(wanted.begin(), wanted.end(),
                       [&](const char* name) { return column(name).has_value(); });
  }
};

TrajectoryText text_of(std::string_view bytes, const TrajectoryOptions& options, const std::string& name) {
  TrajectoryText text{without_byte_order_mark(bytes), 1, {}};
  while (!text.rows.empty() && !is_row(first_line(text.rows).text)) {
    const TextLine line = first_line(text.rows);
    if (text.names.empty()) text.names = names_in(line.text);
    text.rows.remove_prefix(line.bytes);
    ++text.first_line;
  }
  if (!options.columns.empty()) {
    text.names.clear();
    for (const std::string& column : options.columns) text.names.push_back(canonical(lower_case(column)));
  }
  if (text.rows.empty()) throw Error("there are no rows of numbers", name, "check how it was exported");
  const bool whole = text.has({"time", "x", "y", "z"}) || text.has({"time", "latitude", "longitude", "z"});
  if (whole) return text;
  throw Error(text.names.empty() ? "the columns of the trajectory have no names"
                                 : "the columns of the trajectory lack the time or the position",
              name,
              fmt::format("name them in their order, as --{}trajectory-columns time,x,y,z or "
                          "time,latitude,longitude,height",
                          options.option_side));
}

std::vector<Entry> read_text(std::string_view bytes, const TrajectoryOptions& options,
                             const std::string& name) {
  const TrajectoryText text = text_of(bytes, options, name);
  TextRows wanted;
  wanted.columns = text.names.size();
  wanted.first_line_number = text.first_line;
  const ParsedRows parsed = parse_rows(text.rows, wanted, name);
  const bool geographic = text.has({"latitude", "longitude"});
  const bool turned = text.has({"roll", "pitch", "heading"});
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < parsed.rows; ++i) {
    const auto number = [&](const char* column) {
      return parsed.numbers[i * wanted.columns + *text.column(column)];
    };
    Entry entry;
    entry.time_s = number("time");
    if (geographic) {
      entry.geodetic = Geodetic{radians(number("latitude")), radians(number("longitude")), number("z")};
      if (!(std::abs(number("latitude")) <= 90.0 && std::abs(number("longitude")) <= 360.0))
        throw Error(fmt::format("row {} has no latitude and longitude in degrees", i + 1), name,
                    "check the columns");
    } else {
      entry.x = {number("x"), number("y"), number("z")};
    }
    if (turned)
      entry.attitude =
          Attitude{radians(number("roll")), radians(number("pitch")), radians(number("heading"))};
    entries.push_back(entry);
  }
  return entries;
}

std::string zone_option(const TrajectoryOptions& options) {
  return fmt::format("--{}utm-zone", options.option_side);
}

/// Brings geographic places, and headings from true north, into one Cartesian frame.
class Projection {
 public:
  Projection(const TrajectoryOptions& options, const Geodetic& first) : first_(first) {
    const std::string& utm_zone = options.utm_zone;
    if (utm_zone == "local") {
      local_ = true;
    } else if (utm_zone == "auto") {
      zone_ = utm_zone_of(first);
    } else if (const std::optional<UtmZone> zone = parse_utm_zone(utm_zone)) {
      zone_ = *zone;
    } else {
      map_.emplace(utm_zone, zone_option(options));
    }
  }
  [[nodiscard]] Entry operator()(Entry entry) const {
    if (local_) {
      entry.x = east_north_up(first_) * (to_geocentric(*entry.geodetic) - to_geocentric(first_));
      return entry;
    }
    if (map_) {
      const Geodetic& it = *entry.geodetic;
      entry.x = map_->to_map(it.latitude_rad, it.longitude_rad, it.height_m);
      if (entry.attitude)
        entry.attitude->heading_rad -= map_->convergence_rad(it.latitude_rad, it.longitude_rad, it.height_m);
      return entry;
    }
    const GridPlace grid = to_utm(*entry.geodetic, zone_);
    entry.x = grid.x;
    if (entry.attitude) entry.attitude->heading_rad -= grid.convergence_rad;
    return entry;
  }

 private:
  Geodetic first_;
  bool local_ = false;
  UtmZone zone_;
  std::optional<MapProjection> map_;  ///< any other system
};

bool is_binary(std::string_view bytes, const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  return ending == ".sbet" || bytes.substr(0, 4096).find('\0') != std::string_view::npos;
}

}  // namespace

void TrajectoryOptions::check() const {
  if (!(max_gap_s > 0.0)) throw_bad_option("max_gap_s", max_gap_s, "above 0");
  if (!std::isfinite(time_offset_s))
    throw_bad_option("time_offset_s", time_offset_s, "a finite number of seconds");
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(lever_arm_m[k]) < 100.0)) throw_bad_option("lever_arm_m", lever_arm_m[k], "within 100 m");
  }
  if (utm_zone == "auto" || utm_zone == "local" || parse_utm_zone(utm_zone)) return;
  if (utm_zone.find_first_of(":[{") != std::string::npos) {
    static_cast<void>(coordinate_system(utm_zone, zone_option(*this)));
    return;
  }
  throw Error(
      fmt::format("the UTM zone is \"{}\", but must be as 32N or 19S, auto, local, or a coordinate system as "
                  "EPSG:2154",
                  utm_zone),
      zone_option(*this), "name the zone or the system of the points");
}

Trajectory read_trajectory(const std::filesystem::path& path, const TrajectoryOptions& options) {
  options.check();
  const MappedFile file(path);
  const std::string name = path.string();
  std::vector<Entry> entries = with_whole_inputs([&] {
    return is_binary(file.bytes(), path) ? read_sbet(file.bytes(), name)
                                         : read_text(file.bytes(), options, name);
  });
  if (!options.lever_arm_m.isZero() && !entries.empty() && !entries.front().attitude) {
    throw Error(
        "the trajectory has no attitude, so a lever arm cannot be turned", name,
        fmt::format("give roll, pitch and heading too, or leave --{}lever-arm out", options.option_side));
  }
  if (!entries.empty() && entries.front().geodetic) {
    const Projection projection(options, *entries.front().geodetic);
    for (Entry& entry : entries) entry = projection(entry);
  }
  std::vector<double> times_s;
  std::vector<Vector3d> positions;
  for (const Entry& entry : entries) {
    times_s.push_back(entry.time_s + options.time_offset_s);
    positions.push_back(entry.x);
    if (entry.attitude) positions.back() += world_from_body(*entry.attitude) * options.lever_arm_m;
  }
  return Trajectory(times_s, positions, name, options.max_gap_s, options.option_side);
}

}  // namespace limen
