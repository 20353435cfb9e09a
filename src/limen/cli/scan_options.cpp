// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/cli/scan_options.h"

#include <charconv>
#include <cmath>
#include <filesystem>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "limen/base/error.h"
#include "limen/io/read_bim.h"

namespace limen {

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

void add_gravity_option(CLI::App& command, std::string& gravity, bool with_auto) {
  const std::vector<std::string> known = with_auto ? std::vector<std::string>{"auto", "up", "unknown"}
                                                   : std::vector<std::string>{"up", "unknown"};
  std::string description = "up: the z axis of the files points up; unknown: it may point anywhere";
  if (with_auto) description += "; auto: up where floors and walls say so";
  command.add_option("--gravity", gravity, fmt::format("{} (default {})", description, gravity))
      ->check(CLI::IsMember(known));
}

void add_feature_options(CLI::App& command, const FeatureOptions& options) {
  command.add_option("SCAN", options.scan, "A scan of any format limen reads")->required();
  command.add_option("-o,--output", options.output, "The JSON file to write")->required()->type_name("FILE");
  command
      .add_option("--origin", options.origin,
                  "From where the scan was taken, in the coordinates of its points, metres")
      ->type_name("x,y,z");
  add_gravity_option(command, options.gravity);
}

ReadOptions read_options(const std::string& origin, const std::string& option, const std::string& gravity) {
  ReadOptions options;
  if (!origin.empty()) options.origin = parse_point(origin, option);
  options.level = gravity != "unknown";
  return options;
}

Scan read_input(const std::string& path, const ReadOptions& options, const Session& session) {
  return read_scan(path, options, *session.monitor);
}

BimModel read_model_input(const std::string& path, const Session& session) {
  session.monitor->begin_stage("reading");
  BimModel model = read_bim(path, *session.monitor);
  for (const std::string& warning : model.warnings) session.note(fmt::format("{}: {}", path, warning));
  return model;
}

int deliver(AtomicFile& file, const std::string& json, const std::string& summary, const Session& session) {
  session.monitor->throw_if_cancelled();
  file.write(json);
  file.commit();
  session.say(summary);
  session.answer(json);
  return kExitOk;
}

void refuse_same_file(const std::string& output, const std::string& input) {
  std::error_code missing;
  if (std::filesystem::equivalent(output, input, missing)) {
    throw Error("would be written over the input", output, "give the result another name");
  }
}

}  // namespace limen
