// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/scan_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/base/text.h"
#include "limen/bim/read_bim.h"
#include "limen/files/mapped_file.h"
#include "limen/files/scan_in_file.h"
#include "limen/io/cloud/open_points.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/io/ply/ply_header.h"
#include "limen/model/plausible_size.h"

namespace limen {
namespace {

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20U && c != '\t') || c == '\x7f';
}

}  // namespace

std::vector<std::string> names_in_list(const std::string& path) {
  constexpr const char* kListRemedy = "give a text file with the name of a scan on each line";
  require_readable(path, kListRemedy, "list");
  std::ifstream stream(path);
  std::vector<std::string> names;
  bool first = true;
  for (std::string line; std::getline(stream, line); first = false) {
    const std::string_view text = trimmed(first ? without_byte_order_mark(line) : line);
    if (!is_utf8(text) || std::any_of(text.begin(), text.end(), is_control))
      throw Error("is not a list of names: it contains bytes that are not text", path, kListRemedy);
    if (text.empty() || text.front() == '#') continue;
    const std::filesystem::path name(text);
    names.push_back((name.is_absolute() ? name : std::filesystem::path(path).parent_path() / name).string());
  }
  return names;
}

Vector3d parse_point(const std::string& text, const std::string& option) {
  Vector3d point;
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (Eigen::Index i = 0; i < 3 && good; ++i) {
    if (at != end && *at == '+') ++at;
    const auto [rest, error] = std::from_chars(at, end, point[i]);
    const bool last = i == 2;
    good =
        error == std::errc() && std::isfinite(point[i]) && (last ? rest == end : rest != end && *rest == ',');
    at = last ? rest : rest + 1;
  }
  if (!good) {
    throw Error(fmt::format("{} is \"{}\", but must be three numbers", option, text), "",
                "write x,y,z in metres without spaces, as 1.5,-2,0");
  }
  return point;
}

void add_gravity_option(CommandLine& command, std::string& gravity, bool with_auto) {
  const std::vector<std::string> known = with_auto ? std::vector<std::string>{"auto", "up", "unknown"}
                                                   : std::vector<std::string>{"up", "unknown"};
  std::string description = "up: the z axis of the files points up; unknown: it may point anywhere";
  if (with_auto) description += "; auto: up if floors and walls confirm it";
  command.add_option("--gravity", gravity, fmt::format("{} (default {})", description, gravity))
      ->one_of(known);
}

void add_repeats_option(CommandLine& command, std::string& repeats) {
  command
      .add_option("--repeats", repeats,
                  "none: you know that no room, flat or storey of the building looks like another. A "
                  "look-alike place is then taken to be twenty times less probable (default unknown)")
      ->one_of({"unknown", "none"});
}

std::uint64_t parse_memory(const std::string& text) {
  if (text.empty()) return 0;
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  std::string unit(rest, end);
  if (!unit.empty() && (unit.back() == 'B' || unit.back() == 'b')) unit.pop_back();
  double factor = unit.empty() ? 1.0 : 0.0;
  if (unit == "K" || unit == "k") factor = 1e3;
  if (unit == "M" || unit == "m") factor = 1e6;
  if (unit == "G" || unit == "g") factor = 1e9;
  const double bytes = number * factor;
  if (error == std::errc() && bytes >= 1e6 && bytes < 1e15) return static_cast<std::uint64_t>(bytes);
  throw Error(fmt::format("--memory is \"{}\", but must be a size of 1M or more", text), "",
              "write it as 500M, 1G or 2.5G");
}

void add_memory_option(CommandLine& command, std::string& memory) {
  command.add_option("--memory SIZE", memory,
                     "Memory for one scan, as 500M or 2.5G: a larger scan is thinned while it is read");
}

void add_alternative_option(CommandLine& command, int& alternative) {
  command
      .add_option("--alternative N", alternative,
                  "Use this alternative of the result, numbered from 1, instead of its best pose")
      ->in_range(1, 1000000);
}

void add_trajectory_options(CommandLine& command, ReadingChoice& choice, const std::string& side) {
  choice.side = side;
  const std::string name = "--" + side + "trajectory";
  command.add_option(name + " FILE", choice.trajectory,
                     "Trajectory of a mobile scanner: SBET, or text with times and positions");
  command.add_option(name + "-columns NAMES", choice.columns,
                     "Columns of the text file, as time,x,y,z (default: as named in its header line)");
  command.add_option("--" + side + "utm-zone ZONE", choice.utm_zone,
                     "Zone for latitudes and longitudes, as 32N, or a system as EPSG:2154; auto (default): "
                     "of the first; local: east, north, up");
  command.add_option(name + "-time-offset-s S", choice.time_offset_s,
                     "Seconds that are added to the times of the trajectory");
  command.add_option(
      "--" + side + "lever-arm x,y,z", choice.lever_arm,
      "Lever arm from the reference point of the trajectory to the scanner: forward, right, down, metres");
}

void add_units_option(CommandLine& command, std::string& units, const std::string& side) {
  std::vector<std::string> names;
  for (const LengthUnit& unit : length_units()) names.emplace_back(unit.name);
  command
      .add_option("--" + side + "units", units,
                  "Unit of the file's numbers: m, mm, cm, ft, in, us-ft, km (default: as stated in the file, "
                  "else m); options are always in metres")
      ->one_of(names);
}

std::optional<double> metres_per_unit_of(const std::string& units) {
  const std::optional<LengthUnit> unit = length_unit(units);
  return unit ? std::optional(unit->metres_per_unit) : std::nullopt;
}

