// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "limen/simulate/buildings/building.h"
#include "limen/simulate/scanner/ray_caster.h"

namespace limen {

/// How a scanner errs, and what its light does.
struct ScannerOptions {
  double noise_m = 0.003;            ///< range noise, one standard deviation
  double angle_jitter_rad = 5e-5;    ///< of the beam's direction, one standard deviation per axis
  double mixed_pixel_share = 0.25;   ///< of the pulses at a depth edge: the two ranges blend
  double loss_share = 0.003;         ///< of all echoes, for no reason
  double glass_return_share = 0.05;  ///< of the rays on a pane that come back from it
  double glass_loss_share = 0.03;    ///< that come back from nowhere
  double glass_mirror_share = 0.0;   ///< that are thrown back as by a mirror, and end on what it shows

  void check() const;
};

/// One pulse as commanded, in the scene's frame.
struct Pulse {
  Vector3d origin = Vector3d::Zero();
  Vector3d direction = Vector3d::UnitX();  ///< unit vector
  double time_s = 0.0;
};

/// A scan pattern: pulses in lines. `pulse` must be a pure function.
struct ScanPattern {
  std::size_t lines = 0;
  std::size_t pulses_per_line = 0;
  std::function<Pulse(std::size_t line, std::size_t index)> pulse;
};

/// One measured point, in the scene's frame.
struct Echo {
  Vector3d point = Vector3d::Zero();
  std::uint32_t line = 0;
  std::uint32_t index = 0;
  std::int32_t surface = -1;  ///< -1: mixed
  float intensity = 0.0F;     ///< in [0, 1]
};

/// What one pass of a scanner gives: echoes in the order of the pattern, and how it saw each opening.
struct Sweep {
  std::vector<Echo> echoes;
  std::vector<OpeningSight> sights;  ///< one per opening of the world
};

/// Fires every pulse of the pattern. The same for any thread count: pulse (line, index) has its own random
/// stream (seed, line and index).
Sweep sweep(const RayCaster& caster, const std::vector<TrueOpening>& openings, const ScanPattern& pattern,
            const ScannerOptions& options, std::uint64_t seed);

/// What a tripod scanner looks at, about its own axis.
struct FieldOfView {
  double low_deg = -60.0;  ///< elevations
  double high_deg = 90.0;
  double span_deg = 360.0;  ///< azimuths from 0 on
};

/// A tripod scanner's raster: columns of constant azimuth, about `pulses` in all. `scene_from_scanner` places
/// it.
ScanPattern station_pattern(const Rigid3& scene_from_scanner, std::size_t pulses,
                            const FieldOfView& view = {});

/// A vehicle's path: points in the scene's frame, straight in between, driven at constant speed.
struct VehiclePath {
  std::vector<Vector3d> points;
  [[nodiscard]] double length() const;
  /// Place and heading (unit, horizontal) after `distance_m`.
  [[nodiscard]] Vector3d at(double distance_m) const;
  [[nodiscard]] Vector3d heading(double distance_m) const;
};

/// Profilers on a vehicle: each head turns full circles in an upright plane, turned by its angle about the
/// vertical from the plane across the path. About `pulses` in all; profiles as far apart as pulses at 10 m.
/// The lines of the first head come first, then those of the second, which drives along at the same time.
ScanPattern profiler_pattern(const VehiclePath& trajectory, const std::vector<double>& head_turns_rad,
                             std::size_t pulses);

}  // namespace limen
