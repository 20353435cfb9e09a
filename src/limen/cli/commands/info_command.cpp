// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/base/length_unit.h"
#include "limen/base/random.h"
#include "limen/bim/read_bim.h"
#include "limen/cli/commands/commands.h"
#include "limen/cli/inputs/frame_system.h"
#include "limen/cli/inputs/model_info.h"
#include "limen/cli/inputs/scan_options.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/model/plausible_size.h"
#include "limen/project/state/scan_names.h"
#include "limen/register/frame/scan_frame.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

constexpr std::size_t kInfoColumns = 6;
using InfoRow = std::array<std::string, kInfoColumns>;

std::string size_of_box(const Json& box) {
  const auto side = [&](std::size_t k) { return box["high"][k].get<double>() - box["low"][k].get<double>(); };
  return fmt::format("{:.2f} x {:.2f} x {:.2f}", side(0), side(1), side(2));
}

std::string place_words(const Json& scan) {
  const Json& centre = scan["optical_centre"];
  if (!centre.is_array()) return centre.get<std::string>();
  const auto at = [&](std::size_t k) { return centre[k].get<double>() + 0.0; };
  return fmt::format("{:.2f} {:.2f} {:.2f} ({})", at(0), at(1), at(2),
                     scan["scanner"]["source"].get<std::string>());
}

std::string joined_notes(const Json& notes) {
  std::string text;
  for (const Json& note : notes) text += (text.empty() ? "" : "; ") + note.get<std::string>();
  return text;
}

/// "PLY" of "PLY, binary, little-endian".
std::string first_words(const std::string& format) {
  return format.substr(0, format.find(','));
}

/// Places that a text of UTF-8 takes, wide signs counted as one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<InfoRow> rows_of(const Json& file) {
  const std::string name = file["file"];
  if (file.contains("error")) return {{name, "", "", "", "", "cannot be read"}};
  if (!file.contains("scans"))
    return {{name, file["format"], "", size_of_box(file), "", joined_notes(file["warnings"])}};
  std::vector<InfoRow> rows;
  const bool several = file["scans"].size() > 1;
  for (std::size_t k = 0; k < file["scans"].size(); ++k) {
    const Json& scan = file["scans"][k];
    rows.push_back({scan_name(NumberedScan{name, static_cast<int>(k), several}), first_words(file["format"]),
                    fmt::to_string(scan["points"].get<std::size_t>()), size_of_box(scan), place_words(scan),
                    k == 0 ? joined_notes(file["notes"]) : ""});
  }
  return rows;
}

