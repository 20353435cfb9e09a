// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limen/model/scan.h"
#include "limen/simulate/buildings/building.h"
#include "limen/simulate/furnishing/furnish_rooms.h"
#include "limen/simulate/scanner/drift.h"
#include "limen/simulate/scanner/ray_caster.h"
#include "limen/simulate/scanner/scanner.h"
#include "limen/simulate/scanner/station_scan.h"
#include "limen/simulate/whole/project_truth.h"
#include "limen/simulate/whole/survey.h"

namespace limen {

/// How one station was scanned: the instrument, how it was set up, who was in the way.
struct ScanStyle {
  std::size_t points = 120000;  ///< about
  ScannerOptions scanner = {};
  FieldOfView view = {};
  bool any_rotation = false;                ///< the file's frame, else level with any heading
  double tilt_rad = 0.0;                    ///< of the whole instrument, its frame with it
  Vector3d file_origin = Vector3d::Zero();  ///< the scanner in its file's frame
  bool origin_stated = true;                ///< whether the file says where the scanner stood
  int people = 0;                           ///< in its room, while it scanned
};

/// A style at random: noise 1-8 mm, 50-150 % of the points, the field of view, a tilt up to 3 degrees, a
/// scanner off its file's origin (and not stated), glass that mirrors, people, rooms that are scanned by
/// half.
ScanStyle random_scan_style(const ScanStyle& plain, std::uint64_t seed);

/// Furniture that hides little or much.
FurnishingStyle random_furnishing_style(std::uint64_t seed);

/// Somebody who stood in the way while one scan was taken.
struct Person {
  Vector2d at = Vector2d::Zero();
  double floor_m = 0.0;
  double height_m = 1.7;
  double heading_rad = 0.0;
};

/// Up to `count` people in a room, clear of furniture, at least 0.8 m from the scanner.
std::vector<Person> people_in(const Building& building, std::size_t room, const Vector3d& scanner, int count,
                              RandomStream& random);

/// Echoes behind people are replaced by echoes on them: their surface becomes -1.
void hide_behind(Sweep& sweep, const Vector3d& scanner, const std::vector<Person>& people, double noise_m,
                 RandomStream& random);

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
