// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/model/features.h"

namespace limen {

/// Two planes, one of each scan, that a shift along a given direction lays on each other.
struct PlaneShift {
  double shift_m = 0.0;     ///< along the direction, to be added to the pose
  double overlap_m2 = 0.0;  ///< of their bounding rectangles after the shift
  int source = -1;          ///< index into Features::planes
  int target = -1;
};

/// Finds planes of two scans that hold a pose along one direction.
class PlaneShiftFinder {
 public:
  /// `source_up` and `target_up`: unit vectors; bounding rectangles stand upright by them.
  PlaneShiftFinder(const Features& source, const Features& target, const Vector3d& source_up,
                   const Vector3d& target_up);

  /// All shifts of `pose` along the unit vector `direction` (target frame), within [low_m, high_m], that lay
  /// a plane of the source on one of the target seen from the same side and overlapping it there; by shift.
  [[nodiscard]] std::vector<PlaneShift> along(const Rigid3& target_from_source, const Vector3d& direction,
                                              double low_m, double high_m) const;

 private:
  struct Box {
    Vector2d low = Vector2d::Zero();
    Vector2d high = Vector2d::Zero();
    double fill = 1.0;  // share of the rectangle that the polygon covers
  };
  struct BoxedPlane {
    Plane plane;
    PlaneFrame frame;
    std::vector<Box> boxes;
    bool oriented = false;
    int index = -1;
  };
  struct Overlap {
    double area_m2 = 0.0;
    Vector2d middle = Vector2d::Zero();  // in the target plane's frame
  };

  [[nodiscard]] static std::vector<BoxedPlane> boxed(const Features& features, const Vector3d& up);
  [[nodiscard]] static BoxedPlane boxed(const PlanarPolygon& polygon, const Vector3d& up);
  [[nodiscard]] static Overlap overlap(const Rigid3& target_from_source, const BoxedPlane& source,
                                       const BoxedPlane& target);

  std::vector<BoxedPlane> source_;
  std::vector<BoxedPlane> target_;
};

/// A shift that several pairs of planes agree on.
struct CommonShift {
  double shift_m = 0.0;     ///< mean by overlap
  double overlap_m2 = 0.0;  ///< of the pairs together, nearer ones counting more
};

/// The shifts that most overlap supports, at most `most`, no two nearer than the tolerance; largest first.
std::vector<CommonShift> common_shifts(const std::vector<PlaneShift>& shifts, double tolerance_m, int most);

}  // namespace limen
