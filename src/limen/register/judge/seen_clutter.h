// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "limen/model/look_alike_evidence.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

/// Observations of one kind: how many independent ones there are, and what share of them agrees.
struct Observations {
  double count = 0.0;  ///< pieces of surface a correlation length apart count as one each; denser ones do not
  double share = 0.0;  ///< of their surface that agrees, in [0, 1]

  [[nodiscard]] double agreeing() const { return count * share; }
};

/// How far apart across a flat face of a thing lies in two scans.
struct FaceMiss {
  double offset_m = 0.0;  ///< signed, within `kNearFaceM`
  double share = 1.0;     ///< of one observation: faces that tell the same make one together
  /// What noise leaves between two measurements of the face; roughness and the pose come on top.
  double sigma_m = 0.0;
  std::size_t thing = 0;  ///< number of its thing in `SeenClutter::things`
};

/// What is near one another is of one thing: it is where it was, or it is not, as a whole.
struct ThingSeen {
  double count = 0.0;     ///< observations of it ...
  double agreeing = 0.0;  ///< ... and how many of them agree
};

/// Pieces farther apart than this are not taken for one another.
inline constexpr double kNearFaceM = 0.06;

/// What two scans show of clutter: furniture and other things that are not the building's. Rooms built alike
/// agree on walls, slabs, columns and frames by design; on clutter only by chance, or because they are
/// furnished alike.
struct SeenClutter {
  /// Pieces that the other scan saw either as surface or as free space.
  Observations pieces;
  /// The same, thing by thing; some show faces only.
  std::vector<ThingSeen> things;
  /// Flat faces of things that the other scan has nearby as well, and how far apart the two are.
  std::vector<FaceMiss> faces;
  /// Share of `pieces` that agrees when one room's things are shifted about in the other: chance.
  double chance = 0.0;
  /// A wall is between the two stations: what they have in common is seen through an opening.
  bool behind_wall = false;
  /// How the building's surfaces were built, as both scans saw them (as_built.h).
  BuiltEvidence built{};
};

/// Asks each scan about the other's clutter under poses (upright frames): pieces of surface on no
/// plane, or on a plane smaller than a wall, off all large planes of both scans. Neither side is a model.
/// What is the building's of either scan is found once; what the views point to has to outlive this.
class ClutterComparer {
 public:
  ClutterComparer(const ScanView& source, const ScanView& target);
  ~ClutterComparer();
  ClutterComparer(const ClutterComparer&) = delete;
  ClutterComparer& operator=(const ClutterComparer&) = delete;

  [[nodiscard]] SeenClutter operator()(const Rigid3& target_from_source) const;
  /// Of the building's surfaces only.
  [[nodiscard]] BuiltEvidence built(const Rigid3& target_from_source) const;

 private:
  struct Sides;
  std::unique_ptr<Sides> sides_;
};

/// The same of one pose.
SeenClutter seen_clutter(const ScanView& source, const ScanView& target, const Rigid3& target_from_source);

}  // namespace limen
