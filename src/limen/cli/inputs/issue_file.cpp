// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/issue_file.h"

#include <chrono>

#include <fmt/format.h>

#include "limen/bim/ifc/read_ifc.h"
#include "limen/files/mapped_file.h"

namespace limen {

void add_issue_options(CommandLine& command, IssueChoice& choice) {
  command.add_option("--bcf FILE", choice.file,
                     "Write issues for building modellers, in BCF 2.1: elements missing or moved, and "
                     "objects not in the model");
  add_length_option(
      command, "--moved-m", choice.options.moved_m,
      "An element that is displaced by more than this is reported as moved (default 0.015, LOA30)");
  add_length_option(command, "--matter-m", choice.options.matter_m,
                    "Objects that are not in the model are reported from this length on (default 0.5)");
}

IssueModel issue_model(const std::string& path, const BimModel& model, const Rigid3& world_from_elements) {
  IssueModel issue;
  issue.file = std::filesystem::path(path).filename().string();
  issue.file_from_elements = world_from_elements;
  if (!model.georeferenced) return issue;
  const MappedFile file(path);
  const std::optional<MapConversion> map = map_of_ifc(file.bytes(), path);
  if (!map) return issue;
  Rigid3 map_from_file;
  map_from_file.rotation << map->cosine, -map->sine, 0.0, map->sine, map->cosine, 0.0, 0.0, 0.0, 1.0;
  map_from_file.translation = map->shift_m;
  issue.file_from_elements = inverse(map_from_file) * world_from_elements;
  issue.scale = map->scale;
  return issue;
}

std::string date_of_file(const std::filesystem::path& path) {
  using namespace std::chrono;
  std::error_code none;
  const auto written = std::filesystem::last_write_time(path, none);
  const auto time = none ? sys_seconds() : floor<seconds>(file_clock::to_sys(written));
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

}  // namespace limen
