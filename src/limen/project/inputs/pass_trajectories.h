// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "limen/io/trajectory/read_trajectory.h"

namespace limen {

/// Trajectories along which passes were measured, and how their files are to be read.
struct StatedTrajectories {
  std::vector<std::string> files;
  TrajectoryOptions reading;
};

using Trajectories = std::vector<std::shared_ptr<const Trajectory>>;
Trajectories read_trajectories(const StatedTrajectories& stated);

/// What tells trajectories and how they were read from all others; empty where there are none.
std::string key_of(const StatedTrajectories& stated);

/// The scan with the places of its scanner along the trajectory that covers it, as it was where none does;
/// `notes` loses what was said of the scanner's position and tells which it was, by its mark
/// (store/kept_notes.h): number 1 is the first of the trajectories.
Scan along_trajectory(Scan scan, const Trajectories& trajectories, std::vector<std::string>& notes);

}  // namespace limen
