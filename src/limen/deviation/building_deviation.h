// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limen/deviation/coverage.h"
#include "limen/deviation/deviation.h"
#include "limen/deviation/distance_counts.h"
#include "limen/deviation/element_shift.h"
#include "limen/deviation/model_faces.h"
#include "limen/deviation/unmodelled.h"

namespace limen {

/// What one of many scans says by itself.
struct ScanShare {
  std::size_t points = 0;
  std::size_t matched = 0;  ///< on faces
  std::size_t far = 0;      ///< with no face within reach
  bool oriented = false;    ///< it is known from where it was taken
  ElementShift common;      ///< of all elements that it saw: what its pose may be off by
};

/// Many scans against a model.
struct BuildingDeviation {
  std::vector<ElementDeviation> elements;    ///< one per element of the model, in its order
  std::vector<int> seen_by;                  ///< of each: scans with enough points on it
  std::vector<UnmodelledObject> unmodelled;  ///< most points first
  std::vector<ScanShare> scans;              ///< in the order in which they came
  std::size_t points = 0;
  std::size_t matched = 0;
  std::size_t far = 0;
  ElementShift common;  ///< of all found elements together
};

/// The points of one scan, laid on the faces.
struct LaidScan {
  std::vector<Vector3d> points;       ///< about the model's local origin
  std::vector<float> distance_m;      ///< signed; NaN: on no face
  std::vector<std::int32_t> element;  ///< -1: on no face
};

/// Measures scans of one building against its model, one after the other: of each only what faces, tiles and
/// objects that are not in the model gather is kept. Where several scans see a face, its offset is the robust
/// mean of theirs, and the figures are of all points together.
class BuildingMeasurement {
 public:
  /// Throws Error for bad options or a model without faces; the model must stay.
  explicit BuildingMeasurement(const BimModel& model, const DeviationOptions& options = {});
  BuildingMeasurement(const BuildingMeasurement&) = delete;
  BuildingMeasurement& operator=(const BuildingMeasurement&) = delete;

  /// `model_from_scan` is between the local frames of both, `pose_sigma_m` how well the pose is known.
  LaidScan add(const Scan& scan, const Rigid3& model_from_scan, double pose_sigma_m,
               Monitor& monitor = silent_monitor());
  [[nodiscard]] BuildingDeviation finish() const;

 private:
  void count(const std::vector<std::vector<float>>& by_face);

  const BimModel& model_;
  DeviationOptions options_;
  ModelFaces faces_;
  FaceIndex index_;
  FaceTiles tiles_;
  std::vector<DistanceCounts> counts_;            ///< of each element
  std::vector<int> seen_by_;                      ///< of each element
  std::vector<std::vector<FaceOffset>> offsets_;  ///< of each face, by the scans that saw it
  UnmodelledPoints loose_;
  std::vector<ScanShare> scans_;
};

}  // namespace limen
