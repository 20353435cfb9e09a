// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/project/read_project.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <utility>

#include "limen/base/error.h"
#include "limen/files/bounded_json.h"
#include "limen/files/mapped_file.h"
#include "limen/project/state/scan_names.h"
#include "limen/report/json/json_values.h"

namespace limen {
namespace {

constexpr const char* kProjectRemedy = "give the project.json that limen project wrote";

std::optional<Json> parse(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  std::ifstream stream(path, std::ios::binary);
  // Anything but an object is another kind of file: a cloud must not be read whole.
  while (stream && std::isspace(stream.peek()) != 0) stream.get();
  if (!stream || stream.peek() != '{') return {};
  Json json = json_or_nothing<Json>(stream);
  if (json.is_discarded() || !json.contains("scans") || !json.contains("links") || !json["scans"].is_array())
    return {};
  return json;
}

Json project_at(const std::filesystem::path& path) {
  require_readable(path, kProjectRemedy);
  std::optional<Json> json = parse(path);
  if (!json) throw Error("is not a project", path.string(), kProjectRemedy);
  return std::move(*json);
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
    throw Error("the correction of a pass is damaged", "project.json",
                "give the project.json that limen project wrote");
  return std::make_shared<const SplineMotion>(times, values, numbers_of(correction.at("pivot")));
}

double largest_of(const Json& numbers) {
  double largest = 0.0;
  for (const Json& number : numbers)
    largest = std::max(largest, number.is_number() ? number.get<double>() : 0.0);
  return largest;
}

double sigma_of(const Json& scan) {
  double sigma = 0.0;
  if (scan.contains("sigma") && scan["sigma"].is_object())
    sigma = largest_of(scan["sigma"].at("translation_m"));
  if (!scan.contains("correction")) return sigma;
  double squares = 0.0;
  const Json& knots = scan["correction"].at("knots");
  for (const Json& knot : knots) {
    if (knot.contains("moved_sigma_m")) squares += std::pow(largest_of(knot["moved_sigma_m"]), 2);
  }
  return std::hypot(sigma, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, knots.size()))));
}

ProjectEntry entry_of(const Json& scan) {
  ProjectEntry entry;
  entry.file = scan.at("file").get<std::string>();
  entry.index = scan.at("index").get<int>();
  entry.model = scan.at("kind") == "model";
  entry.state = scan.at("state").get<std::string>();
  if (const auto doubt = scan.find("doubt"); doubt != scan.end() && doubt->is_number())
    entry.doubt = doubt->get<double>();
  const Json& pose = scan.at("frame_from_scan");
  if (!pose.is_null()) entry.frame_from_scan = pose_of(pose);
  if (scan.contains("correction") && entry.frame_from_scan) entry.bend = bend_of(scan["correction"]);
  if (entry.bend) {
    for (const Json& knot : scan["correction"]["knots"])
      entry.knot_times_s.push_back(knot["time_s"].get<double>());
  }
  entry.sha256 = scan.value("sha256", "");
  entry.copy_of = scan.value("copy_of", "");
  entry.sigma_m = sigma_of(scan);
  return entry;
}

}  // namespace

bool is_project(const std::filesystem::path& path) {
  return parse(path).has_value();
}

CoordinateSystem read_project_system(const std::filesystem::path& path) {
  const Json json = project_at(path);
  CoordinateSystem system;
  if (!json.contains("frame") || !json["frame"].contains("crs")) return system;
  const Json& crs = json["frame"]["crs"];
  system.name = crs.value("name", "");
  system.code = crs.value("code", "");
  system.stated = crs.value("wkt", "");
  if (system.stated.find('[') != std::string::npos) system.wkt = system.stated;
  return system;
}

StatedTrajectories read_project_trajectories(const std::filesystem::path& path) {
  const Json json = project_at(path);
  StatedTrajectories stated;
  if (!json.contains("trajectories")) return stated;
  try {
    const Json& all = json["trajectories"];
    stated.files = all.at("files").get<std::vector<std::string>>();
    stated.reading.columns = all.at("columns").get<std::vector<std::string>>();
    stated.reading.utm_zone = all.at("utm_zone").get<std::string>();
    stated.reading.time_offset_s = all.at("time_offset_s").get<double>();
    stated.reading.lever_arm_m = numbers_of(all.at("lever_arm_m"));
    return stated;
  } catch (const Json::exception&) {
    throw Error("the trajectories of the project are damaged", path.string(), kProjectRemedy);
  }
}

std::vector<ProjectPoses> read_project_poses(const std::filesystem::path& path) {
  const Json json = project_at(path);
  try {
    std::vector<ProjectPoses> all;
    for (const Json& link : json["links"]) {
      const Json& others = link.at("alternatives");
      if (link.at("state") == "in_place" || (link.at("state") == "rejected" && others.empty())) continue;
      ProjectPoses poses{link.at("source").get<std::size_t>(),
                         link.at("target").get<std::size_t>(),
                         {link.at("pose_number").get<int>()}};
      for (const Json& other : others) poses.numbers.push_back(other.at("number").get<int>());
      std::sort(poses.numbers.begin(), poses.numbers.end());
      all.push_back(std::move(poses));
    }
    return all;
  } catch (const Json::exception&) {
    throw Error("a link of the project is damaged", path.string(), kProjectRemedy);
  }
}

std::string scan_name(const ProjectEntry& entry) {
  return scan_name(NumberedScan{entry.file, entry.index, entry.several});
}

std::vector<ProjectEntry> read_project(const std::filesystem::path& path) {
  const Json json = project_at(path);
  try {
    std::vector<ProjectEntry> entries;
    std::map<std::string, int> in_file;
    for (const Json& scan : json["scans"]) {
      entries.push_back(entry_of(scan));
      ++in_file[entries.back().file];
    }
    for (ProjectEntry& entry : entries) entry.several = in_file[entry.file] > 1;
    return entries;
  } catch (const Json::exception&) {
    throw Error("a scan of the project is damaged", path.string(), kProjectRemedy);
  }
}

}  // namespace limen
