// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/deviation/point_faces.h"

namespace limen {

/// How much of one face the scan's rays reached, m^2.
struct FaceCoverage {
  double covered_m2 = 0.0;  ///< tiles with a point
  double passed_m2 = 0.0;   ///< tiles without, through which a ray passed to a point well behind
};

/// Coverage of every face of the index, by any number of scans: tiles that neither a point nor a ray reached
/// count nowhere, so that the share covered does not depend on how dense the scans are. A tile on which
/// points of one scan lie is covered, whatever others saw there.
class FaceTiles {
 public:
  FaceTiles(const FaceIndex& index, double tile_m);

  /// Takes all points of a scan and follows about `options.rays` of its rays, drawn by their places. Where
  /// the scanner's place is not known nothing counts as passed.
  void add(const ScanInModel& scan, const PointFaces& laid, const DeviationOptions& options);
  [[nodiscard]] std::vector<FaceCoverage> coverage() const;

 private:
  struct Grid {
    Vector2d low = Vector2d::Zero();
    Vector2d tile_m = Vector2d::Zero();
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::size_t begin = 0;
  };

  void mark(int face, const Vector3d& x, std::uint8_t what);
  [[nodiscard]] FaceCoverage count(std::size_t face) const;

  const FaceIndex& index_;
  std::vector<Grid> grids_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace limen
