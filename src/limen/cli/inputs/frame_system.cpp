// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/inputs/frame_system.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/cloud/open_points.h"

namespace limen {

void add_crs_option(CommandLine& command, std::string& text) {
  command.add_option("--crs SYSTEM", text,
                     "Coordinate system of what is written: EPSG:NUMBER, well-known text (WKT), PROJJSON, or "
                     "a file with one of them");
}

CoordinateSystem chosen_system(const std::string& text) {
  if (text.empty()) return {};
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(text, ignored)) return coordinate_system(text, "--crs");
  constexpr std::uintmax_t kLargest = 1'000'000;
  if (std::filesystem::file_size(text, ignored) > kLargest)
    throw Error("is too large for a coordinate system", text, "give a text file with WKT or PROJJSON");
  std::ifstream stream(text, std::ios::binary);
  return coordinate_system({std::istreambuf_iterator<char>(stream), {}}, text);
}

CoordinateSystem system_of_file(const std::string& path) {
  try {
    const OpenPoints file(path);
    return file.georeference().empty() ? CoordinateSystem{} : stated_system(file.georeference().front());
  } catch (const Error& error) {
    if (error.fault() == Fault::cancelled) throw;
    return {};
  }
}

FrameSystem frame_system(const ProjectResult& result, const CoordinateSystem& chosen,
                         std::vector<std::string>& notes) {
  std::map<std::string, CoordinateSystem> by_file;
  for (const ProjectScan& scan : result.scans) {
    if (!scan.model && scan.readable && by_file.count(scan.file) == 0)
      by_file[scan.file] = system_of_file(scan.file);
  }
  FrameSystem frame;
  const std::string of_frame =
      result.frame_scan >= 0 ? result.scans[static_cast<std::size_t>(result.frame_scan)].file : std::string();
  const CoordinateSystem own = by_file.count(of_frame) > 0 ? by_file[of_frame] : CoordinateSystem{};
  if (chosen.known()) {
    frame = {chosen, "user"};
  } else if (own.known()) {
    frame = {own, "file"};
  }
  for (const auto& [file, system] : by_file) {
    if (!frame.system.known() || same_system(system, frame.system)) continue;
    notes.push_back(file == of_frame
                        ? fmt::format("{} defines the frame and states the coordinate system {}, but --crs "
                                      "gives {}, which is written",
                                      file, words_of(system), words_of(frame.system))
                        : fmt::format("{} states the coordinate system {}, but the project's frame is {}",
                                      file, words_of(system), words_of(frame.system)));
  }
  return frame;
}

}  // namespace limen
