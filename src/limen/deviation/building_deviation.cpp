// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/building_deviation.h"

#include <utility>

#include "limen/base/error.h"
#include "limen/deviation/face_offsets.h"
#include "limen/deviation/measure_elements.h"
#include "limen/deviation/point_faces.h"

namespace limen {
namespace {

const BimModel& with_faces(const BimModel& model, const DeviationOptions& options) {
  options.check();
  model.check();
  if (model.faces.empty()) throw Error("holds no faces", model.name, "give a model with elements");
  return model;
}

/// What one scan says of all elements that it saw.
ElementShift common_shift(const std::vector<FaceOffset>& offsets, const DeviationOptions& options) {
  std::vector<FaceOffset> known;
  for (const FaceOffset& offset : offsets) {
    if (offset.points > 0) known.push_back(offset);
  }
  return shift_of(known, options);
}

}  // namespace

BuildingMeasurement::BuildingMeasurement(const BimModel& model, const DeviationOptions& options)
    : model_(with_faces(model, options)),
      options_(options),
      faces_(faces_of(model)),
      index_(faces_.faces, options.max_distance_m),
      tiles_(index_, options.tile_m),
      counts_(model.elements.size()),
      seen_by_(model.elements.size(), 0),
      offsets_(faces_.faces.size()),
      loose_(options.cluster_m) {}

void BuildingMeasurement::count(const std::vector<std::vector<float>>& by_face) {
  std::vector<std::size_t> points(counts_.size(), 0);
  for (std::size_t k = 0; k < by_face.size(); ++k) {
    const auto element = static_cast<std::size_t>(faces_.elements[k]);
    for (const float d : by_face[k]) counts_[element].add(static_cast<double>(d));
    points[element] += by_face[k].size();
  }
  for (std::size_t e = 0; e < points.size(); ++e)
    seen_by_[e] += points[e] >= static_cast<std::size_t>(options_.min_points) ? 1 : 0;
}

LaidScan BuildingMeasurement::add(const Scan& scan, const Rigid3& model_from_scan, double pose_sigma_m,
                                  Monitor& monitor) {
  scan.check();
  if (scan.points.empty()) throw Error("holds no points", scan.name, "give a scan with points");
  ScanInModel placed(scan, model_from_scan);
  PointFaces laid = lay_on_faces(placed, index_, options_, monitor);
  tiles_.add(placed, laid, options_);
  monitor.throw_if_cancelled();
  ScanShare share;
  share.points = placed.points.size();
  share.oriented = placed.centre_known();
  const std::vector<std::vector<float>> distances = distances_by_face(laid, faces_.faces.size());
  count(distances);
  const std::vector<FaceOffset> offsets = face_offsets(faces_, laid, distances, options_);
  share.common = common_shift(offsets, options_);
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    if (offsets[k].points == 0) continue;
    offsets_[k].push_back(offsets[k]);
    offsets_[k].back().pose_sigma_m = pose_sigma_m;
  }
  for (std::size_t i = 0; i < laid.far.size(); ++i) {
    if (laid.far[i] == 0) continue;
    loose_.add(placed.points[i]);
    ++share.far;
  }
  LaidScan result{std::move(placed.points), std::move(laid.distance_m), std::move(laid.face)};
  for (std::int32_t& face : result.element) {
    if (face < 0) continue;
    face = faces_.elements[static_cast<std::size_t>(face)];
    ++share.matched;
  }
  scans_.push_back(std::move(share));
  return result;
}

BuildingDeviation BuildingMeasurement::finish() const {
  BuildingDeviation result;
  result.elements = elements_of(model_);
  for (std::size_t e = 0; e < counts_.size(); ++e) counts_[e].describe(result.elements[e]);
  FaceEvidence evidence;
  evidence.coverage = tiles_.coverage();
  for (const std::vector<FaceOffset>& by_scan : offsets_) evidence.offsets.push_back(joined_offset(by_scan));
  result.common = measure_elements(model_, faces_, evidence, options_, result.elements);
  result.seen_by = seen_by_;
  const FacesExtent extent = extent_of(faces_);
  result.unmodelled = loose_.pieces(options_.min_cluster_points, extent.low, extent.high);
  result.scans = scans_;
  for (const ScanShare& scan : scans_) {
    result.points += scan.points;
    result.matched += scan.matched;
    result.far += scan.far;
  }
  return result;
}

}  // namespace limen
