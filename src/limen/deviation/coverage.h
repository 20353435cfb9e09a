// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "limen/deviation/point_faces.h"

namespace limen {

/// How much of one face the scan's rays reached, m^2.
struct FaceCoverage {
  double covered_m2 = 0.0;  ///< tiles with a point
  double passed_m2 = 0.0;   ///< tiles without, through which a ray passed to a point well behind
};

/// Coverage of every face of the index by about `options.rays` rays, evenly taken: tiles that neither a point
/// nor a ray reached count nowhere, so that the share covered does not depend on how dense the scan is. Where
/// the scanner's place is not known nothing counts as passed.
std::vector<FaceCoverage> face_coverage(const ScanInModel& scan, const PointFaces& laid,
                                        const FaceIndex& index, const DeviationOptions& options);

}  // namespace limen
