// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/geometry/rigid.h"
#include "limen/simulate/truth/truth.h"

namespace limen {

/// A room of a whole building that was scanned.
struct ProjectRoom {
  int storey = 0;
  int unit = -1;  ///< flat, house or bay; -1: of the whole building (corridors)
  std::string use;
  double area_m2 = 0.0;
  int alike = -1;         ///< rooms of the same number are built alike, perhaps mirrored; -1: like no other
  bool mirrored = false;  ///< against the design of that number
  bool furnished_alike = false;  ///< with the design's furniture, placed by hand
};

/// By how much the path of a pass errs at a time.
struct DriftSample {
  double time_s = 0.0;
  Vector3d error = Vector3d::Zero();  ///< of what was measured then, world axes, metres
};

/// What is true of one scan of a project.
struct SimulatedScan {
  std::string name;  ///< of the file, less its ending
  std::string ending = ".ply";
  bool mobile = false;
  std::size_t points = 0;
  int room = -1;         ///< index into ProjectTruth::rooms; -1: the street
  double drift_m = 0.0;  ///< error of the trajectory that was put in, one standard deviation per axis
  std::vector<DriftSample> drift;       ///< of a pass; it goes evenly from one to the next
  double surface_m2 = 0.0;              ///< of the building and its surroundings, seen by it
  Rigid3 local_from_scan;               ///< scan frame to world less ProjectTruth::local_origin
  Vector3d scanner = Vector3d::Zero();  ///< of a station, in its own frame; not always stated in the file
};

/// The exact truth of a project. Coordinates are about local_origin: x_in_world = local_origin + x.
struct ProjectTruth {
  std::string building;
  std::uint64_t seed = 0;
  bool as_built = false;  ///< off the drawing, as real buildings are
  Vector3d local_origin = Vector3d::Zero();
  std::vector<ProjectRoom> rooms;
  std::vector<SimulatedScan> scans;
  std::vector<SiteTarget> targets;
  std::vector<SharedSurface> shared;  ///< sorted; pairs that share nothing are left out
};

/// Scan frame to world; a mobile scan's points are given in the world already.
inline Rigid3 world_from_scan(const ProjectTruth& truth, std::size_t scan) {
  Rigid3 pose = truth.scans[scan].local_from_scan;
  if (!truth.scans[scan].mobile) pose.translation += truth.local_origin;
  return pose;
}

/// Whether two stations stand in different rooms that are built alike.
inline bool look_alike(const ProjectTruth& truth, std::size_t a, std::size_t b) {
  const int first = truth.scans[a].room;
  const int second = truth.scans[b].room;
  if (first < 0 || second < 0 || first == second) return false;
  const int alike = truth.rooms[static_cast<std::size_t>(first)].alike;
  return alike >= 0 && alike == truth.rooms[static_cast<std::size_t>(second)].alike;
}

}  // namespace limen
