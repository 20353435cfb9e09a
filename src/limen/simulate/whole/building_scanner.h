// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/model/scan.h"
#include "limen/simulate/scanner/drift.h"
#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/scanner/shared_surface.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/scan_style.h"
#include "limen/simulate/whole/survey.h"

namespace limen {

/// A scan and what is true of it.
struct ScannedBuilding {
  Scan scan;
  SimulatedScan truth;
};

/// By how much the path of a pass errs, one standard deviation per axis, and how.
struct PassDrift {
  double sigma_m = 0.0;
  DriftKind kind = DriftKind::waves;
};

/// Scans a building from one place after the other. The building must outlive it.
class BuildingScanner {
 public:
  /// `local_from_scene`: from the building's frame to the world less `local_origin`.
  BuildingScanner(const WholeBuilding& building, const Rigid3& local_from_scene,
                  const Vector3d& local_origin);

  [[nodiscard]] const RayCaster& caster() const { return caster_; }
  ScannedBuilding station(const std::string& name, const StationPlace& place, const ScanStyle& style,
                          std::uint64_t seed);
  /// A drive along a path: about `points`, in the world's frame, with a slow error.
  ScannedBuilding pass(const std::string& name, const VehiclePath& path, std::size_t points,
                       const PassDrift& drift, const ScannerOptions& scanner, std::uint64_t seed);
  /// Of all scans so far, in their order.
  [[nodiscard]] std::vector<SharedSurface> shared() const { return counter_.shared(); }

 private:
  ScannedBuilding counted(ScannedBuilding made, const Sweep& result);

  const WholeBuilding& building_;
  RayCaster caster_;
  MergedPlanes merged_;
  SharedSurfaceCounter counter_;
  Rigid3 local_from_scene_;
  Vector3d local_origin_;
};

}  // namespace limen