/// What `limen info` says of several files, a line for each scan and model: name, format, points (of a model:
/// elements), size in metres, place of the scanner, notes. `files`: what it says of each in JSON, or what
/// went wrong as `error`.
std::string info_table(const Json& files) {
  std::vector<InfoRow> rows = {{"file", "format", "points", "size, m", "scanner", "notes"}};
  for (const Json& file : files) {
    for (InfoRow& row : rows_of(file)) rows.push_back(std::move(row));
  }
  std::array<std::size_t, kInfoColumns> widths{};
  for (const InfoRow& row : rows) {
    for (std::size_t k = 0; k < kInfoColumns; ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  constexpr std::size_t kPoints = 2;  // numbers stand under one another by their last digit
  std::string text;
  for (const InfoRow& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < kInfoColumns; ++k) {
      const std::string blanks(widths[k] - width_of(row[k]), ' ');
      line += (k == kPoints ? blanks + row[k] : row[k] + blanks) + "  ";
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

/// Points in the cube of a typical point; `side_m` is the cube's.
double points_per_cube(const Scan& scan, double side_m) {
  std::vector<std::uint64_t> keys;
  keys.reserve(scan.size());
  for (const Vector3d& point : scan.points) keys.push_back(mix_place(point, side_m));
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> counts;
  for (std::size_t begin = 0; begin < keys.size();) {
    std::size_t end = begin;
    while (end < keys.size() && keys[end] == keys[begin]) ++end;
    counts.push_back(end - begin);
    begin = end;
  }
  // Each point counts once, so that a few far and thin places do not decide for the whole.
  std::sort(counts.begin(), counts.end());
  std::size_t passed = 0;
  for (const std::size_t count : counts) {
    passed += count;
    if (2 * passed >= keys.size()) return static_cast<double>(count);
  }
  return 0.0;
}

/// Points per square metre of surface round a typical point, roughly: from cubes just large enough to hold
/// some points.
double surface_density(const Scan& scan) {
  constexpr double kEnough = 8.0;
  constexpr double kLargestM = 5.0;
  double side_m = 0.05;
  double count = points_per_cube(scan, side_m);
  while (count < kEnough && side_m < kLargestM) {
    side_m *= 2.0;
    count = points_per_cube(scan, side_m);
  }
  return count / (side_m * side_m);
}

std::int32_t line_count(const ScanTopology& topology) {
  std::vector<std::int32_t> lines = topology.line;
  std::sort(lines.begin(), lines.end());
  return static_cast<std::int32_t>(std::unique(lines.begin(), lines.end()) - lines.begin());
}

std::vector<std::string> attributes_of(const Scan& scan) {
  std::vector<std::string> names;
  if (!scan.times_s.empty()) names.emplace_back("time");
  if (!scan.intensities.empty()) names.emplace_back("intensity");
  if (!scan.colours.empty()) names.emplace_back("colour");
  return names;
}

Json json_of_centre(const ScannerPlace& place) {
  if (place.source == PlaceSource::unknown || place.source == PlaceSource::per_point)
    return to_string(place.source);
  return json_of(place.centre);
}

/// World.
ScannerPlace place_of(const Scan& scan, const ScanFrame& frame) {
  ScannerPlace place = frame.place;
  place.centre += scan.local_origin;
  if (place.refuted) *place.refuted += scan.local_origin;
  return place;
}

Json json_of_scan(const Scan& scan, const ScanFrame& frame) {
  const Extent extent = extent_of(scan.points);
  Json json;
  json["name"] = scan.name;
  json["points"] = scan.size();
  json["low"] = json_of(Vector3d(scan.local_origin + extent.low));
  json["high"] = json_of(Vector3d(scan.local_origin + extent.high));
  json["local_origin"] = json_of(scan.local_origin);
  const ScannerPlace place = place_of(scan, frame);
  json["optical_centre"] = json_of_centre(place);
  json["scanner"] = json_of(place);
  json["scan_lines"] = scan.topology.known() ? Json(line_count(scan.topology)) : Json();
  json["attributes"] = attributes_of(scan);
  if (!scan.times_s.empty()) {
    const auto [first, last] = std::minmax_element(scan.times_s.begin(), scan.times_s.end());
    json["time_s"] = Json::array({*first, *last});
  }
  json["points_per_m2"] = surface_density(scan);
  return json;
}

Json json_of_file(const std::string& path, const ScanFile& file) {
  Json json;
  json["file"] = path;
  json["format"] = file.format;
  json["fields"] = file.fields;
  json["left_out"] = file.dropped;
  json["metres_per_unit"] = file.metres_per_unit;
  if (const CoordinateSystem system = system_of_file(path); system.known())
    json["crs"] = {{"name", system.name}, {"code", system.code}, {"told", system.stated}};
  if (!file.offset_applied.isZero(0.0)) json["offset_applied"] = json_of(file.offset_applied);
  json["notes"] = file.notes;
  json["scans"] = Json::array();
  const auto note = [&json](const std::string& hint) {
    if (!hint.empty()) json["notes"].push_back(hint);
  };
  note(offset_remark(file.offset_applied));
  for (const Scan& scan : file.scans) {
    const ScanFrame frame = find_scan_frame(scan, Gravity::automatic);
    for (const std::string& hint : hints_about(scan, "--units")) note(hint);
    if (frame.upright) note(up_hint(frame.frame_from_scan.row(2).transpose()));
    json["scans"].push_back(json_of_scan(scan, frame));
  }
  return json;
}

std::string joined(const Json& words) {
  std::string text;
  for (const Json& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text.empty() ? "none" : text;
}

/// In a user's words how the scanner's place is known.
std::string who_says(const Json& scanner) {
  const std::string source = scanner["source"];
  const std::string contradicted =
      scanner.contains("refuted")
          ? fmt::format("the points contradict the position {}", point_text(scanner["refuted"]))
          : "";
  if (source == "per point") return "";
  if (source == "unknown") return contradicted.empty() ? "" : " (" + contradicted + ")";
  const char* const borne_out = scanner["confirmed"].get<bool>() ? ", confirmed by the points" : "";
  if (source == "assumed") return fmt::format(" (assumed{})", borne_out);
  if (source == "file") return fmt::format(" (from the file{})", borne_out);
  if (source == "user") return " (given by the user)";
  return fmt::format(" (estimated from the points, sigma {:.0f} mm{}{})",
                     1e3 * scanner["sigma_m"].get<double>(), contradicted.empty() ? "" : "; ", contradicted);
}

std::string scan_text(const Json& scan) {
  const Json& low = scan["low"];
  const Json& high = scan["high"];
  const auto side = [&](std::size_t k) { return high[k].get<double>() - low[k].get<double>(); };
  std::string text = fmt::format("points          {}\n", scan["points"].get<std::size_t>());
  text += fmt::format("from            {}\nto              {}\n", point_text(low), point_text(high));
  text += fmt::format("size            {:.3f} x {:.3f} x {:.3f} m\n", side(0), side(1), side(2));
  text += fmt::format("density         about {:.0f} points per m2\n", scan["points_per_m2"].get<double>());
  const Json& centre = scan["optical_centre"];
  text += fmt::format("scanner at      {}{}\n",
                      centre.is_array() ? point_text(centre) : centre.get<std::string>(),
                      who_says(scan["scanner"]));
  text +=
      fmt::format("scan lines      {}\n",
                  scan["scan_lines"].is_null() ? "unknown" : fmt::to_string(scan["scan_lines"].get<int>()));
  text += fmt::format("attributes      {}\n", joined(scan["attributes"]));
  return text + fmt::format("local origin    {}\n", point_text(scan["local_origin"]));
}

std::string text_of(const Json& file) {
  std::string text =
      fmt::format("file            {}\nformat          {}\nfields          {}\n",
                  file["file"].get<std::string>(), file["format"].get<std::string>(), joined(file["fields"]));
  text += fmt::format("unit            {}\n", unit_name(file["metres_per_unit"].get<double>()));
  if (file.contains("crs")) {
    const Json& crs = file["crs"];
    const CoordinateSystem system{crs["told"], crs["name"], crs["code"], {}};
    text += fmt::format("coordinates     {}\n", words_of(system));
  }
  const bool several = file["scans"].size() > 1;
  const std::string name = std::filesystem::path(file["file"].get<std::string>()).filename().string();
  for (std::size_t i = 0; i < file["scans"].size(); ++i) {
    const NumberedScan scan{name, static_cast<int>(i), several};
    if (several) text += fmt::format("\nscan {} of {} ({})\n", i + 1, file["scans"].size(), scan_name(scan));
    text += scan_text(file["scans"][i]);
  }
  for (const Json& note : file["notes"]) text += fmt::format("note            {}\n", note.get<std::string>());
  return text;
}

struct InfoCommand {
  std::vector<std::string> paths;
  ReadingChoice reading;
};

Json json_of_path(const std::string& path, const ReadingChoice& reading, const Session& session) {
  if (is_bim_file(path))
    return json_of_model(path, read_bim(path, *session.monitor, metres_per_unit_of(reading.units)));
  return json_of_file(path, read_scan_file(path, with_choice({}, reading), *session.monitor));
}

/// A line for each; what cannot be read does not stop the others.
int run_on_many(const InfoCommand& command, const Session& session) {
  Json files = Json::array();
  bool all_read = true;
  for (const std::string& path : command.paths) {
    try {
      files.push_back(json_of_path(path, command.reading, session));
    } catch (const Error& error) {
      if (error.fault() != Fault::input) throw;
      all_read = false;
      session.warn(error.what());
      files.push_back({{"file", path}, {"error", error.what()}});
    }
  }
  session.say(info_table(files));
  session.answer(to_text(files));
  return all_read ? kExitOk : kExitBadInput;
}

int run(const InfoCommand& command, const Session& session) {
  session.monitor->begin_stage("reading");
  if (command.paths.size() > 1) return run_on_many(command, session);
  const Json json = json_of_path(command.paths.front(), command.reading, session);
  session.say(json.contains("scans") ? text_of(json) : text_of_model(json));
  session.answer(to_text(json));
  return kExitOk;
}

}  // namespace

void add_info_command(CommandLine& app, Session& session) {
  auto options = std::make_shared<InfoCommand>();
  CommandLine* command = add_command(app, session, "info", "Show what a scan or a model file contains",
                                     [options, &session] { return run(*options, session); });
  command
      ->add_option("FILE", options->paths,
                   "A scan or a model of any format limen reads, or \"FILE #N\" for one scan of a file; "
                   "several files give a table")
      ->required();
  add_units_option(*command, options->reading.units);
  add_memory_option(*command, options->reading.memory);
  add_trajectory_options(*command, options->reading);
}

}  // namespace limen
