// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "module.h"
#include "numpy_views.h"
#include "work.h"

#include "limen/sight/estimate_centre.h"
#include "limen/extract/features/extract_features.h"
#include "limen/extract/model/model_features.h"
#include "limen/extract/openings/openings.h"
#include "limen/extract/segments/segments.h"
#include "limen/report/json/features_json.h"

namespace limen::python {
namespace {

struct Wanted {
  ExtractOptions extract;
  std::optional<OpeningOptions> openings;
  std::optional<SegmentOptions> segments;
};

ExtractedFeatures extract_all(const Scan& scan, const Wanted& wanted, Monitor& monitor) {
  monitor.begin_stage("planes");
  ExtractOptions extract = wanted.extract;
  extract.detect.relief = extract.detect.relief && !wanted.openings;  // they are holes of whole façades
  ExtractedFeatures extracted = limen::extract_features(scan, extract, monitor);
  Scan placed;  // the same scan where its centre has to be estimated
  const Scan* seen = &scan;
  if (!scan.centre_known() && (wanted.openings || wanted.segments)) {
    if (const std::optional<EstimatedCentre> estimated = estimate_centre(extracted.features)) {
      placed = scan;
      placed.centres = {estimated->centre};
      seen = &placed;
    }
  }
  if (wanted.openings && seen->level && (seen->centre_known() || wanted.openings->centre)) {
    monitor.begin_stage("openings");
    extracted.features.openings =
        find_openings(*seen, extracted, Vector3d::UnitZ(), *wanted.openings, monitor);
  }
  if (wanted.segments) {
    monitor.begin_stage("segments");
    extracted.features.segments = find_segments(*seen, extracted, *wanted.segments, monitor);
  }
  return extracted;
}

py::array ring(const Ring& ring, const PlaneFrame& frame, const Vector3d& origin) {
  std::vector<Vector3d> points;
  for (const Vector2d& p : ring) points.push_back(frame.to_space(p));
  return points_array(points, origin);
}

/// Outer ring, then the holes.
py::list rings(const Polygon& polygon, const PlaneFrame& frame, const Vector3d& origin) {
  py::list list;
  list.append(ring(polygon.outer, frame, origin));
  for (const Ring& hole : polygon.holes) list.append(ring(hole, frame, origin));
  return list;
}

py::dict plane_dict(const PlanarPolygon& polygon, const Vector3d& origin) {
  py::dict plane;
  plane["normal"] = polygon.plane.normal;
  plane["offset"] = polygon.plane.offset + polygon.plane.normal.dot(origin);
  py::list parts;
  for (const Polygon& part : polygon.parts) parts.append(rings(part, polygon.frame, origin));
  plane["parts"] = parts;
  plane["centroid"] = Vector3d(polygon.centroid + origin);
  plane["inliers"] = polygon.inliers;
  plane["rms_m"] = polygon.rms_m;
  plane["area_m2"] = polygon.area_m2;
  plane["oriented"] = polygon.oriented;
  return plane;
}

py::dict opening_dict(const Opening& it, const Vector3d& origin) {
  py::dict opening;
  opening["corners"] = points_array({it.corners, it.corners + 4}, origin);
  opening["plane"] = it.facade;
  opening["evidence"] = it.evidence;
  opening["view"] = to_string(it.view);
  opening["edge_sigma_m"] = std::vector<double>(it.edge_sigma_m, it.edge_sigma_m + 4);
  opening["reveal_depth_m"] = it.reveal_depth_m;
  opening["reveal_sigma_m"] = it.reveal_sigma_m;
  opening["reveal_complete"] = it.reveal_complete;
  opening["outline"] = points_array(it.outline, origin);
  return opening;
}

py::array segments_array(const std::vector<Segment>& segments, const Vector3d& origin) {
  std::vector<Vector3d> ends;
  for (const Segment& segment : segments) {
    ends.push_back(segment.a);
    ends.push_back(segment.b);
  }
  return points_array(ends, origin).attr("reshape")(-1, 2, 3);
}

py::dict features_dict(const ExtractedFeatures& extracted) {
  const Features& features = extracted.features;
  const Vector3d& origin = features.local_origin;
  py::list planes;
  py::list openings;
  for (const PlanarPolygon& polygon : features.planes) planes.append(plane_dict(polygon, origin));
  for (const Opening& opening : features.openings) openings.append(opening_dict(opening, origin));
  py::dict values;
  values["planes"] = planes;
  values["openings"] = openings;
  values["segments"] = segments_array(features.segments, origin);
  values["labels"] =
      py::array_t<std::int32_t>(static_cast<py::ssize_t>(extracted.labels.size()), extracted.labels.data());
  values["inlier_threshold_m"] = features.inlier_threshold_m;
  values["noise_m"] = features.noise_m;
  return values;
}

}  // namespace

void bind_features(py::module_& module) {
  module.def("extract_features", [](const Scan& scan, const ExtractOptions& extract,
                                    const std::optional<OpeningOptions>& openings,
                                    const std::optional<SegmentOptions>& segments,
                                    const py::object& progress) {
    extract.check();
    if (openings) openings->check();
    if (segments) segments->check();
    const Wanted wanted{extract, openings, segments};
    return features_dict(run(progress, [&](Monitor& monitor) { return extract_all(scan, wanted, monitor); }));
  });
  module.def("model_features", [](const BimModel& model, const py::object& progress) {
    return features_dict(run(progress, [&](Monitor& monitor) {
      monitor.begin_stage("planes");
      ExtractedFeatures extracted;
      extracted.features = limen::model_features(model).features;
      return extracted;
    }));
  });
}

}  // namespace limen::python
