// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/extract_features.h"
#include "limen/register/score_pose.h"

namespace limen {

/// A scan made ready for registration: features, labels, and its view of space.
struct PreparedScan {
  ExtractedFeatures extracted;
  std::unique_ptr<SpaceView> space;  ///< a panorama for a static station, else a map of cubes
  bool centre_estimated = false;     ///< the scan did not say where the scanner was
  bool looks_level = false;          ///< a main direction of its planes is the z axis

  [[nodiscard]] ScanView view() const { return {&extracted.features, space.get()}; }
};

/// Features of `scan`, its optical centre (estimated where the scan does not say) and its depth panorama.
PreparedScan prepare_scan(const Scan& scan, const ExtractOptions& options,
                          Monitor& monitor = silent_monitor());

}  // namespace limen
