// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
//
// Scans whose true poses are known, as a list on disk has them: a line each, NAME FILE and 12 numbers, the
// rows of the pose of the scan in the set's frame.
#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "limen/base/angles.h"
#include "limen/io/cloud/read_scan.h"
#include "limen/register/prepare/prepared_pair.h"
#include "limen/register/register.h"

namespace limen::calibration {

struct Known {
  std::string name;
  PreparedScan scan;
  Rigid3 set_from_scan;
};

inline std::vector<Known> scans_of_list(const std::string& path) {
  std::ifstream file(path);
  std::vector<Known> scans;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Known known;
    std::string cloud;
    words >> known.name >> cloud;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) words >> known.set_from_scan.rotation(r, c);
      words >> known.set_from_scan.translation[r];
    }
    if (!words) throw std::runtime_error("not a line of NAME FILE and 12 numbers: " + line);
    known.set_from_scan.rotation = nearest_rotation(known.set_from_scan.rotation);
    known.scan = prepare_scan(read_scan(cloud), prepare_options({}));
    scans.push_back(std::move(known));
  }
  return scans;
}

/// Whether a pose between the prepared frames is the true one: by where it puts the middle of what the source
/// saw (metres), and by its turn (degrees).
inline bool is_near(const Rigid3& pose, const Rigid3& truth, const PreparedPair& pair, double most_m,
                    double most_deg) {
  const Vector3d middle = pair.source.reach.center();
  return (pose * middle - truth * middle).norm() < most_m &&
         rotation_angle(truth.rotation.transpose() * pose.rotation) < radians(most_deg);
}

}  // namespace limen::calibration
