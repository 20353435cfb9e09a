// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/deviation/deviation.h"

#include <cmath>
#include <utility>

#include "limen/base/error.h"
#include "limen/base/named.h"
#include "limen/base/parallel.h"
#include "limen/base/ranked.h"
#include "limen/deviation/face_offsets.h"
#include "limen/deviation/measure_elements.h"
#include "limen/deviation/unmodelled.h"

namespace limen {
namespace {

float nth(std::vector<float>& values, double share) {
  return ranked(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5));
}

/// Figures of all distances of an element.
void describe(std::vector<float>& distances, ElementDeviation& it) {
  it.points = distances.size();
  if (distances.empty()) return;
  double sum = 0.0;
  double squares = 0.0;
  for (const float d : distances) sum += static_cast<double>(d);
  it.mean_m = sum / static_cast<double>(distances.size());
  for (const float d : distances) squares += std::pow(static_cast<double>(d) - it.mean_m, 2);
  it.sigma_m = std::sqrt(squares / static_cast<double>(distances.size()));
  it.median_m = static_cast<double>(nth(distances, 0.5));
  for (float& d : distances) d = std::abs(d);
  it.p95_m = static_cast<double>(nth(distances, 0.95));
  it.loa = loa_class(it.p95_m);
}

/// Figures of the points on each element.
void describe_elements(const ModelFaces& faces, const std::vector<std::vector<float>>& by_face,
                       std::vector<ElementDeviation>& elements) {
  std::vector<std::vector<float>> distances(elements.size());
  for (std::size_t k = 0; k < by_face.size(); ++k) {
    std::vector<float>& all = distances[static_cast<std::size_t>(faces.elements[k])];
    all.insert(all.end(), by_face[k].begin(), by_face[k].end());
  }
  parallel_for(elements.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) describe(distances[e], elements[e]);
  });
}

void find_unmodelled(const ScanInModel& scan, const PointFaces& laid, const ModelFaces& faces,
                     const DeviationOptions& options, Deviation& result) {
  std::vector<Vector3d> loose;
  for (std::size_t i = 0; i < laid.far.size(); ++i) {
    if (laid.far[i] != 0) loose.push_back(scan.points[i]);
  }
  result.far = loose.size();
  const FacesExtent extent = extent_of(faces);
  result.unmodelled =
      pieces_of(loose, options.cluster_m, options.min_cluster_points, extent.low, extent.high);
}

void name_points(PointFaces laid, const ModelFaces& faces, Deviation& result) {
  result.distance_m = std::move(laid.distance_m);
  result.element = std::move(laid.face);
  for (std::int32_t& face : result.element) {
    if (face < 0) continue;
    face = faces.elements[static_cast<std::size_t>(face)];
    ++result.matched;
  }
}

Deviation measure(const ScanInModel& scan, const BimModel& model, const DeviationOptions& options,
                  Monitor& monitor) {
  const ModelFaces faces = faces_of(model);
  const FaceIndex index(faces.faces, options.max_distance_m);
  monitor.begin_stage("distances");
  PointFaces laid = lay_on_faces(scan, index, options, monitor);
  monitor.begin_stage("coverage");
  FaceTiles tiles(index, options.tile_m);
  tiles.add(scan, laid, options);
  monitor.throw_if_cancelled();
  monitor.begin_stage("elements");
  Deviation result;
  result.oriented = scan.centre_known();
  const std::vector<std::vector<float>> distances = distances_by_face(laid, faces.faces.size());
  result.elements = elements_of(model);
  describe_elements(faces, distances, result.elements);
  const FaceEvidence evidence{face_offsets(faces, laid, distances, options), tiles.coverage()};
  result.common = measure_elements(model, faces, evidence, options, result.elements);
  find_unmodelled(scan, laid, faces, options, result);
  name_points(std::move(laid), faces, result);
  return result;
}

}  // namespace

void DeviationOptions::check() const {
  if (!(max_distance_m > 0.0 && max_distance_m <= 1.0))
    throw_bad_option("max_distance_m", max_distance_m, "within (0, 1]");
  if (!(max_angle_deg > 0.0 && max_angle_deg < 90.0))
    throw_bad_option("max_angle_deg", max_angle_deg, "within (0, 90)");
  if (!(tile_m > 0.0)) throw_bad_option("tile_m", tile_m, "more than 0");
  if (rays < 1) throw_bad_option("rays", static_cast<double>(rays), "1 or more");
  if (!(cluster_m > 0.0)) throw_bad_option("cluster_m", cluster_m, "more than 0");
}

const char* to_string(Presence presence) {
  static constexpr Named<Presence> names[] = {
      {Presence::found, "found"}, {Presence::not_found, "not_found"}, {Presence::not_judged, "not_judged"}};
  return name_of(names, presence);
}

int loa_class(double deviation_m) {
  constexpr struct {
    int loa;
    double most_m;
  } kClasses[] = {{50, 0.001}, {40, 0.005}, {30, 0.015}, {20, 0.050}, {10, 0.150}};
  for (const auto& it : kClasses) {
    if (deviation_m <= it.most_m) return it.loa;
  }
  return 0;
}

Deviation measure_deviation(const Scan& scan, const BimModel& model, const Rigid3& model_from_scan,
                            const DeviationOptions& options, Monitor& monitor) {
  options.check();
  scan.check();
  model.check();
  if (scan.points.empty()) throw Error("holds no points", scan.name, "give a scan with points");
  if (model.faces.empty()) throw Error("holds no faces", model.name, "give a model with elements");
  return measure(ScanInModel(scan, model_from_scan), model, options, monitor);
}

}  // namespace limen
