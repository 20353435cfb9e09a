// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/read_project.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>

#include "limen/base/error.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

std::optional<Json> parse(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream stream(path, std::ios::binary);
  // Anything but an object is another kind of file: a cloud must not be read whole.
  while (stream && std::isspace(stream.peek()) != 0) stream.get();
  if (!stream || stream.peek() != '{') return {};
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.contains("scans") || !json.contains("links") || !json["scans"].is_array())
    return {};
  return json;
}

Rigid3 pose_of(const Json& rows) {
  Matrix4d matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows.at(i).at(j).get<double>();
  }
  return from_matrix(matrix);
}

Vector3d numbers_of(const Json& numbers) {
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

std::shared_ptr<const SplineMotion> bend_of(const Json& correction) {
  std::vector<double> times;
  std::vector<Vector6d> values;
  for (const Json& knot : correction.at("knots")) {
    times.push_back(knot.at("time_s").get<double>());
    Vector6d value;
    value << numbers_of(knot.at("turn_rad")), numbers_of(knot.at("shift_m"));
    values.push_back(value);
  }
  const bool ascending =
      std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
  if (times.size() < 2 || !ascending)
    throw Error("the correction of a pass is not told as it should be", "project.json",
                "give the project.json that limen project wrote");
  return std::make_shared<const SplineMotion>(times, values, numbers_of(correction.at("pivot")));
}

ProjectEntry entry_of(const Json& scan) {
  ProjectEntry entry;
  entry.file = scan.at("file").get<std::string>();
  entry.index = scan.at("index").get<int>();
  entry.model = scan.at("kind") == "model";
  entry.state = scan.at("state").get<std::string>();
  const Json& pose = scan.at("frame_from_scan");
  if (!pose.is_null()) entry.frame_from_scan = pose_of(pose);
  if (scan.contains("correction") && entry.frame_from_scan) entry.bend = bend_of(scan["correction"]);
  return entry;
}

}  // namespace

std::vector<ProjectEntry> read_project(const std::filesystem::path& path) {
  const char* remedy = "give the project.json that limen project wrote";
  const std::optional<Json> json = parse(path);
  if (!json) throw Error("is not a project", path.string(), remedy);
  try {
    std::vector<ProjectEntry> entries;
    for (const Json& scan : (*json)["scans"]) entries.push_back(entry_of(scan));
    return entries;
  } catch (const Json::exception&) {
    throw Error("a scan of the project is not told as it should be", path.string(), remedy);
  }
}

}  // namespace limen
