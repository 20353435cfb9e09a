// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "limen/model/bim_model.h"
#include "limen/model/features.h"
#include "limen/project/store/byte_stream.h"

namespace limen {

// Features, and rooms of a model, as bytes and back, bit for bit.

void transfer(auto& bytes, Is<Plane> auto& plane) {
  bytes(plane.normal, plane.offset);
}

void transfer(auto& bytes, Is<PlaneFrame> auto& frame) {
  bytes(frame.origin, frame.u, frame.v);
}

void transfer(auto& bytes, Is<Polygon> auto& polygon) {
  bytes(polygon.outer, polygon.holes);
}

void transfer(auto& bytes, Is<PlanarPolygon> auto& polygon) {
  bytes(polygon.plane, polygon.frame, polygon.parts, polygon.inliers, polygon.rms_m, polygon.area_m2,
        polygon.centroid, polygon.oriented, polygon.interior);
}

void transfer(auto& bytes, Is<Opening> auto& opening) {
  bytes(opening.corners, opening.facade, opening.evidence, opening.view, opening.edge_sigma_m,
        opening.reveal_depth_m, opening.reveal_sigma_m, opening.reveal_complete, opening.outline);
  bytes.require(is_value(opening.view, OpeningView::hole));
}

void transfer(auto& bytes, Is<Segment> auto& segment) {
  bytes(segment.a, segment.b);
}

void transfer(auto& bytes, Is<SurfaceSample> auto& sample) {
  bytes(sample.mean, sample.normal, sample.plane, sample.area_m2, sample.count);
}

void transfer(auto& bytes, Is<Features> auto& features) {
  bytes(features.local_origin, features.planes, features.openings, features.segments, features.samples,
        features.inlier_threshold_m, features.noise_m, features.drift_m);
  const auto of_plane = [&](std::int32_t index) {
    return index == -1 || is_place(index, features.planes.size());
  };
  for (const Opening& opening : features.openings) bytes.require(of_plane(opening.facade));
  for (const SurfaceSample& sample : features.samples) bytes.require(of_plane(sample.plane));
}

void transfer(auto& bytes, Is<BimFace> auto& face) {
  bytes(face.plane, face.frame, face.outline, face.area_m2, face.element);
}

void transfer(auto& bytes, Is<BimSpace> auto& room) {
  bytes(room.guid, room.name, room.storey, room.faces);
}

}  // namespace limen