TrajectoryOptions trajectory_options(const ReadingChoice& choice) {
  TrajectoryOptions reading;
  std::string names = choice.columns;
  for (std::size_t comma = 0; !names.empty(); names.erase(0, comma + 1)) {
    comma = std::min(names.find(','), names.size() - 1);
    const std::size_t length = names[comma] == ',' ? comma : comma + 1;
    reading.columns.push_back(names.substr(0, length));
  }
  reading.utm_zone = choice.utm_zone;
  reading.time_offset_s = choice.time_offset_s;
  reading.option_side = choice.side;
  if (!choice.lever_arm.empty())
    reading.lever_arm_m = parse_point(choice.lever_arm, "--" + choice.side + "lever-arm");
  return reading;
}

void require_trajectory(const ReadingChoice& choice) {
  const std::pair<const char*, bool> given[] = {{"trajectory-columns", !choice.columns.empty()},
                                                {"utm-zone", choice.utm_zone != "auto"},
                                                {"trajectory-time-offset-s", choice.time_offset_s != 0.0},
                                                {"lever-arm", !choice.lever_arm.empty()}};
  for (const auto& [name, is_given] : given) {
    if (is_given)
      throw Error("describes a trajectory, but none is given", fmt::format("--{}{}", choice.side, name),
                  fmt::format("add --{}trajectory FILE, or leave the option out", choice.side));
  }
}

ReadOptions with_choice(ReadOptions options, const ReadingChoice& choice) {
  options.memory_bytes = parse_memory(choice.memory);
  options.metres_per_unit = metres_per_unit_of(choice.units);
  if (choice.trajectory.empty()) {
    require_trajectory(choice);
    return options;
  }
  options.trajectory =
      std::make_shared<const Trajectory>(read_trajectory(choice.trajectory, trajectory_options(choice)));
  return options;
}

ReadOptions read_options(const std::string& origin, const std::string& option, const std::string& gravity) {
  ReadOptions options;
  if (!origin.empty()) options.origin = parse_point(origin, option);
  options.level = gravity != "unknown";
  return options;
}

double unit_of_input(const std::string& path, std::optional<double> metres_per_unit) {
  if (metres_per_unit || is_bim_file(path)) return metres_per_unit.value_or(1.0);
  const OpenPoints open(path);
  const std::vector<CloudFacts>& clouds = open.file().clouds();
  return clouds.empty() ? 1.0 : clouds.front().table.metres_per_unit.value_or(1.0);
}

InputScan read_input_scan(const std::string& path, const ReadOptions& options, const Session& session,
                          const std::string& units_option) {
  const bool stated = options.memory_bytes > 0 || options.trajectory;
  const auto note = [&](const std::string& remark) {
    if (!remark.empty()) session.note(fmt::format("{}: {}", path, remark));
  };
  ScanFile file = read_scan_file(path, options, *session.monitor);
  if (stated) {
    for (const std::string& remark : file.notes) session.note(remark);
  } else {
    note(unusable_note(file));
  }
  if (!options.metres_per_unit) note(unit_remark(file.metres_per_unit));
  note(offset_remark(file.offset_applied));
  InputScan input{Scan{}, file.metres_per_unit, file.offset_applied};
  if (file.scans.size() == 1) {
    input.scan = std::move(file.scans.front());
  } else {
    input.scan = join_scans(file.scans);
    input.scan.name = path;
  }
  // What is beyond belief is refused by who works with it, in one line.
  if (has_plausible_size(input.scan))
    for (const std::string& hint : hints_about(input.scan, units_option)) note(hint);
  return input;
}

Vector3d offset_of_model(const std::string& path, const BimModel& model) {
  if (model.schema != "PLY") return Vector3d::Zero();
  const MappedFile file(path);
  return model.metres_per_unit * parse_ply_header(file.bytes(), path).offset;
}

BimModel read_model_input(const std::string& path, const Session& session,
                          std::optional<double> metres_per_unit, const std::string& units_option) {
  session.monitor->begin_stage("reading");
  BimModel model = read_bim(path, *session.monitor, metres_per_unit);
  require_plausible_size(model, units_option);
  for (const std::string& warning : model.warnings) session.note(fmt::format("{}: {}", path, warning));
  const Vector3d offset = offset_of_model(path, model);
  if (!offset.isZero(0.0)) session.note(fmt::format("{}: {}", path, offset_remark(offset)));
  if (const std::string hint = axes_hint(model); !hint.empty())
    session.note(fmt::format("{}: {}", path, hint));
  return model;
}

Gravity gravity_of(const std::string& name) {
  return value_called(kGravities, name).value_or(Gravity::automatic);
}

void note_place(InputSummary& summary, const ScannerPlace& place, const Session& session) {
  if (summary.kind != "scan") return;
  summary.place = place;
  if (const std::string words = words_of_refuted(place); !words.empty())
    session.note(fmt::format("{}: {}", summary.path, words));
}

void refuse_same_file(const std::string& output, const std::string& input) {
  std::error_code missing;
  if (std::filesystem::equivalent(output, file_of_scan(input), missing)) {
    throw Error("would overwrite the input", output, "give the result another name");
  }
}

void refuse_same_files(const std::filesystem::path& folder, const std::vector<const char*>& names,
                       const std::vector<std::string>& inputs) {
  for (const char* name : names) {
    for (const std::string& input : inputs) refuse_same_file((folder / name).string(), input);
  }
}

}  // namespace limen
