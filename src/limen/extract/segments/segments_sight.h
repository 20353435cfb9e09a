// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "limen/extract/cells/scan_grid.h"
#include "limen/extract/features/extract_features.h"
#include "limen/geometry/plane.h"
#include "limen/model/scan.h"

namespace limen {

/// What a scanner saw just beyond the border of a surface.
enum class Beyond : std::uint8_t {
  unknown,   ///< nobody knows from where the points were seen
  same,      ///< the surface itself: it goes on
  hidden,    ///< something nearer to the scanner hides what is there
  touching,  ///< something that stands on the surface at its border
  open,      ///< rays went on behind the surface: it ends here
  silent     ///< no ray came back; never of mobile scans
};

/// A place on the border of a plane, and how to look beyond it.
struct BorderPlace {
  Plane plane;
  Vector3d edge = Vector3d::Zero();     ///< on the border
  Vector3d outward = Vector3d::Zero();  ///< unit vector in the plane, away from the surface
  double step_m = 0.0;                  ///< distance of neighbouring points across the border
  std::uint32_t point = 0;              ///< the outermost point there, index into the scan
};

/// Tells edges of surfaces from the borders of what something nearer lets see of them. A static scan is put
/// into a depth image on the six faces of a cube; of a mobile scan the neighbours in its scan lines are
/// asked.
class BorderSight {
 public:
  /// `same_m`: points nearer to a plane than this lie on it, unless they belong to one that faces another
  /// way. The scan and what was extracted from it must outlive this.
  BorderSight(const Scan& scan, const ExtractedFeatures& extracted, double same_m);

  /// It can tell anything at all.
  [[nodiscard]] bool knows() const { return !pixels_.empty() || grid_ != nullptr; }
  [[nodiscard]] Beyond look(const BorderPlace& place) const;

 private:
  struct Pixel {
    float near_m = 0.0F;
    float far_m = 0.0F;
    std::int32_t near = -1;  ///< index of the point; -1: none
    std::int32_t far = -1;
  };
  struct Votes {
    int same = 0;
    int hidden = 0;
    int touching = 0;
    int open = 0;
  };

  void make_image();
  void make_grid();
  [[nodiscard]] std::size_t pixel_at(const Vector3d& direction) const;
  [[nodiscard]] Votes votes_of_image(const BorderPlace& place) const;
  [[nodiscard]] Votes votes_of_lines(const BorderPlace& place) const;
  void vote(const BorderPlace& place, std::size_t point, Votes& votes) const;

  [[nodiscard]] bool faces_like(const Plane& plane, std::size_t point) const;

  const Scan* scan_;
  const ExtractedFeatures* extracted_;
  double same_m_;
  std::size_t edge_ = 0;  ///< pixels per edge of the cube
  std::vector<Pixel> pixels_;
  std::unique_ptr<ScanGrid> grid_;
  std::vector<std::uint32_t> place_of_;  ///< of each point in grid_
};

}  // namespace limen
