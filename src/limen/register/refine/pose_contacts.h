// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/register/refine/refine_pose.h"

namespace limen {

/// One piece of evidence for a pose, in the target's frame: a tile against a plane, a pair of edges of an
/// opening, the two faces of a wall.
struct Contact {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  double residual_m = 0.0;  ///< how far the source has to move along the normal; radians about it for a turn
  double sigma_m = 0.0;
  double gate_m = 0.0;    ///< nothing counts beyond
  double area_m2 = 0.0;   ///< surface it is worth as a hold
  int source_plane = -1;  ///< -1: not a pair of planes
  int target_plane = -1;
  int opening = -1;  ///< of Contacts::openings
  bool turn = false;
};

struct Contacts {
  std::vector<Contact> all;            ///< planes first
  std::vector<OpeningMatch> openings;  ///< that contacts were taken from
};

struct ContactGates {
  double plane_m = 0.05;
  double opening_m = 0.1;
};

/// What two scans say of the poses that a refinement goes through: what does not depend on the pose is
/// gathered once. Refers to what it is made of.
class ContactFinder {
 public:
  ContactFinder(const ScanView& source, const ScanView& target, const RefineOptions& options);
  ~ContactFinder();
  ContactFinder(const ContactFinder&) = delete;
  ContactFinder& operator=(const ContactFinder&) = delete;

  /// Everything the two scans say of a pose near `target_from_source` (local frames).
  [[nodiscard]] Contacts near(const Rigid3& target_from_source, const ContactGates& gates) const;

 private:
  class Collector;
  std::unique_ptr<Collector> collector_;
};

}  // namespace limen
