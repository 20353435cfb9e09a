// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/project/inputs/pass_trajectories.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "limen/files/file_hash.h"
#include "limen/project/store/kept_notes.h"

namespace limen {

Trajectories read_trajectories(const StatedTrajectories& stated) {
  Trajectories all;
  for (const std::string& file : stated.files)
    all.push_back(std::make_shared<const Trajectory>(read_trajectory(file, stated.reading)));
  return all;
}

std::string key_of(const StatedTrajectories& stated) {
  if (stated.files.empty()) return {};
  std::string key;
  for (const std::string& file : stated.files) key += sha256_of_file(file) + " ";
  for (const std::string& column : stated.reading.columns) key += column + ",";
  const Vector3d& arm = stated.reading.lever_arm_m;
  return key + fmt::format("{} {} {} {} {}", stated.reading.utm_zone, stated.reading.time_offset_s, arm.x(),
                           arm.y(), arm.z());
}

Scan along_trajectory(Scan scan, const Trajectories& trajectories, std::vector<std::string>& notes) {
  const Trajectory* trajectory = covering_trajectory(scan, trajectories);
  if (trajectory == nullptr) return scan;
  // Remarks of its reading on where its scanner was.
  notes.erase(std::remove_if(
                  notes.begin(), notes.end(),
                  [](const std::string& note) { return note.find("scanner position") != std::string::npos; }),
              notes.end());
  FollowedScan followed = with_trajectory(scan, *trajectory);
  const auto found = std::find_if(trajectories.begin(), trajectories.end(),
                                  [&](const auto& other) { return other.get() == trajectory; });
  const auto number = static_cast<std::size_t>(found - trajectories.begin());
  notes.push_back(fmt::format("{} was measured along {}", scan.name, name_mark(number + 1)));
  if (followed.left_out > 0)
    notes.push_back(
        fmt::format("{} points at times that the trajectory does not cover are left out", followed.left_out));
  return std::move(followed.scan);
}

}  // namespace limen
