// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "limen/base/progress.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/extract/segments/segments.h"
#include "limen/model/bim_model.h"
#include "limen/model/method.h"
#include "limen/model/scan.h"
#include "limen/register/frame/scan_frame.h"
#include "limen/register/prepare/kept_points.h"
#include "limen/register/prepare/open_sky.h"
#include "limen/register/prepare/pass_track.h"
#include "limen/register/prepare/scan_view.h"

namespace limen {

/// What is kept of a scan that is laid in its frame.
struct LayOptions {
  KeepOptions keep = kKeepAll;
  bool lines = true;  ///< with the scan lines, where they are known
  bool times = true;  ///< of a mobile scan
};

/// The scan in its frame, about local origin + corner, seen from the place found; its points sorted along a
/// curve through space, so that nothing that follows depends on their order in the file. Of more points than
/// are wanted a part is kept (kept_points.h). Times of a static scan, intensities and colours are left out.
Scan laid_in(const Scan& scan, const ScanFrame& frame, const LayOptions& options = {});
/// The same of a scan that is not needed any more: its memory is given back on the way.
Scan laid_in(Scan&& scan, const ScanFrame& frame, const LayOptions& options = {});

/// A scan made ready for registration: features, labels, and its view of space, all in the frame that its
/// data fix (scan_frame.h): turned by `upright_from_scan` about `extracted.features.local_origin`.
struct PreparedScan {
  ExtractedFeatures extracted;  ///< labels and samples: of the points in the frame's own order
  Matrix3d upright_from_scan = Matrix3d::Identity();
  std::shared_ptr<const SpaceView> space;  ///< a panorama for a static station, else a map of cubes
  ScannerPlace place;                      ///< where the (first) scanner stood, world
  bool mobile = false;                     ///< seen from many places along a path
  Surroundings surroundings = Surroundings::unknown;
  bool upright = false;            ///< z of the prepared frame points up
  bool surely_upright = false;     ///< no other way up need be tried
  bool model = false;              ///< a building model instead of a scan
  std::vector<BimSpace> rooms;     ///< of a model
  std::vector<Vector3d> stations;  ///< scanner positions of static stations, prepared frame
  Eigen::AlignedBox3d reach;       ///< around the samples, prepared frame

  SampleRuns runs;                     ///< of a model
  std::vector<SurfaceDetail> details;  ///< of static stations: what is in the room, prepared frame
  PassTrack track;                     ///< of a mobile scan with times

  [[nodiscard]] ScanView view() const {
    ScanView view{&extracted.features, space.get(), reach, model, mobile, mobile || !stations.empty()};
    if (!stations.empty()) view.station = stations.front();
    view.stations = &stations;
    if (model) view.runs = &runs;
    if (!details.empty()) view.details = &details;
    return view;
  }
  /// Sets `reach` from the samples, and of a model `runs`.
  void settle_reach();
};

struct PrepareOptions {
  ExtractOptions extract;
  Gravity gravity = Gravity::automatic;
  bool track = false;          ///< of a mobile scan, as a project needs it that bends drifting passes
  bool planes_only = false;    ///< neither openings nor a view of space
  bool segments = false;       ///< line segments as well
  OpeningOptions openings;     ///< which openings are looked for
  SegmentOptions edges;        ///< which segments are
  KeepOptions keep;            ///< which points of a large or dense scan are looked at
  bool sampled_model = false;  ///< a model's from points spread over it (2023, IV-A), not its exact edges
};

/// Features of `scan` in its frame, openings included where the vertical and the scanner's place are known.
PreparedScan prepare_scan(const Scan& scan, const PrepareOptions& options = {},
                          Monitor& monitor = silent_monitor());
/// The same of a scan that is not needed any more: its memory is given back on the way.
PreparedScan prepare_scan(Scan&& scan, const PrepareOptions& options = {},
                          Monitor& monitor = silent_monitor());

/// As the two functions above, in a frame that is known already.
PreparedScan prepare_in_frame(const Scan& scan, const ScanFrame& frame, const PrepareOptions& options = {},
                              Monitor& monitor = silent_monitor());
PreparedScan prepare_in_frame(Scan&& scan, const ScanFrame& frame, const PrepareOptions& options = {},
                              Monitor& monitor = silent_monitor());

/// The features turned back into the scan's own frame, about the same local origin; samples are left out.
Features in_own_frame(PreparedScan&& prepared);

}  // namespace limen
