// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/features/extract_features.h"
#include "limen/model/bim_model.h"
#include "limen/model/method.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

/// A scan made ready for registration: features, labels, and its view of space, all in a frame that is turned
/// upright about the scan's local origin where the scan's own is not.
struct PreparedScan {
  ExtractedFeatures extracted;
  Matrix3d upright_from_scan = Matrix3d::Identity();
  std::unique_ptr<SpaceView> space;  ///< a panorama for a static station, else a map of cubes
  bool centre_estimated = false;     ///< the scan did not say where the scanner was
  bool mobile = false;               ///< seen from many places along a path
  bool upright = false;              ///< z of the prepared frame points up
  bool model = false;                ///< a building model instead of a scan
  std::vector<BimSpace> rooms;       ///< of a model
  std::vector<Vector3d> stations;    ///< optical centres of static stations, prepared frame
  Eigen::AlignedBox3d reach;         ///< around the samples, prepared frame

  SampleRuns runs;  ///< of a model

  [[nodiscard]] ScanView view() const {
    ScanView view{&extracted.features, space.get(), reach, model, mobile, mobile || !stations.empty()};
    if (!stations.empty()) view.station = stations.front();
    if (model) view.runs = &runs;
    return view;
  }
  /// Sets `reach` from the samples, and of a model `runs`.
  void settle_reach();
};

struct PrepareOptions {
  ExtractOptions extract;
  Gravity gravity = Gravity::automatic;
  bool segments = false;  ///< line segments as well
};

/// Features of `scan`, openings included where the vertical and the optical centre are known; the centre is
/// estimated where the scan does not say.
PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options = {},
                          Monitor& monitor = silent_monitor());

}  // namespace limen
