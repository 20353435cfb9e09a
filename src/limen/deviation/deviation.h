// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limen/base/progress.h"
#include "limen/model/bim_model.h"
#include "limen/model/scan.h"

namespace limen {

struct DeviationOptions {
  double max_distance_m = 0.10;          ///< surface farther from every face is not the model's, > 0
  double max_angle_deg = 30.0;           ///< between the surface at a point and its face, in (0, 90)
  double tile_m = 0.05;                  ///< edge of the tiles by which coverage is counted, > 0
  std::size_t rays = 400000;             ///< of the scan that are followed through the model, about
  int min_points = 50;                   ///< on an element that counts as found
  double cluster_m = 0.15;               ///< objects not in the model: gaps up to this join pieces, > 0
  std::size_t min_cluster_points = 100;  ///< smaller pieces are not reported

  void check() const;
};

/// What the scan says of an element.
enum class Presence : std::uint8_t {
  found,
  not_found,  ///< rays passed where it should stand, or most of what they could see of it is not there
  not_judged  ///< hidden, out of reach, or a pane that lets light pass
};
const char* to_string(Presence presence);

/// By how much an element is elsewhere, as far as its seen faces tell.
struct ElementShift {
  Vector3d shift_m = Vector3d::Zero();  ///< as built less as modelled, model axes; 0 along open directions
  Vector3d sigma_m = Vector3d::Zero();  ///< one standard deviation along x, y, z, of the faces' scatter
  int held = 0;                         ///< directions that the faces hold: 0 to 3
  std::vector<Vector3d> open;           ///< unit, the others
};

/// One element against the scan. Distances are along the outward normals of its faces: positive where surface
/// protrudes from the model's surface.
struct ElementDeviation {
  std::int32_t element = -1;  ///< index into BimModel::elements
  Presence presence = Presence::not_judged;
  std::size_t points = 0;      ///< on its faces
  double median_m = 0.0;       ///< signed
  double mean_m = 0.0;         ///< signed
  double sigma_m = 0.0;        ///< standard deviation
  double p95_m = 0.0;          ///< 95 % of the points deviate by no more
  int loa = 0;                 ///< 10 to 50: loa_class(p95_m); 0: none, or no points
  double area_m2 = 0.0;        ///< of all its faces
  double covered_m2 = 0.0;     ///< tiles with points
  double passed_m2 = 0.0;      ///< tiles without, through which rays passed
  double covered_share = 0.0;  ///< covered / (covered + passed); 0 where neither
  ElementShift shift;
};

/// An object that no face of the model explains.
struct UnmodelledObject {
  std::size_t points = 0;
  Vector3d low = Vector3d::Zero();   ///< extent, about the model's local origin
  Vector3d high = Vector3d::Zero();  ///< metres
  Vector3d centre = Vector3d::Zero();
  bool within_model = false;  ///< its centre lies in the model's extent
};

/// A scan against a model.
struct Deviation {
  std::vector<ElementDeviation> elements;    ///< one per element of the model, in its order
  std::vector<UnmodelledObject> unmodelled;  ///< most points first
  std::vector<float> distance_m;             ///< per point, signed; NaN: on no face
  std::vector<std::int32_t> element;         ///< per point; -1: on no face
  std::size_t matched = 0;                   ///< points on faces
  std::size_t far = 0;                       ///< points with no face within max_distance_m
  ElementShift common;                       ///< of all found elements together: what the pose may be off by
  bool oriented = true;  ///< it is known from where the points were seen; else signs are the faces' own guess
};

/// The class of the USIBD for a deviation at the 95 % level (2 sigma): 50 up to 1 mm, 40 up to 5 mm, 30 up to
/// 15 mm, 20 up to 50 mm, 10 up to 150 mm (the user's own bound there), else 0. Source: U.S. Institute of
/// Building Documentation, Level of Accuracy (LOA) Specification Guide, document C120, version 3.0, 2019.
int loa_class(double deviation_m);

/// Measures a scan against a model. `model_from_scan` is between the local frames of both. Throws Error for
/// bad options, an empty scan or a model without faces.
Deviation measure_deviation(const Scan& scan, const BimModel& model, const Rigid3& model_from_scan,
                            const DeviationOptions& options = {}, Monitor& monitor = silent_monitor());

}  // namespace limen
